#pragma once
/// \file
/// A problem written back as settings, every value in force with its origin.

#include "problem/problem_file.hpp"

#include <vector>

namespace percuss::problem {

/// The struct that a section's rows set.
const void* options_of(const ProblemFile& problem, const Section& section);

/// The settings in force of an interpreted problem, marked with the troubles it already carries. `given` tells where
/// each came from.
std::vector<ResolvedSetting> resolve_settings(const ProblemFile& problem, std::span<const Section> sections,
                                              const SettingList& given);

}  // namespace percuss::problem
