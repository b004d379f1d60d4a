#pragma once
/// \file

#include "verbs/verbs.hpp"

#include <cstddef>
#include <string>

namespace percuss::cli {

/// Help texts, wrapped to so many columns.
std::string general_help(std::size_t width);
std::string verb_help(const verbs::Verb& verb, std::size_t width);
/// Every key; every quantity with unit, meaning and the actuators that have it.
std::string keys_help(std::size_t width);
std::string quantities_help(std::size_t width);

/// Columns of the terminal that stdout is, 80 when it is none.
std::size_t terminal_width();

}  // namespace percuss::cli
