#pragma once
/// \file
/// From a converged orbit to the quantities asked for, in the problem's units, with gradients and error estimates.

#include "design/evaluation.hpp"
#include "flow/flow.hpp"
#include "orbit/orbit.hpp"

#include <span>
#include <vector>

namespace percuss::design {

/// One key to differentiate by: how parameters and scales move with it. In edge mode `parameters` already contains the
/// motion of the drive frequency.
using KeyDirection = model::Scaled;

struct Measurement {
    bool ok = false;
    orbit::Portrait portrait;
};

/// Which observables of the flow the quantities need.
std::uint32_t observables_for(std::span<const Quantity> quantities);

/// Fills quantities, gradients (of quantities, omega, drive_frequency) and error estimates of `evaluation`.
/// omega_error: uncertainty of the operating frequency, absolute.
Measurement measure(const flow::System& system, const flow::System* tighter, const orbit::Orbit& orbit,
                    const model::Scales& scales, std::span<const KeyDirection> keys, const Demand& demand,
                    double omega_error, Evaluation& evaluation);

}  // namespace percuss::design
