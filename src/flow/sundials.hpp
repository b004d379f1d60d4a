#pragma once
/// \file
/// Integrators on top of SUNDIALS, point by point: an independent check of the Taylor integrator, and the path for
/// stiff contact.

#include "flow/flow.hpp"
#include "flow/right_hand_side.hpp"

#include <memory>

namespace percuss::flow {

/// ARKODE's explicit Runge-Kutta method of order 8 (Fehlberg 13-7-8); derivatives by variational equations integrated
/// along. tolerance: relative, per step, dimensionless. Throws std::invalid_argument unless 1e-16 <= tolerance <= 1e-2.
std::unique_ptr<Integrator> make_erk(std::shared_ptr<const RightHandSide> rhs, double tolerance);

/// CVODES' backward differentiation formulas with exact Jacobian; derivatives by its forward sensitivity analysis with
/// exact right-hand sides. For stiff contact. Same arguments as make_erk.
std::unique_ptr<Integrator> make_cvode(std::shared_ptr<const RightHandSide> rhs, double tolerance);

}  // namespace percuss::flow
