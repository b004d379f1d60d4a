#include "problem/values.hpp"

#include "model/number_text.hpp"
#include "model/units.hpp"
#include "problem/nearest_name.hpp"

#include <algorithm>
#include <charconv>

namespace percuss::problem {

using model::trimmed;

int parse_count(const Setting& setting, int lowest, int highest) {
    const std::string_view text = trimmed(setting.value);
    int value = 0;
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
    if (error != std::errc() || end != text.data() + text.size() || value < lowest || value > highest) {
        throw bad_value(setting, "must be a whole number, at least " + std::to_string(lowest) +
                                     (highest == largest_count ? "" : ", at most " + std::to_string(highest)));
    }
    return value;
}

double parse_between(const Setting& setting, double above, double below) {
    const auto value = model::whole_number_text(setting.value);
    if (!(value && *value > above && *value < below)) {
        throw bad_value(setting, "must be a number above " + model::number_text(above) + " and below " +
                                     model::number_text(below));
    }
    return *value;
}

std::string parse_choice(const Setting& setting, std::span<const std::string> choices) {
    std::string text(trimmed(setting.value));
    if (std::find(choices.begin(), choices.end(), text) == choices.end()) {
        throw bad_value(setting, "the nearest one known is " + nearest_name(text, choices) + ", all are " +
                                     alternatives(choices));
    }
    return text;
}

std::vector<double> parse_state(const Setting& setting, std::size_t size) {
    std::vector<double> state;
    std::string text = setting.value;
    // "0.1, 0" and "0.1 0" are the same state.
    std::replace(text.begin(), text.end(), ',', ' ');
    std::string_view rest = trimmed(text);
    while (!rest.empty()) {
        const std::string_view word = rest.substr(0, rest.find_first_of(" \t"));
        const auto value = model::whole_number_text(word);
        if (!value) { throw bad_value(setting, "'" + std::string(word) + "' is not a finite number"); }
        state.push_back(*value);
        rest = trimmed(rest.substr(word.size()));
    }
    if (state.size() != size) {
        throw bad_value(setting,
                        "a state has " + std::to_string(size) + " numbers here, not " + std::to_string(state.size()));
    }
    return state;
}

double parse_margin(const Setting& setting) {
    double margin = -1.0;
    try {
        margin = model::parse_quantity(setting.value, "1");
    } catch (const std::invalid_argument& error) { throw bad_value(setting, error.what()); }
    // NaN fails as well.
    if (!(margin >= 0.0 && margin < 0.5)) {
        throw bad_value(setting, "out of range, must be at least 0 and below 0.5 (50 %)");
    }
    return margin;
}

std::string alternatives(std::span<const std::string> names) {
    std::string text;
    for (const std::string& name : names) { text += (text.empty() ? "" : " | ") + name; }
    return text;
}

std::string state_text(const std::vector<double>& state) {
    std::string text;
    for (const double value : state) { text += (text.empty() ? "" : ", ") + model::exact_text(value); }
    return text;
}

std::size_t states_of(const model::Actuator& family) { return family.states.size(); }

}  // namespace percuss::problem
