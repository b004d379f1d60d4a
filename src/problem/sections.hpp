#pragma once
/// \file
/// The sections that every problem has: the actuator, the design, how uniqueness is checked, the solver.

#include "design/problem.hpp"
#include "problem/row.hpp"

#include <string>
#include <string_view>

namespace percuss::problem {

/// [actuator] [material] [stop] [drive] [nondimensional] [spring-mass]
Section actuator_section();
/// [design]
Section design_section();
/// [uniqueness]
Section uniqueness_section();
/// [solver]
Section solver_section();

/// The kind of problem told by the sections and actuator.type. Throws ProblemError for none and for mixtures.
const model::Actuator& family_of(const SettingList& settings);

/// A number for this key: plain for nondimensional keys, else with an optional unit. Throws std::invalid_argument.
double parse_key_value(model::Key key, std::string_view text);

/// A key of the family by name. Throws ProblemError that names the nearest one.
model::Key parse_key(std::string_view name, const model::Actuator& family);

/// Value with its unit, for people.
std::string text_of(model::Key key, double value);

}  // namespace percuss::problem
