#pragma once
/// \file
/// The front of three objectives.

#include "pareto/trace.hpp"

namespace percuss::pareto {

/// Points spread over the front of three objectives:
///
///  1. Anchors (anchors.hpp).
///  2. The search zone in which most is open (search_zones.hpp) is where the hypervolume is known least. On the ray
///     through its box the corrector (corrector.hpp) seeks a point of the front from the nearest one known; where that
///     fails, a global search of an epsilon-constraint problem with limits in the middle of the box.
///  3. What is found divides the zone; a zone in which nothing is found is closed.
///
/// Front::error_bound is that of unknown_front_bounds in the box ideal..nadir, which with three objectives falls as
/// slowly as one over the square root of the number of points. `gaps` and `changes` are empty; `points` are in rising
/// order of their objectives, the first one first. The nadir is that of the anchors (payoff table): the front may reach
/// beyond it, and what lies there is not sought. locate_changes has no meaning here. Throws as trace_front, for other
/// than three objectives.
[[nodiscard]] Front mesh_front(MultiObjective& problem, const FrontOptions& options);

}  // namespace percuss::pareto
