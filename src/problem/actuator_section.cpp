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

using model::Key;

/// "; use KEY" where this kind of problem has a key of its own for the same thing, else nothing.
std::string counterpart_hint(Key key, const model::Actuator& actuator) {
    const auto own = model::counterpart(key, actuator);
    return own ? "; use " + std::string(model::key_info(*own).name) : "";
}

/// Sets a key from a setting. Throws ProblemError for a key of another kind of problem or a value that cannot be read.
void read_key(const Setting& setting, Key key, model::Specification& spec) {
    if (!model::belongs(key, *spec.type)) {
        throw ProblemError(as_written(setting) + ": this is " + std::string(spec.type->kind) +
                           ", which has no such key" + counterpart_hint(key, *spec.type));
    }
    if (model::is_frequency(key) && model::trimmed(setting.value) == "edge") {
        return;  // absent means edge
    }
    try {
        spec.set(key, parse_key_value(key, setting.value));
    } catch (const std::invalid_argument& error) {
        throw ProblemError((setting.from_option ? "option --" : "") + setting.key + ": " + error.what() +
                           (model::is_frequency(key) ? ", or edge" : ""));
    }
}

/// The other way to give the frequency is in use.
bool is_replaced(const model::Specification& spec, Key key) {
    return model::is_frequency(key) && !spec.has(key) && model::has_frequency(spec);
}

/// How a key is told: its value, "edge" for a frequency that is absent, an empty text for one that is missing, nothing
/// where it does not belong.
std::vector<Echo> key_echo(const model::Specification& spec, Key key) {
    if (!model::belongs(key, *spec.type) || is_replaced(spec, key)) { return {}; }
    if (spec.has(key)) { return {number_echo(spec.value(key), model::key_info(key).unit)}; }
    if (model::is_frequency(key)) {  // of several ways to give it the usual one says edge
        return key == model::frequency_key(spec) ? std::vector<Echo>{{"edge"}} : std::vector<Echo>{};
    }
    if (model::is_required(spec, key)) { return {{""}}; }
    return {};
}

/// The row of a key of the model: range, unit and default from its KeyInfo.
Row key_row(Key key) {
    const model::KeyInfo& info = model::key_info(key);
    const std::string edge = model::is_frequency(key) ? "edge" : "";
    return setting<design::Problem>(
        std::string(info.name), info.unit == "1" ? "" : std::string(info.unit),
        allowed_range(info) + (edge.empty() ? "" : ", or edge"),
        info.fallback ? model::number_text(*info.fallback) : edge, std::string(info.meaning),
        [key](design::Problem& problem, const Setting& s, const Context&) { read_key(s, key, problem.actuator); },
        [key](const design::Problem& problem, const Context&) { return key_echo(problem.actuator, key); });
}

/// Every law that the table of contact laws knows.
const Words<model::ContactLaw>& contact_laws() {
    static const Words<model::ContactLaw> words = [] {
        Words<model::ContactLaw> list;
        for (const model::ContactLaw law : model::contact_laws) { list.emplace_back(model::to_string(law), law); }
        return list;
    }();
    return words;
}

/// What the rows of the registry say of themselves, told once each: "a, b or c" with `comma` ", " and `last` " or ".
std::string choices(std::string_view model::Actuator::*words, std::string_view comma, std::string_view last) {
    std::vector<std::string_view> list;
    for (const model::Actuator* row : model::actuators()) {
        const std::string_view text = row->*words;
        if (std::find(list.begin(), list.end(), text) == list.end()) { list.push_back(text); }
    }
    std::string out;
    for (std::size_t i = 0; i < list.size(); ++i) {
        if (i > 0) { out += i + 1 == list.size() ? last : comma; }
        out += list[i];
    }
    return out;
}

std::string sections_to_give() { return choices(&model::Actuator::sections_in_words, ", or ", ", or "); }

}  // namespace

double parse_key_value(Key key, std::string_view text) {
    const model::KeyInfo& info = model::key_info(key);
    if (info.name.starts_with("nondimensional.")) { return model::parse_plain_number(text); }
    // The likeliest slip, and wrong by 2 pi: the message does the conversion. What only looks like rad/s goes to the
    // general reader for its message.
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

model::Key parse_key(std::string_view name, const model::Actuator& family) {
    std::vector<std::string> names;
    for (const Key key : family.keys) {
        if (model::key_info(key).name == name) { return key; }
        names.emplace_back(model::key_info(key).name);
    }
    throw ProblemError("'" + std::string(name) + "' is not a key of " + std::string(family.kind) +
                       "; the nearest one is " + nearest_name(name, names));
}

const model::Actuator& family_of(const SettingList& settings) {
    const Setting* type = settings.find("actuator.type");
    const std::string_view type_name = type == nullptr ? "" : model::trimmed(type->value);
    const auto rows = model::actuators();
    const auto is_named = [&](const model::Actuator* row) { return row->type == type_name; };
    if (type != nullptr && std::none_of(rows.begin(), rows.end(), is_named)) {
        throw bad_value(*type, "must be " + choices(&model::Actuator::type, ", ", " or "));
    }
    // The first setting of a row's own sections, where there is one.
    const auto evidence = [&](const model::Actuator& row) -> const Setting* {
        for (const std::string_view section : row.sections) {
            for (const Setting& setting : settings.all()) {
                if (setting.key.starts_with(section) && setting.key != "actuator.type") { return &setting; }
            }
        }
        return nullptr;
    };
    const model::Actuator* described = nullptr;
    for (const model::Actuator* row : rows) {
        const Setting* found = evidence(*row);
        // Sections decide, as they say more than the type: two kinds of problem share one type.
        if (found == nullptr) { continue; }
        if (described != nullptr) {
            throw ProblemError(as_written(*evidence(*described)) + " and " + as_written(*found) +
                               " belong to different kinds of problem: give " + sections_to_give());
        }
        described = row;
    }
    if (described != nullptr && type != nullptr && described->type != type_name) {
        throw bad_value(*type, "does not go with " + as_written(*evidence(*described)));
    }
    if (described != nullptr) { return *described; }
    for (const model::Actuator* row : rows) {
        // The type alone, with no key of it yet: enough to say which keys are missing.
        if (row->follows_type && row->type == type_name) { return *row; }
    }
    throw ProblemError("no actuator is described: give " + sections_to_give());
}

std::string text_of(Key key, double value) { return model::format_quantity(value, model::key_info(key).unit); }

Section actuator_section() {
    std::vector<Row> rows = {setting<design::Problem>(
        "actuator.type", "", choices(&model::Actuator::type, " | ", " | "), "told by the sections present",
        "kind of actuator",
        [](design::Problem&, const Setting&, const Context&) {},  // read before all else, by family_of
        [](const design::Problem& problem, const Context&) {
            return std::vector<Echo>{{std::string(problem.actuator.type->type)}};
        })};
    for (const Key key : model::all_keys()) { rows.push_back(key_row(key)); }
    rows.push_back(choice<design::Problem, model::ContactLaw>(
        "stop.law", [](auto& problem) -> auto& { return problem.actuator.law; }, contact_laws(),
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
