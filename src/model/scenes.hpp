#pragma once
/// \file
/// Every scene that there are kernels for.

#include "model/membrane/scene.hpp"
#include "model/spring/scene.hpp"

#include <cstddef>

namespace percuss::model {
inline namespace PERCUSS_ISA {

template <class... S>
struct SceneList {
    static constexpr std::size_t count = sizeof...(S);
};

/// One line per scene.
using Scenes = SceneList<ViscousScene,  //
                         ElasticScene,  //
                         SpringScene>;

}  // namespace PERCUSS_ISA
}  // namespace percuss::model
