#pragma once
/// \file
/// What a sweep shows: where the motion jumps, and whether both directions saw the same.

#include "verbs/sweep/sweep.hpp"

#include <span>

namespace percuss::verbs {

/// Neighbouring points of a step sweep whose period or contacts per cycle differ, or whose step in amplitude or peak
/// force is over four times as large as those beside it and over 1 % of the whole range. Pairs that have both not
/// settled are left out.
std::vector<SweepJump> find_jumps(std::span<const SweepPoint> points);

/// Where a chirp begins or ceases to strike: the ends of its stretches of at least 12 cycles without a contact.
std::vector<SweepJump> find_chirp_jumps(std::span<const SweepPoint> cycles);

/// Points of both directions at the same frequencies, whatever their order. `settling_tolerance`: of the sweep.
SweepComparison compare(std::span<const SweepPoint> forward, std::span<const SweepPoint> backward,
                        double settling_tolerance);

}  // namespace percuss::verbs
