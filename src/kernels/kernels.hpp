#pragma once
/// \file
/// Where models meet integrators: one factory that picks the specialised kernel for a scene once and for all.

#include "flow/flow.hpp"
#include "model/parameters.hpp"

#include <memory>
#include <span>
#include <string>
#include <string_view>

namespace percuss::kernels {

struct IntegratorOptions {
    std::string integrator = "taylor";     ///< taylor | erk | cvode
    double tolerance = 1e-13;              ///< relative, per step
    std::string instruction_set = "auto";  ///< auto | v2 | v3 | v4 | generic (x86-64 levels)
};

/// Scene: actuator type, stop law, and whether the Maxwell branches are there at all (mu_ratio above zero); without
/// them the Taylor integrator drops the viscous states. Throws std::invalid_argument for an unknown integrator, an
/// instruction set that this build or processor does not have, or a tolerance outside [1e-16, 1e-2].
std::unique_ptr<flow::Integrator> make_integrator(model::ActuatorKind kind, model::StopLaw law, bool viscous,
                                                  const IntegratorOptions& options = {});

/// The set that `requested` ("auto" or a name) resolves to on this processor. Throws std::invalid_argument.
std::string_view instruction_set_in_use(std::string_view requested);

/// Sets compiled in and supported by this processor, weakest first.
std::span<const std::string_view> instruction_sets();

}  // namespace percuss::kernels
