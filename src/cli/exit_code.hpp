#pragma once
/// \file

#include "verbs/session.hpp"

namespace percuss::cli {

inline constexpr int exit_done = 0;
inline constexpr int exit_internal_error = 1;
inline constexpr int exit_bad_input = 2;

int exit_code(verbs::Ending ending);

}  // namespace percuss::cli
