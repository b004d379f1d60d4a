#pragma once
/// \file
/// How much a front covers, and how much a front known at some points only may cover. All objectives are minimised.

#include "numerics/linear.hpp"

#include <vector>

namespace percuss::pareto {

using numerics::Vector;

/// Volume of the union of the boxes [p, reference] over all points p, k = 2 or 3 objectives. Points that are not below
/// the reference in every objective add nothing; dominated points and duplicates change nothing.
///
/// Two objectives: one sort. Three: the sweep of Beume, Fonseca, Lopez-Ibanez, Paquete and Vahrenhold (IEEE Trans.
/// Evol. Comp. 13, 2009) with the staircase in a balanced tree. Both O(n log n). Throws std::invalid_argument for a
/// number of objectives other than 2 or 3, different numbers, or a NaN; and for a reference that is not finite.
[[nodiscard]] double hypervolume(const std::vector<Vector>& points, const Vector& reference);

/// Two objectives: the area that is lost when point i alone is left out, in the order of the points; 0 for dominated
/// points, for duplicates, and outside the reference. O(n log n). Throws as hypervolume.
[[nodiscard]] std::vector<double> exclusive_contributions(const std::vector<Vector>& points, const Vector& reference);

struct HypervolumeBounds {
    double lower = 0.0;
    double upper = 0.0;
};

/// Bounds for the hypervolume of any front that the points, all of them truly optimal, belong to: at least what they
/// dominate themselves; at most the box [ideal, reference] without the boxes [ideal, p], as whatever lies in such a box
/// would dominate p. With two objectives the difference is the sum of the rectangles between neighbours (and between
/// the outermost points and the ideal). k = 2 or 3, O(n log n). Points are clipped to the box. Throws as hypervolume,
/// and unless ideal <= reference.
[[nodiscard]] HypervolumeBounds unknown_front_bounds(const std::vector<Vector>& points, const Vector& ideal,
                                                     const Vector& reference);

/// The same for a front of two objectives that is convex (y_2 a convex function of y_1) between its outermost points:
/// the front lies below the chords and above the tangents, w . (y - p) >= 0 with the weights w >= 0 of each point.
/// Weights: one vector of two a point. Dominated points must have been taken out. Throws as hypervolume, and for other
/// weights.
[[nodiscard]] HypervolumeBounds convex_front_bounds(const std::vector<Vector>& points,
                                                    const std::vector<Vector>& weights, const Vector& reference);

/// IGD+ of Ishibuchi, Masuda, Tanigaki and Nojima (EMO 2015): the mean over a reference set Z of
/// min_p ||max(p - z, 0)||_2; 0 when every z is reached or beaten. Infinity without points. O(|Z| n). Throws
/// std::invalid_argument as hypervolume, and for an empty reference set.
[[nodiscard]] double igd_plus(const std::vector<Vector>& points, const std::vector<Vector>& reference_set);

}  // namespace percuss::pareto
