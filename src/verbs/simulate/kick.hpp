#pragma once
/// \file
/// A kick as it is written in problem files.

#include "model/specification.hpp"
#include "problem/setting.hpp"
#include "verbs/simulate/simulate.hpp"

#include <string>

namespace percuss::verbs {

/// "velocity 0.05 m/s at cycle 50", "voltage 50 % for 2 cycles at cycle 50". Throws problem::ProblemError that shows
/// both forms.
Kick parse_kick(const problem::Setting& setting, const model::Actuator& family);

/// The same text back; its numbers read back exactly.
std::string kick_text(const Kick& kick, const model::Actuator& family);

}  // namespace percuss::verbs
