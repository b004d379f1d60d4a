#pragma once
/// \file
/// A boundary followed in two parameters, the drive frequency and another one.

#include "branch/branch.hpp"
#include "branch/piece.hpp"

#include <functional>
#include <string>
#include <vector>

namespace percuss::branch {

struct LocusPoint {
    double omega = 0.0;
    double value = 0.0;       ///< of the second parameter
    double peak_force = 0.0;  ///< nondimensional
    double angle = 0.0;       ///< torus: argument of the multiplier
    orbit::Motion motion;
};

/// Where the second parameter turns along the locus.
struct LocusTurn {
    double omega = 0.0;
    double value = 0.0;
    bool cusp = false;  ///< the frequency turns there too: two boundaries meet and end
};

struct Locus {
    std::vector<LocusPoint> points;
    std::vector<LocusTurn> turns;
    End end = End::not_run;
    std::string end_reason;
    long solves = 0;
};

struct LocusOptions {
    double from = 0.0;  ///< range of the second parameter; the locus sets out from `from`
    double to = 0.0;
    double lowest_omega = 0.0;
    double highest_omega = 1e300;
    double size = 0.1;          ///< of the motions
    std::vector<double> exact;  ///< values of the second parameter that shall be among the points, when passed
    int max_points = 2000;
    std::function<bool()> stop;
};

/// family: parameters (omega, value). start: a boundary at value = options.from, refined in omega.
/// Pseudo-arclength on the extended system of boundary/critical.hpp, until the value leaves the range, the motion stops
/// being one that strikes as assumed (a fold that reaches grazing), or the walker stalls.
Locus follow_boundary(const flow::ParameterFamily& family, const BoundaryPoint& start, const LocusOptions& options);

}  // namespace percuss::branch
