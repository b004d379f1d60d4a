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
    std::string integrator = "taylor";     ///< taylor | erk | cvode
    double tolerance = 1e-13;              ///< relative, per step
    std::string instruction_set = "auto";  ///< auto | v2 | v3 | v4 | generic (x86-64 levels)
};

/// Throws std::invalid_argument for an unknown integrator, an instruction set that this build or processor does not
/// have, a tolerance outside [1e-16, 1e-2], or a scene that is not in model::Scenes.
std::unique_ptr<flow::Integrator> make_integrator(const model::Scene& scene, model::ContactLaw law,
                                                  const IntegratorOptions& options = {});

/// The set that `requested` ("auto" or a name) resolves to on this processor. Throws std::invalid_argument.
std::string_view instruction_set_in_use(std::string_view requested);

/// Sets compiled in and supported by this processor, weakest first.
std::span<const std::string_view> instruction_sets();

}  // namespace percuss::kernels
