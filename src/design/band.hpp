#pragma once
/// \file
/// The band of drive frequencies around an operating point in which the tuned motion is stable, strikes, and is alone.

#include "design/problem.hpp"
#include "flow/flow.hpp"
#include "numerics/cancel.hpp"
#include "orbit/orbit.hpp"

#include <span>
#include <string>
#include <vector>

namespace percuss::design {

struct BandEnd {
    bool found = false;
    double omega = 0.0;
    double error = 0.0;           ///< of omega: Newton's, or the distance of the two frequencies it lies between
    std::vector<double> d_omega;  ///< along each direction; empty where the end was only bracketed
    std::string reason;           ///< "fold", "grazing of the free motion", "window of a motion of period 3", ...
};

struct Band {
    BandEnd lower;
    BandEnd upper;
    long starts = 0;  ///< followed in the search for other motions, over all frequencies
};

struct BandCase {
    const flow::System& system;  ///< at the operating frequency
    const flow::System& scout;   ///< the same, looser
    const orbit::Orbit& orbit;   ///< the tuned one, stable and striking
    double edge_omega;           ///< where the free motion begins to graze; NaN where unknown
    std::span<const double> d_edge;
    std::span<const flow::ParameterVector> directions;  ///< their omega entries are zero
    const Sampling* sampling;                           ///< null: other periods are not looked for
    const numerics::CancelRequest& cancelled;           ///< then the search ends with what is known
};

/// First the ends of the motion's own branch (fold, flip, torus, grazing), and the edge above which the free motion
/// coexists. Then, with sampling, starts at frequencies spread from the operating point to both ends: where one leads
/// to another motion, that motion's window (design/window.hpp) is the end, or the bracket where it cannot be followed.
Band single_stable_band(const BandCase& c, const model::Specification& design);

}  // namespace percuss::design
