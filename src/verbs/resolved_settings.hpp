#pragma once
/// \file
/// A problem written back as settings, every value in force with its origin.

#include "verbs/problem_file.hpp"
#include "verbs/setting_list.hpp"

#include <vector>

namespace percuss::verbs {

/// The settings in force of an interpreted problem, marked with the troubles it already carries. `given` tells where
/// each came from.
std::vector<ResolvedSetting> resolve_settings(const ProblemFile& problem, const SettingList& given);

}  // namespace percuss::verbs
