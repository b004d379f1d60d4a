#pragma once
/// \file
/// One table per instruction set: for every scene of model::Scenes the Taylor kernels by number of sensitivity lanes,
/// and the kernel that follows many starts at once.

#include "flow/flow.hpp"
#include "model/contact_law.hpp"
#include "model/scenes.hpp"

#include <array>
#include <cstddef>
#include <span>

namespace percuss::kernels {

/// What stays fixed for an integrator.
struct TaylorSettings {
    model::ContactLaw law = model::ContactLaw::kelvin_voigt;
    int order = 17;
};

using TaylorKernel = void (*)(const flow::ParameterVector&, const TaylorSettings&, const flow::Request&, flow::Result&);
using EnsembleKernel = void (*)(const flow::ParameterVector&, const TaylorSettings&, const flow::EnsembleRequest&,
                                std::span<flow::EnsembleMember>);

/// Kernels exist for 0, up to 4 and up to 8 directions.
inline constexpr std::array<int, 3> lane_classes = {0, 4, 8};

inline constexpr std::size_t scene_count = model::Scenes::count;
using TaylorTable = std::array<std::array<TaylorKernel, lane_classes.size()>, scene_count>;
using EnsembleTable = std::array<EnsembleKernel, scene_count>;

/// Place of a scene in model::Scenes. Throws std::invalid_argument when it is not there.
std::size_t scene_index(const model::Scene& scene);

#ifdef PERCUSS_HAVE_GENERIC
const TaylorTable& taylor_table_generic();
const EnsembleTable& ensemble_table_generic();
#endif
#ifdef PERCUSS_HAVE_V2
const TaylorTable& taylor_table_v2();
const EnsembleTable& ensemble_table_v2();
#endif
#ifdef PERCUSS_HAVE_V3
const TaylorTable& taylor_table_v3();
const EnsembleTable& ensemble_table_v3();
#endif
#ifdef PERCUSS_HAVE_V4
const TaylorTable& taylor_table_v4();
const EnsembleTable& ensemble_table_v4();
#endif

}  // namespace percuss::kernels
