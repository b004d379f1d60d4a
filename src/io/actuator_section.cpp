#include "io/problem_sections.hpp"

#include "io/nearest_name.hpp"
#include "model/number_text.hpp"
#include "model/units.hpp"

#include <algorithm>
#include <array>
#include <utility>

namespace percuss::io {

namespace {

using model::Key;

std::string counterpart_hint(Key key, const model::Actuator& actuator) {
    const auto own = model::counterpart(key, actuator);
    return own ? "; use " + std::string(model::key_info(*own).name) : "";
}

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

model::ContactLaw parse_law(const Setting& setting) {
    const std::string_view text = model::trimmed(setting.value);
    if (const auto law = model::find_contact_law(text)) { return *law; }
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
    return info.name.starts_with("nondimensional.") ? model::parse_plain_number(text)
                                                    : model::parse_quantity(text, info.unit);
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
        if (row->follows_type && row->type == type_name) { return *row; }
    }
    throw ProblemError("no actuator is described: give " + sections_to_give());
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

}  // namespace percuss::io
