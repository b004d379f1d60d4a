#pragma once
/// \file
/// A branch of periodic motions: points, stable and unstable, and the boundaries between them.

#include "branch/point.hpp"

#include <string>
#include <string_view>
#include <vector>

namespace percuss::branch {

/// A grazing, fold, flip or torus point on a branch.
struct BoundaryPoint {
    boundary::Kind kind = boundary::Kind::none;
    Point point;
    std::size_t after = 0;     ///< it lies after this point of the branch
    double uncertainty = 0.0;  ///< of the parameter: the last Newton step, or the bracket where Newton did not converge
    int contact = 0;           ///< grazing: which contact of the motion's sequence touches
    flow::State state_at_zero{};  ///< of the motion, at phase 0 of the drive
    double angle = 0.0;           ///< torus: argument of the multiplier
    int partner = -1;  ///< index of the boundary that makes one physical jump with it (a fold beside a grazing point)
    bool of_half_cycle = false;  ///< flip: multiplier -1 of the half-cycle map, that is loss of the mirror symmetry
};

enum class End : std::uint8_t {
    not_run,
    range,   ///< left the range of the parameter
    joined,  ///< reached, at a flip or a grazing point, a branch of shorter period
    closed,  ///< came back to its start, which is also its last point: an isola
    lost,    ///< could not be followed further
    budget,  ///< as many points as were allowed, or stopped from outside
};

std::string_view to_string(End end);

struct Branch {
    int period = 1;
    int from_branch = -1;  ///< index of the branch it leaves at a flip
    std::vector<Point> points;
    std::vector<BoundaryPoint> boundaries;
    End begin = End::not_run;  ///< how it ends before its first point
    End end = End::not_run;    ///< and after its last
    std::string begin_reason;  ///< one sentence where lost
    std::string end_reason;
    long solves = 0;  ///< orbits and boundaries solved for
    /// Motions without damping: no torus points are looked for, and none of the motions is called stable.
    [[nodiscard]] bool neutral() const;
};

}  // namespace percuss::branch
