#pragma once
/// \file
/// Single values of problem files. The parsers throw ProblemError naming key, value and what is allowed.

#include "problem/setting_list.hpp"

#include "model/specification.hpp"

#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace percuss::problem {

inline constexpr int largest_count = 1'000'000'000;

/// A whole number within bounds.
int parse_count(const Setting& setting, int lowest, int highest = largest_count);

/// A number strictly between two bounds.
double parse_between(const Setting& setting, double above, double below);

/// One of several words.
std::string parse_choice(const Setting& setting, std::span<const std::string> choices);

/// So many finite numbers separated by commas or blanks.
std::vector<double> parse_state(const Setting& setting, std::size_t size);

/// A share below one half, as a number or in percent.
double parse_margin(const Setting& setting);

/// "a | b | c".
std::string alternatives(std::span<const std::string> names);

/// A state as it is written; its numbers read back exactly.
std::string state_text(const std::vector<double>& state);

/// Numbers in a state of this family.
std::size_t states_of(const model::Actuator& family);

}  // namespace percuss::problem
