#pragma once
/// \file
/// The quantities band_lower and band_upper of an evaluation: the band of band.hpp in the problem's units.

#include "design/evaluation.hpp"
#include "design/measure.hpp"
#include "design/operating_point.hpp"

#include <span>

namespace percuss::design {

struct BandRequest {
    const Operation& operation;
    const orbit::Orbit& orbit;  ///< the tuned one, stable and striking
    const model::Specification& actuator;
    const model::Scales& scales;
    const Problem& problem;
    std::span<const KeyDirection> keys;  ///< as for the orbit
    const Demand& demand;
};

bool wants_band(const Demand& demand);

/// Fills both quantities, their gradients, errors and the reasons for what ends the band. An end that was not found
/// stays absent; one that was only bracketed has an absent gradient.
void measure_band(const BandRequest& request, Evaluation& evaluation);

}  // namespace percuss::design
