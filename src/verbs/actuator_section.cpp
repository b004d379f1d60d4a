#include "verbs/problem_sections.hpp"

#include "model/number_text.hpp"
#include "model/units.hpp"
#include "problem/nearest_name.hpp"

#include <algorithm>
#include <array>
#include <utility>

namespace percuss::verbs {

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

model::StopLaw parse_law(const Setting& setting) {
    const std::string_view text = model::trimmed(setting.value);
    if (text == "kelvin-voigt") { return model::StopLaw::kelvin_voigt; }
    if (text == "no-tension") { return model::StopLaw::no_tension; }
    if (text == "none") { return model::StopLaw::none; }
    throw bad_value(setting, "must be kelvin-voigt, no-tension or none");
}

double parse_margin(const Setting& setting) {
    double margin = 0.0;
    try {
        margin = model::parse_quantity(setting.value, "1");
    } catch (const std::invalid_argument& error) { throw bad_value(setting, error.what()); }
    if (!(margin >= 0.0 && margin < 1.0)) { throw bad_value(setting, "out of range, must be at least 0, below 1"); }
    return margin;
}

}  // namespace

bool is_frequency(Key key) { return key == Key::drive_frequency || key == Key::nd_omega || key == Key::sm_omega; }

double parse_key_value(Key key, std::string_view text) {
    const model::KeyInfo& info = model::key_info(key);
    return info.name.starts_with("nondimensional.") ? model::parse_plain_number(text)
                                                    : model::parse_quantity(text, info.unit);
}

model::Key parse_key(std::string_view name, Family family) {
    std::vector<std::string> names;
    for (const Key key : model::keys_of(family)) {
        if (model::key_info(key).name == name) { return key; }
        names.emplace_back(model::key_info(key).name);
    }
    throw ProblemError("'" + std::string(name) + "' is not a key of " + std::string(describe(family)) +
                       "; the nearest one is " + problem::nearest_name(name, names));
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

void read_actuator(const SettingList& settings, design::Problem& problem, Troubles& troubles) {
    for (const Setting& setting : settings.all()) {
        if (const auto key = model::find_key(setting.key)) {
            troubles.attempt([&] { read_key(setting, *key, problem.actuator); });
        } else if (setting.key == "stop.law") {
            troubles.attempt([&] { problem.actuator.law = parse_law(setting); });
        } else if (setting.key == "drive.margin") {
            troubles.attempt([&] { problem.margin = parse_margin(setting); });
        }
    }
}

}  // namespace percuss::verbs
