#pragma once
/// \file
/// One table of Taylor kernels per instruction set: model x number of sensitivity lanes.

#include "flow/flow.hpp"

#include <array>
#include <cstdint>

namespace percuss::kernels {

/// What stays fixed for an integrator.
struct TaylorSettings {
    std::uint8_t law = 0;  ///< 0 kelvin-voigt, 1 no-tension, 2 none
    int order = 17;
};

using TaylorKernel = void (*)(const flow::ParameterVector&, const TaylorSettings&, const flow::Request&, flow::Result&);

enum class Scene : std::uint8_t {
    membranes,          ///< dielectric elastomer with Maxwell branches
    elastic_membranes,  ///< mu_B = 0: no viscous states
    spring_mass,
};
inline constexpr std::size_t scene_count = 3;
/// Kernels exist for 0, up to 4 and up to 8 directions.
inline constexpr std::array<int, 3> lane_classes = {0, 4, 8};

using TaylorTable = std::array<std::array<TaylorKernel, lane_classes.size()>, scene_count>;

#ifdef PERCUSS_HAVE_GENERIC
const TaylorTable& taylor_table_generic();
#endif
#ifdef PERCUSS_HAVE_V2
const TaylorTable& taylor_table_v2();
#endif
#ifdef PERCUSS_HAVE_V3
const TaylorTable& taylor_table_v3();
#endif
#ifdef PERCUSS_HAVE_V4
const TaylorTable& taylor_table_v4();
#endif

}  // namespace percuss::kernels
