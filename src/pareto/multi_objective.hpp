#pragma once
/// \file
/// The problem that every tracer of fronts here solves:
///
///     minimise (f_1(x), ..., f_k(x))   subject to   c_i(x) <= 0 (i = 1..m),   l <= x <= u,
///
/// k = 2 or 3, x of n = 1..10 or so continuous variables; f and c piecewise smooth, expensive (a millisecond) and not
/// defined everywhere. The caller scales constraints to order one; variables and objectives are scaled here.

#include "numerics/linear.hpp"

namespace percuss::pareto {

using numerics::Matrix;
using numerics::Vector;

/// Values and, where asked for, first derivatives at one point.
struct VectorEvaluation {
    bool ok = false;     ///< false: nothing could be computed at this point, and nothing below may be used
    Vector objectives;   ///< f_k, k entries
    Matrix gradients;    ///< df_k/dx_j, k x n; empty when not asked for
    Vector constraints;  ///< c_i, m entries
    Matrix jacobian;     ///< dc_i/dx_j, m x n; empty when not asked for
};

class MultiObjective {
public:
    MultiObjective() = default;
    MultiObjective(const MultiObjective&) = delete;
    MultiObjective& operator=(const MultiObjective&) = delete;
    virtual ~MultiObjective() = default;

    [[nodiscard]] virtual int variables() const = 0;
    [[nodiscard]] virtual int objectives() const = 0;
    [[nodiscard]] virtual int constraints() const = 0;
    [[nodiscard]] virtual Vector lower() const = 0;  ///< n entries, finite, lower < upper
    [[nodiscard]] virtual Vector upper() const = 0;  ///< n entries, finite

    /// f and c at x (inside the bounds), with derivatives if `want_gradient`. The same x must give the same bits. A
    /// point that cannot be evaluated is `ok = false`. An exception ends the work and reaches the caller of the tracer.
    virtual VectorEvaluation evaluate(const Vector& x, bool want_gradient) = 0;
};

}  // namespace percuss::pareto
