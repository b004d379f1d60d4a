#pragma once
/// \file
/// Continuation of a periodic motion in one parameter through folds, changes of stability and changes of its contacts.

#include "branch/branch.hpp"
#include "branch/piece.hpp"

#include <functional>

namespace percuss::branch {

struct TraceOptions {
    double from = 0.0;  ///< range of the parameter, in either order
    double to = 0.0;
    double size = 0.1;  ///< of the motions: what counts as order one in displacement
    int max_points = 2000;
    StepOptions steps;
    std::function<bool()> stop;  ///< asked after every point; true ends the branch
};

/// Where to set out.
struct Departure {
    orbit::Motion motion;
    double parameter = 0.0;
    double direction = 1.0;  ///< sign of the parameter's first change
    /// Not empty: leaves `motion`, a point of another branch, along this displacement of its scaled unknowns instead.
    numerics::Vector off;
};

/// Follows the branch until it leaves the range, closes, or is lost. Forms of motion change at grazing points: a
/// contact whose entry speed passes through zero is taken out of the sequence, one that the hybrid flow finds new is
/// put in, and the branch goes on to the side where the motion is real.
Branch trace(const flow::ParameterFamily& family, const Departure& departure, const TraceOptions& options);

/// Both ways from a departure, joined to one branch with the parameter rising at the departure.
Branch trace_both_ways(const flow::ParameterFamily& family, const Departure& departure, const TraceOptions& options);

}  // namespace percuss::branch
