#include "verbs/setting_values.hpp"

#include "model/number_text.hpp"
#include "problem/nearest_name.hpp"
#include "verbs/setting_table.hpp"

#include <algorithm>
#include <charconv>

namespace percuss::verbs {

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
        throw bad_value(setting, "the nearest one known is " + problem::nearest_name(text, choices) + ", all are " +
                                     alternatives(choices));
    }
    return text;
}

std::vector<double> parse_state(const Setting& setting, std::size_t size) {
    std::vector<double> state;
    std::string text = setting.value;
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

}  // namespace percuss::verbs
