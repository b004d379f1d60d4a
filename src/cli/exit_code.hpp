#pragma once
/// \file

#include "verbs/study.hpp"

#include <string_view>

namespace percuss::cli {

inline constexpr int exit_done = 0;
inline constexpr int exit_internal_error = 1;
inline constexpr int exit_bad_input = 2;
inline constexpr int exit_infeasible = 3;
inline constexpr int exit_not_certified = 4;
inline constexpr int exit_some_failed = 5;
inline constexpr int exit_interrupted = 130;

int exit_code(verbs::Ending ending);
std::string_view ending_text(verbs::Ending ending);

}  // namespace percuss::cli
