#pragma once
/// \file
/// Is a point a constrained optimum? The first-order answer, with numbers.

#include "optimise/nlp.hpp"

#include <limits>

namespace percuss::optimise {

/// The Karush-Kuhn-Tucker conditions (Nocedal and Wright, Numerical Optimization, 2006, theorem 12.1) at one point:
///
///     g + J^T lambda + b = 0,   lambda >= 0,   lambda_i c_i = 0,   c <= 0,   l <= x <= u
///
/// with b_j >= 0 only where x_j = u_j and b_j <= 0 only where x_j = l_j.
struct Certificate {
    /// ||g + J^T lambda + b||_inf / max(1, ||g||_inf); infinity when nothing could be certified
    double residual = std::numeric_limits<double>::infinity();
    Vector multipliers;        ///< lambda, m entries, 0 for inactive constraints: -df*/d(limit of c_i)
    Vector bound_multipliers;  ///< b, n entries: > 0 presses on the upper bound, < 0 on the lower bound
    /// max(0, max_i c_i, max_j distance of x_j outside its bounds)
    double infeasibility = std::numeric_limits<double>::infinity();
    /// max_i lambda_i |c_i| and |b_j| (distance of x_j to its bound)
    double complementarity = std::numeric_limits<double>::infinity();

    /// All three numbers at most `tolerance`; false for NaN.
    [[nodiscard]] bool certified(double tolerance) const {
        return residual <= tolerance && infeasibility <= tolerance && complementarity <= tolerance;
    }
};

struct CertificateOptions {
    double activity =
        1e-6;  ///< a constraint with c_i >= -activity, a bound nearer than activity, may have a multiplier
};

/// The multipliers that make the residual smallest in the 2-norm, by non-negative least squares over the active
/// constraints and bounds. Where active gradients are dependent, multipliers are one choice of many. Nothing about
/// second order: a saddle point or maximum along the constraints is not told from a minimum.
///
/// `evaluation` must have gradients: with ok = false, or without them, the default (uncertified) Certificate is
/// returned with zero multipliers. Throws std::invalid_argument when sizes disagree or activity is not positive.
[[nodiscard]] Certificate certify(const Evaluation& evaluation, const Vector& x, const Vector& lower,
                                  const Vector& upper, const CertificateOptions& options = {});

}  // namespace percuss::optimise
