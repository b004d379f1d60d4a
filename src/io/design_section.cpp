#include "io/problem_sections.hpp"

#include "io/nearest_name.hpp"
#include "model/number_text.hpp"
#include "model/units.hpp"

#include <algorithm>
#include <cmath>

namespace percuss::io {

namespace {

using design::Quantity;
using model::trimmed;

/// A list given as "none" is empty.
bool is_empty_list(const Setting& setting) { return trimmed(setting.value) == "none"; }

/// Removes `word` from the end of `text` if it stands there by itself.
bool take_last_word(std::string_view& text, std::string_view word) {
    if (!text.ends_with(word)) { return false; }
    const std::string_view before = text.substr(0, text.size() - word.size());
    if (before.empty() || (before.back() != ' ' && before.back() != '\t')) { return false; }
    text = trimmed(before);
    return true;
}

double parse_bound(model::Key key, std::string_view text) {
    const model::KeyInfo& info = model::key_info(key);
    const double value = parse_key_value(key, text);
    const bool above = info.lowest_allowed ? value >= info.lowest : value > info.lowest;
    if (!(above && value <= info.highest)) {
        throw std::invalid_argument("'" + std::string(trimmed(text)) + "' is out of range: " + std::string(info.name) +
                                    " must be " + allowed_range(info));
    }
    return value;
}

design::DesignVariable parse_variable(const Setting& setting, const model::Actuator& family) {
    constexpr std::string_view form = "expected KEY in LOWER .. UPPER [log] [integer]";
    const std::string_view text = trimmed(setting.value);
    const auto in = text.find(" in ");
    const auto dots = in == std::string_view::npos ? in : text.find("..", in);
    if (dots == std::string_view::npos) { throw bad_value(setting, std::string(form)); }
    std::string_view upper = trimmed(text.substr(dots + 2));
    design::DesignVariable variable;
    while (true) {
        if (!variable.logarithmic && take_last_word(upper, "log")) {
            variable.logarithmic = true;
        } else if (!variable.integer && take_last_word(upper, "integer")) {
            variable.integer = true;
        } else {
            break;
        }
    }
    try {
        variable.key = parse_key(trimmed(text.substr(0, in)), family);
        variable.lower = parse_bound(variable.key, text.substr(in + 4, dots - in - 4));
        variable.upper = parse_bound(variable.key, upper);
    } catch (const std::invalid_argument& error) {
        throw bad_value(setting, error.what());
    } catch (const ProblemError& error) { throw bad_value(setting, error.what()); }
    const bool single_value = variable.integer && variable.lower == variable.upper;
    if (!(variable.lower < variable.upper || single_value)) {
        throw bad_value(setting, "the range is reversed or empty: LOWER must be below UPPER");
    }
    if (variable.logarithmic && !(variable.lower > 0.0)) {
        throw bad_value(setting, "a log range needs LOWER above 0");
    }
    if (variable.integer &&
        (std::floor(variable.lower) != variable.lower || std::floor(variable.upper) != variable.upper)) {
        throw bad_value(setting, "an integer range needs whole numbers as bounds");
    }
    return variable;
}

void add_variable(const Setting& setting, design::Problem& problem) {
    const auto variable = parse_variable(setting, *problem.actuator.type);
    const auto same = [&](const design::DesignVariable& other) { return other.key == variable.key; };
    if (std::any_of(problem.variables.begin(), problem.variables.end(), same)) {
        throw bad_value(setting, "this key is a variable already");
    }
    if (model::is_of_stop(variable.key) && !model::has_stop(problem.actuator.law)) {
        throw bad_value(setting, "stop.law = none: there is no stop to vary");
    }
    problem.variables.push_back(variable);
}

Quantity parse_quantity_name(const Setting& setting, std::string_view name, const model::Actuator& family) {
    std::vector<std::string> names;
    for (const Quantity quantity : design::reported_quantities(family)) {
        names.emplace_back(design::quantity_info(quantity).name);
    }
    const auto quantity = design::find_quantity(name);
    if (!quantity) {
        throw bad_value(setting, "'" + std::string(name) + "' is not a quantity; the nearest one is " +
                                     nearest_name(name, names));
    }
    const std::string_view why_not = design::unavailable(*quantity, family);
    if (!why_not.empty()) { throw bad_value(setting, std::string(name) + " " + std::string(why_not)); }
    return *quantity;
}

void add_objective(const Setting& setting, bool maximise, design::Problem& problem) {
    const auto quantity = parse_quantity_name(setting, trimmed(setting.value), *problem.actuator.type);
    if (!design::quantity_info(quantity).smooth) {
        throw bad_value(setting, "is a whole number and has no gradient: it cannot be an objective");
    }
    const auto same = [&](const design::Objective& other) { return other.quantity == quantity; };
    if (std::any_of(problem.objectives.begin(), problem.objectives.end(), same)) {
        throw bad_value(setting, "this quantity is an objective already");
    }
    problem.objectives.push_back({quantity, maximise});
}

design::Limit parse_limit(const Setting& setting, const model::Actuator& family) {
    const std::string_view text = trimmed(setting.value);
    const auto at_most = text.find("<=");
    const auto at_least = text.find(">=");
    const auto position = std::min(at_most, at_least);
    if (position == std::string_view::npos) {
        throw bad_value(setting, "expected QUANTITY <= VALUE or QUANTITY >= VALUE");
    }
    design::Limit limit;
    limit.quantity = parse_quantity_name(setting, trimmed(text.substr(0, position)), family);
    limit.upper = position == at_most;
    limit.text = text;
    const std::string_view bound = text.substr(position + 2);
    try {
        limit.bound = family.nondimensional ? model::parse_plain_number(bound)
                                            : model::parse_quantity(bound, design::quantity_info(limit.quantity).unit);
    } catch (const std::invalid_argument& error) { throw bad_value(setting, error.what()); }
    return limit;
}

design::SingleStable parse_single_stable(const Setting& setting) {
    const std::string_view text = trimmed(setting.value);
    if (text == "off") { return design::SingleStable::off; }
    if (text == "orbit") { return design::SingleStable::orbit; }
    if (text == "sampled") { return design::SingleStable::sampled; }
    if (text == "refuted") { return design::SingleStable::refuted; }
    throw bad_value(setting, "must be off, orbit, sampled or refuted");
}

}  // namespace

void read_design(const SettingList& settings, design::Problem& problem, Troubles& troubles) {
    for (const Setting& setting : settings.all()) {
        troubles.attempt([&] {
            if (setting.key == "design.single_stable") {
                problem.single_stable = parse_single_stable(setting);
            } else if (!setting.key.starts_with("design.") || is_empty_list(setting)) {
                return;
            } else if (setting.key == "design.variable") {
                add_variable(setting, problem);
            } else if (setting.key == "design.maximise") {
                add_objective(setting, true, problem);
            } else if (setting.key == "design.minimise") {
                add_objective(setting, false, problem);
            } else if (setting.key == "design.limit") {
                problem.limits.push_back(parse_limit(setting, *problem.actuator.type));
            }
        });
    }
}

}  // namespace percuss::io
