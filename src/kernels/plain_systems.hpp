#pragma once
/// \file
/// The two actuator types as functions to be evaluated point by point, straight from the printed equations of
/// model/plain_rhs.hpp.

#include "flow/right_hand_side.hpp"
#include "model/parameters.hpp"

#include <memory>

namespace percuss::kernels {

/// Parameters are numbered as in model::membrane or model::spring. A dielectric elastomer that is not `viscous` has no
/// Maxwell branches, mu_ratio = 0, and the states x and x' only; otherwise it keeps its four states whatever mu_ratio
/// is. The result may be shared between threads.
std::shared_ptr<const flow::RightHandSide> make_plain_system(model::ActuatorKind kind, model::StopLaw law,
                                                             bool viscous = true);

}  // namespace percuss::kernels
