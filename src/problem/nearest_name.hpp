#pragma once
/// \file
/// Hints for misspelt names.

#include <span>
#include <string>
#include <string_view>

namespace percuss::problem {

/// Fewest insertions, deletions, replacements and swaps of neighbours that turn one word into the other.
std::size_t edit_distance(std::string_view a, std::string_view b);

/// The name closest to `word`; a dotted name is also compared by its last part, so that "gap" finds "stop.gap".
/// Empty if `names` is.
std::string nearest_name(std::string_view word, std::span<const std::string> names);

}  // namespace percuss::problem
