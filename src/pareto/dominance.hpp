#pragma once
/// \file
/// Which points are not beaten by another, all objectives to be minimised.

#include "numerics/linear.hpp"

#include <cstddef>
#include <vector>

namespace percuss::pareto {

using numerics::Vector;

/// a dominates b: a_k <= b_k for all k, a_k < b_k for at least one. False where either has a NaN.
[[nodiscard]] bool dominates(const Vector& a, const Vector& b);

/// Indices, ascending, of the points that no other point dominates; of equal points only the first is kept. Points
/// that tie in some objectives and not in others follow from the definition: (0, 1) dominates (0, 2).
///
/// Two objectives: one sort. Three: a sweep over the third with the staircase of the first two in a balanced tree
/// (Kung, Luccio and Preparata, J. ACM 22, 1975). Both O(n log n). Infinite values are allowed. Throws
/// std::invalid_argument for points of another number of objectives than 2 or 3, of different numbers, or with a NaN.
[[nodiscard]] std::vector<std::size_t> non_dominated(const std::vector<Vector>& points);

/// Throws std::invalid_argument, naming the point, unless all have `objectives` entries, none of them NaN.
void check_points(const std::vector<Vector>& points, Eigen::Index objectives);

}  // namespace percuss::pareto
