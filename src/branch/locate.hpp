#pragma once
/// \file
/// Boundaries between two neighbouring points of a piece.

#include "branch/branch.hpp"
#include "branch/piece.hpp"

#include <vector>

namespace percuss::branch {

/// A point of a piece: its scaled unknowns, the slope of the parameter along the way of travel, what was seen.
struct Standing {
    numerics::Vector u;
    double slope = 0.0;
    Point point;
};

/// Which boundaries lie between two points: a fold where the slope changes sign, a flip where the number of real
/// multipliers beyond -1 changes parity, a torus where a pair crosses the circle.
std::vector<boundary::Kind> boundaries_between(const Standing& a, const Standing& b);

/// Refines one of them by Newton's method on the extended system, from an interpolation of its test function; when the
/// result does not lie between the two points, the bracket is halved along `piece` (which stands at b) and tried again.
BoundaryPoint locate(const flow::Family& family, Piece& piece, boundary::Kind kind, const Standing& a,
                     const Standing& b, double size, long& solves);

/// The smallest entry speed of a sequence, 1 for other forms: fold tests are divided by it, see boundary/critical.hpp.
double lowest_speed(const orbit::Motion& motion);

}  // namespace percuss::branch
