#include "model/number_text.hpp"
#include "model/units.hpp"
#include "problem/nearest_name.hpp"
#include "problem/row_types.hpp"
#include "problem/sections.hpp"

#include <algorithm>
#include <array>
#include <numbers>
#include <utility>

namespace percuss::problem {

namespace {

using model::Family;
using model::Key;

constexpr std::string_view dielectric_name = "dielectric-elastomer";
constexpr std::string_view spring_name = "spring-mass";

std::string_view describe(Family family) {
    switch (family) {
        case Family::dielectric_elastomer_si: return "a dielectric elastomer problem in SI units";
        case Family::dielectric_elastomer_nondimensional: return "a [nondimensional] problem";
        case Family::spring_mass: return "a spring-mass problem";
    }
    return "a problem of unknown kind";
}

/// Keys that mean the same in different kinds of problem.
constexpr std::array<std::array<Key, 3>, 6> counterparts = {{
    {Key::stop_gap, Key::nd_gap, Key::stop_gap},
    {Key::stop_stiffness, Key::nd_stiffness, Key::stop_stiffness},
    {Key::stop_damping, Key::nd_damping, Key::stop_damping},
    {Key::drive_voltage, Key::nd_voltage, Key::sm_force},
    {Key::drive_frequency, Key::nd_omega, Key::sm_omega},
    {Key::layers, Key::nd_layers, Key::sm_force},
}};

std::string counterpart_hint(Key key, Family family) {
    const std::size_t column = static_cast<std::size_t>(family);
    for (const auto& row : counterparts) {
        const bool listed = std::find(row.begin(), row.end(), key) != row.end();
        const bool sensible = !(row[0] == Key::layers && family == Family::spring_mass);
        if (listed && sensible && row.at(column) != key) {
            return "; use " + std::string(model::key_info(row.at(column)).name);
        }
    }
    return "";
}

bool belongs(Key key, Family family) {
    const auto keys = model::keys_of(family);
    return std::find(keys.begin(), keys.end(), key) != keys.end();
}

void read_key(const Setting& setting, Key key, model::Specification& spec) {
    if (!belongs(key, spec.family)) {
        throw ProblemError(as_written(setting) + ": this is " + std::string(describe(spec.family)) +
                           ", which has no such key" + counterpart_hint(key, spec.family));
    }
    if (is_frequency(key) && model::trimmed(setting.value) == "edge") {
        return;  // absent means edge
    }
    try {
        spec.set(key, parse_key_value(key, setting.value));
    } catch (const std::invalid_argument& error) {
        throw ProblemError((setting.from_option ? "option --" : "") + setting.key + ": " + error.what() +
                           (is_frequency(key) ? ", or edge" : ""));
    }
}

/// The other way to give the frequency is in use.
bool is_replaced(const model::Specification& spec, Key key) {
    return is_frequency(key) && !spec.has(key) && model::has_frequency(spec);
}

std::vector<Echo> key_echo(const model::Specification& spec, Key key) {
    if (!belongs(key, spec.family) || is_replaced(spec, key)) { return {}; }
    if (spec.has(key)) { return {number_echo(spec.value(key), model::key_info(key).unit)}; }
    const auto keys = model::keys_of(spec.family);
    const bool usual_frequency = is_frequency(key) && std::find_if(keys.begin(), keys.end(), is_frequency)[0] == key;
    if (usual_frequency) { return {{"edge"}}; }
    if (!is_frequency(key) && model::is_required(spec, key)) { return {{""}}; }
    return {};
}

Row key_row(Key key) {
    const model::KeyInfo& info = model::key_info(key);
    const std::string edge = is_frequency(key) ? "edge" : "";
    return setting<design::Problem>(
        std::string(info.name), info.unit == "1" ? "" : std::string(info.unit),
        allowed_range(info) + (edge.empty() ? "" : ", or edge"),
        info.fallback ? model::number_text(*info.fallback) : edge, std::string(info.meaning),
        [key](design::Problem& problem, const Setting& s, const Context&) { read_key(s, key, problem.actuator); },
        [key](const design::Problem& problem, const Context&) { return key_echo(problem.actuator, key); });
}

const Words<model::StopLaw>& stop_laws() {
    static const Words<model::StopLaw> laws = {{"kelvin-voigt", model::StopLaw::kelvin_voigt},
                                               {"no-tension", model::StopLaw::no_tension},
                                               {"none", model::StopLaw::none}};
    return laws;
}

}  // namespace

bool is_frequency(Key key) { return key == Key::drive_frequency || key == Key::nd_omega || key == Key::sm_omega; }

double parse_key_value(Key key, std::string_view text) {
    const model::KeyInfo& info = model::key_info(key);
    if (info.name.starts_with("nondimensional.")) { return model::parse_plain_number(text); }
    if (info.unit == "Hz" && text.find("rad") != std::string_view::npos) {
        double angular = 0.0;
        try {
            angular = model::parse_quantity(text, "rad/s");
        } catch (const std::invalid_argument&) { return model::parse_quantity(text, info.unit); }
        throw std::invalid_argument("'" + std::string(model::trimmed(text)) +
                                    "' is an angular frequency and this key is in Hz: give the value / 2 pi, '" +
                                    model::number_text(angular / (2.0 * std::numbers::pi)) + " Hz'");
    }
    return model::parse_quantity(text, info.unit);
}

model::Key parse_key(std::string_view name, Family family) {
    std::vector<std::string> names;
    for (const Key key : model::keys_of(family)) {
        if (model::key_info(key).name == name) { return key; }
        names.emplace_back(model::key_info(key).name);
    }
    throw ProblemError("'" + std::string(name) + "' is not a key of " + std::string(describe(family)) +
                       "; the nearest one is " + nearest_name(name, names));
}

Family family_of(const SettingList& settings) {
    const Setting* type = settings.find("actuator.type");
    const std::string_view type_name = type == nullptr ? "" : model::trimmed(type->value);
    if (type != nullptr && type_name != dielectric_name && type_name != spring_name) {
        throw bad_value(*type, "must be dielectric-elastomer or spring-mass");
    }
    const Setting* nondimensional = settings.first_of_section("nondimensional.");
    const Setting* spring = settings.first_of_section("spring-mass.");
    const Setting* material = settings.first_of_section("material.");
    const Setting* geometry = nullptr;
    for (const Setting& setting : settings.all()) {
        if (setting.key.starts_with("actuator.") && setting.key != "actuator.type" && geometry == nullptr) {
            geometry = &setting;
        }
    }
    const Setting* si = geometry != nullptr ? geometry : material;

    const std::array<std::pair<const Setting*, const Setting*>, 3> mixtures = {
        {{nondimensional, si}, {nondimensional, spring}, {spring, si}}};
    for (const auto& [one, other] : mixtures) {
        if (one != nullptr && other != nullptr) {
            throw ProblemError(as_written(*one) + " and " + as_written(*other) +
                               " belong to different kinds of problem: give [nondimensional], or [actuator] and "
                               "[material], or [spring-mass]");
        }
    }
    if (type_name == spring_name && (nondimensional != nullptr || si != nullptr)) {
        throw bad_value(*type, "does not go with " + as_written(*(nondimensional != nullptr ? nondimensional : si)));
    }
    if (type_name == dielectric_name && spring != nullptr) {
        throw bad_value(*type, "does not go with " + as_written(*spring));
    }
    if (nondimensional != nullptr) { return Family::dielectric_elastomer_nondimensional; }
    if (spring != nullptr || type_name == spring_name) { return Family::spring_mass; }
    if (si != nullptr || type_name == dielectric_name) { return Family::dielectric_elastomer_si; }
    throw ProblemError("no actuator is described: give [nondimensional], or [actuator] and [material], or "
                       "[spring-mass]");
}

std::string text_of(Key key, double value) { return model::format_quantity(value, model::key_info(key).unit); }

Section actuator_section() {
    std::vector<Row> rows = {setting<design::Problem>(
        "actuator.type", "", "dielectric-elastomer | spring-mass", "told by the sections present", "kind of actuator",
        [](design::Problem&, const Setting&, const Context&) {},  // read before all else, by family_of
        [](const design::Problem& problem, const Context&) {
            const bool is_spring = problem.actuator.family == Family::spring_mass;
            return std::vector<Echo>{{std::string(is_spring ? spring_name : dielectric_name)}};
        })};
    for (std::size_t i = 0; i < model::key_count; ++i) { rows.push_back(key_row(static_cast<Key>(i))); }
    rows.push_back(choice<design::Problem, model::StopLaw>(
        "stop.law", [](auto& problem) -> auto& { return problem.actuator.law; }, stop_laws(),
        "force law of the stop; none: there is no stop"));
    rows.push_back(setting<design::Problem>(
        "drive.margin", "", margin_range, model::number_text(design::Problem().margin),
        "operate this fraction of the edge below it",
        [](design::Problem& problem, const Setting& s, const Context&) { problem.margin = parse_margin(s); },
        [](const design::Problem& problem, const Context&) {
            return model::has_frequency(problem.actuator) ? std::vector<Echo>{}
                                                          : std::vector<Echo>{number_echo(problem.margin, "")};
        }));
    Section section = section_of<design::Problem>(std::move(rows));
    section.of_problem = true;
    section.in_file_order = true;
    return section;
}

}  // namespace percuss::problem
