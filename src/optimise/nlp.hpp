#pragma once
/// \file
/// The problem that every optimiser here solves:
///
///     minimise f(x)   subject to   c_i(x) <= 0 (i = 1..m),   l <= x <= u,
///
/// x of n = 1..10 or so continuous variables, f and c piecewise smooth, expensive (a millisecond) and not defined
/// everywhere. The caller scales everything to order one; all values are nondimensional.

#include "numerics/linear.hpp"

#include <algorithm>
#include <limits>

namespace percuss::optimise {

using numerics::Matrix;
using numerics::Vector;

/// Values and, where asked for, first derivatives at one point.
struct Evaluation {
    bool ok = false;  ///< false: nothing could be computed at this point, and nothing below may be used
    double objective = std::numeric_limits<double>::quiet_NaN();  ///< f
    Vector gradient;                                              ///< df/dx_j, n entries; empty when not asked for
    Vector constraints;                                           ///< c_i, m entries
    Matrix jacobian;                                              ///< dc_i/dx_j, m x n; empty when not asked for
};

/// max(0, max_i c_i): how far from feasible; 0 without constraints, NaN if any c_i is NaN.
[[nodiscard]] inline double infeasibility_of(const Vector& constraints) {
    if (constraints.hasNaN()) return std::numeric_limits<double>::quiet_NaN();
    return constraints.size() == 0 ? 0.0 : std::max(0.0, constraints.maxCoeff());
}

class Nlp {
public:
    Nlp() = default;
    Nlp(const Nlp&) = delete;
    Nlp& operator=(const Nlp&) = delete;
    virtual ~Nlp() = default;

    [[nodiscard]] virtual int variables() const = 0;
    [[nodiscard]] virtual int constraints() const = 0;
    [[nodiscard]] virtual Vector lower() const = 0;  ///< n entries, lower < upper; -infinity for none
    [[nodiscard]] virtual Vector upper() const = 0;  ///< n entries; +infinity for none

    /// f and c at x (inside the bounds), with gradient and Jacobian if `want_gradient`. The same x must give the
    /// same bits. A point that cannot be evaluated is `ok = false`. An exception ends the optimisation and reaches
    /// the caller of the optimiser with its text.
    virtual Evaluation evaluate(const Vector& x, bool want_gradient) = 0;
};

}  // namespace percuss::optimise
