#pragma once
/// \file
/// From one branch to another: departures at flips, and whether a motion is already on a branch.

#include "branch/trace.hpp"

#include <optional>

namespace percuss::branch {

/// Where the branch of twice the period leaves at a flip: along the Floquet mode of the multiplier -1, one way in the
/// first half of the doubled period and the other way in the second. At a flip of the half-cycle map the branch of
/// motions without the mirror symmetry, of the same period. Empty when the flow fails.
std::optional<Departure> departure_at_flip(const flow::ParameterFamily& family, const BoundaryPoint& flip, double size);

/// Whether the branch passes through this motion: solved for at its parameter between the neighbouring points, it has
/// the same extremes, peak force and multiplier (1e-6).
bool passes_through(const flow::ParameterFamily& family, const Branch& branch, const Point& motion, double size);

}  // namespace percuss::branch
