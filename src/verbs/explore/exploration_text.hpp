#pragma once
/// \file
/// The problem of an exploration as the text that its journal keeps: enough to compute, compare and report its table.

#include "problem/problem_file.hpp"

#include <string>

namespace percuss::verbs {

inline constexpr const char* explore_kind = "explore";

/// A line with seed and instruction set (both change the bits of the rows), then every setting that verb explore reads,
/// one a line. explore.samples is left out where the table can be extended.
std::string exploration_text(const problem::ProblemFile& problem, const std::string& instruction_set);

/// The problem back, with its seed; explore.samples as `samples` says. Throws problem::ProblemError.
problem::ProblemFile parse_exploration(const std::string& name, const std::string& text, std::int64_t samples);

}  // namespace percuss::verbs
