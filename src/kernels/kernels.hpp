#pragma once
/// \file
/// Where models meet integrators: one factory that picks the specialised kernel for a scene once and for all.

#include "flow/flow.hpp"
#include "model/contact_law.hpp"
#include "model/scene.hpp"

#include <memory>
#include <span>
#include <string>
#include <string_view>

namespace percuss::kernels {

struct IntegratorOptions {
    std::string integrator = "taylor";     ///< taylor | erk | cvode; `auto` is resolved by choose_integrator()
    double tolerance = 1e-13;              ///< relative, per step
    std::string instruction_set = "auto";  ///< auto | v2 | v3 | v4 | generic (x86-64 levels)
};

/// Throws std::invalid_argument for an unknown integrator, an instruction set that this build or processor does not
/// have, a tolerance outside [1e-16, 1e-2], or a scene that is not in model::Scenes.
std::unique_ptr<flow::Integrator> make_integrator(const model::Scene& scene, model::ContactLaw law,
                                                  const IntegratorOptions& options = {});

/// What solver.integrator = auto stands for at these parameters, "taylor" or "cvode": the latter where the system is so
/// stiff that an implicit method is the faster one. That is where a decay takes less than 1e-4 of a radian of the
/// drive, or where an overdamped stop could hold the mass for 1e5 times its own decay. Parameters without a frequency
/// count at the natural one. Other words are returned as they are. Throws std::invalid_argument for a scene that is not
/// in model::Scenes.
std::string choose_integrator(std::string_view requested, const model::Scene& scene, model::ContactLaw law,
                              const flow::ParameterVector& parameters);

/// The set that `requested` ("auto" or a name) resolves to on this processor. Throws std::invalid_argument.
std::string_view instruction_set_in_use(std::string_view requested);

/// Sets compiled in and supported by this processor, weakest first.
std::span<const std::string_view> instruction_sets();

}  // namespace percuss::kernels
