#pragma once
/// \file
/// The scenes as functions to be evaluated point by point, straight from the printed equations (model/plain.hpp).

#include "flow/right_hand_side.hpp"
#include "model/contact_law.hpp"
#include "model/scene.hpp"

#include <memory>

namespace percuss::kernels {

/// Parameters are numbered as in scene.parameters. The result may be shared between threads. Throws
/// std::invalid_argument for a scene that is not in model::Scenes.
std::shared_ptr<const flow::RightHandSide> make_plain_system(const model::Scene& scene, model::ContactLaw law);

}  // namespace percuss::kernels
