#pragma once
/// \file
/// What a front is made of: certified points.

#include "optimise/certificate.hpp"
#include "pareto/unit_problem.hpp"

#include <cstdint>
#include <limits>
#include <optional>
#include <vector>

namespace percuss::pareto {

/// The first-order conditions of Pareto optimality (Miettinen, Nonlinear Multiobjective Optimization, 1999, theorem
/// 3.1.5) at one point, in u and y (unit_problem.hpp):
///
///     sum_k w_k grad y_k + J^T mu + b = 0,   w >= 0,  sum w = 1,  mu >= 0,  mu_i c_i = 0,  c <= 0,  0 <= u <= 1
///
/// with b_j as in optimise::Certificate. With two objectives -w_1/w_2 is the slope dy_2/dy_1 of the front.
struct FrontCertificate {
    double residual = std::numeric_limits<double>::infinity();  ///< infinity norm of the left side
    Vector weights;                                             ///< w, k entries
    Vector multipliers;                                         ///< mu, m entries
    Vector bound_multipliers;                                   ///< b, n entries
    double infeasibility = std::numeric_limits<double>::infinity();
    double complementarity =
        std::numeric_limits<double>::infinity();  ///< max mu_i |c_i|, |b_j| (distance to the bound)

    /// Residual and complementarity at most `tolerance`, infeasibility at most `feasibility_tolerance`; false for NaN.
    [[nodiscard]] bool certified(double tolerance, double feasibility_tolerance) const {
        return residual <= tolerance && complementarity <= tolerance && infeasibility <= feasibility_tolerance;
    }
};

/// The multipliers that make the residual smallest, by non-negative least squares over the objectives and the limits
/// and bounds within 1e-6 of being active. `evaluation`: scaled, with gradients; without them nothing is certified.
/// First order only: a point that other points of the neighbourhood beat to second order is not told apart.
[[nodiscard]] FrontCertificate certify_front(const VectorEvaluation& evaluation, const Vector& u);

/// How a point came to be known.
enum class Origin : std::uint8_t {
    anchor,    ///< optimum of one objective alone, best of several starts
    traced,    ///< predicted and corrected from its neighbour
    bisected,  ///< from both ends of a gap
    change,    ///< where a limit or bound begins or ceases to bind
    searched,  ///< by a global search of an epsilon-constraint problem
};
[[nodiscard]] const char* to_string(Origin origin);

/// A point of a front, in the units of the caller.
struct FrontPoint {
    Vector x;
    Vector objectives;
    Vector constraints;
    /// w >= 0 with sum w = 1, mu and b of sum w_k grad f_k + J^T mu + b = 0 in the caller's units: with two objectives
    /// the slope df_2/df_1 of the front is -w_1/w_2, and relaxing limit i alone by e improves f_k by e mu_i/w_k, the
    /// other objectives held.
    Vector weights, multipliers, bound_multipliers;
    double kkt_residual = std::numeric_limits<double>::infinity();  ///< in scaled units (FrontCertificate)
    double infeasibility = std::numeric_limits<double>::infinity();
    bool certified = false;
    std::vector<int> active_limits;  ///< i with mu_i > 0 or |c_i| <= 1e-6
    std::vector<int> active_bounds;  ///< j with x_j on one of its bounds
    Origin origin = Origin::searched;
    int evaluations = 0;  ///< spent on this point, failed attempts included
    int case_index = 0;   ///< which of several merged fronts it belongs to
};

/// df_2/df_1; -infinity where the weight of f_2 is 0. Two objectives only.
[[nodiscard]] double slope(const FrontPoint& point);

/// `u` must have been evaluated.
[[nodiscard]] FrontPoint front_point(const UnitProblem& problem, const Vector& u, const FrontCertificate& certificate,
                                     Origin origin, int evaluations);

/// The points of several fronts that no other dominates, case_index set to the place of their front; of equal points
/// the one of the first front is kept. Sorted by objectives, the first one first. Throws as non_dominated.
[[nodiscard]] std::vector<FrontPoint> merge_fronts(const std::vector<std::vector<FrontPoint>>& fronts);

}  // namespace percuss::pareto
