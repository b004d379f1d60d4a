#pragma once
/// \file
/// Least squares with unknowns that may not be negative.

#include "numerics/linear.hpp"

namespace percuss::optimise {

struct NonNegativeLeastSquares {
    numerics::Vector x;      ///< p entries, >= 0; those outside the support are exactly 0
    bool converged = false;  ///< false: 3 p + 10 changes of the support did not reach the optimality conditions
};

/// min ||A x - b||_2 subject to x >= 0, by the active-set method of Lawson and Hanson, Solving Least Squares Problems
/// (1974), algorithm NNLS, with column-pivoted QR for the inner problems. A: r x p, b: r entries; p may be 0. Any
/// solution is as good as any other where columns are dependent.
[[nodiscard]] NonNegativeLeastSquares solve_nnls(const numerics::Matrix& a, const numerics::Vector& b);

}  // namespace percuss::optimise
