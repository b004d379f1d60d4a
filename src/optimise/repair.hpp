#pragma once
/// \file
/// From slightly infeasible to feasible.

#include "optimise/guard.hpp"

#include <optional>

namespace percuss::optimise {

struct RepairOptions {
    double reach = 1e-2;  ///< points with an infeasibility above this are left alone
    int iterations = 8;
};

/// Solvers report success at points that violate a constraint by their own tolerance. This walks to the feasible set by
/// Gauss-Newton steps of least norm: over the violated or active constraints V (c_i > -tolerance),
///
///     min ||d||_2   subject to   c_i(x) + grad c_i(x)^T d = -max(tolerance, 1e-14) / 2   (i in V),   l <= x + d <= u,
///
/// where variables that a step takes to a bound are held there and the step is computed again for the others.
/// Returns a point with every c_i <= feasibility_tolerance of the guard's limits, or nothing: start too far (`reach`),
/// no convergence, evaluation failed, or the guard halted. At most `iterations` + 1 evaluations with gradients.
[[nodiscard]] std::optional<Vector> repaired(Guard& guard, const Vector& start, const RepairOptions& options = {});

}  // namespace percuss::optimise
