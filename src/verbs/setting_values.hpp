#pragma once
/// \file
/// Single values of problem files. The parsers throw ProblemError naming key, value and what is allowed.

#include "verbs/setting_list.hpp"

#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace percuss::verbs {

inline constexpr int largest_count = 1'000'000'000;

/// A whole number within bounds.
int parse_count(const Setting& setting, int lowest, int highest = largest_count);

/// A number strictly between two bounds.
double parse_between(const Setting& setting, double above, double below);

/// One of several words.
std::string parse_choice(const Setting& setting, std::span<const std::string> choices);

/// So many finite numbers separated by commas or blanks.
std::vector<double> parse_state(const Setting& setting, std::size_t size);

/// Lets `read` interpret the setting of a key, if it is given.
template <class Read>
void with(const SettingList& settings, std::string_view key, Troubles& troubles, Read read) {
    if (const Setting* setting = settings.find(key)) {
        troubles.attempt([&] { read(*setting); });
    }
}

}  // namespace percuss::verbs
