#pragma once
/// \file
/// One table of ensemble kernels per instruction set: many starts of a scene, several of them at once.

#include "flow/flow.hpp"
#include "kernels/taylor_table.hpp"

#include <array>
#include <span>

namespace percuss::kernels {

using EnsembleKernel = void (*)(const flow::ParameterVector&, const TaylorSettings&, const flow::EnsembleRequest&,
                                std::span<flow::EnsembleMember>);
using EnsembleTable = std::array<EnsembleKernel, scene_count>;

#ifdef PERCUSS_HAVE_GENERIC
const EnsembleTable& ensemble_table_generic();
#endif
#ifdef PERCUSS_HAVE_V2
const EnsembleTable& ensemble_table_v2();
#endif
#ifdef PERCUSS_HAVE_V3
const EnsembleTable& ensemble_table_v3();
#endif
#ifdef PERCUSS_HAVE_V4
const EnsembleTable& ensemble_table_v4();
#endif

}  // namespace percuss::kernels
