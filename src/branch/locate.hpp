#pragma once
/// \file
/// Boundaries between two neighbouring points of a piece.

#include "branch/branch.hpp"
#include "branch/piece.hpp"

#include <vector>

namespace percuss::branch {

/// A point of a piece: its scaled unknowns, the slope of the parameter along the way of travel, what was seen.
struct CurvePoint {
    numerics::Vector u;
    double slope = 0.0;
    Point point;
    boundary::Kind on = boundary::Kind::none;  ///< a fold or flip itself, one of whose multipliers is +1 or -1
};

/// Whether a boundary lies between two points: a fold where the slope changes sign, a flip where the number of real
/// multipliers beyond -1 changes parity. A torus (no fold or flip in between) where the unstable dimension changes: a
/// pair has crossed the circle, whatever real multipliers it came from or went to.
bool lies_between(boundary::Kind kind, const CurvePoint& a, const CurvePoint& b);

/// Boundaries between two points of `piece`, which stands at b or beyond, in order. Folds and flips are found first;
/// torus points between them.
std::vector<BoundaryPoint> boundaries_between(const flow::ParameterFamily& family, Piece& piece, const CurvePoint& a,
                                              const CurvePoint& b, double size, long& solves);

/// Where a point lies between two others: share of the way, distance from the straight line in units of its length.
struct Place {
    double share = 0.0;
    double aside = 0.0;
    // The arc of a step turns by 0.35 rad at most and departs from its chord by 0.04 of the length: limits as wide as
    // these tell another part of the curve from this one, and let a boundary at an end of the step pass.
    [[nodiscard]] bool between() const { return share > -0.1 && share < 1.1 && aside < 0.5; }
};
Place place_of(const numerics::Vector& u, const numerics::Vector& a, const numerics::Vector& b);

/// The smallest entry speed of a sequence, 1 for other forms: fold tests are divided by it, see boundary/critical.hpp.
double lowest_speed(const orbit::Motion& motion);

}  // namespace percuss::branch
