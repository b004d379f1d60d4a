#pragma once
/// \file
/// A small strictly convex quadratic program.

#include "numerics/linear.hpp"

#include <optional>

namespace percuss::pareto {

using numerics::Matrix;
using numerics::Vector;

struct QuadraticSolution {
    Vector x;            ///< n entries
    Vector multipliers;  ///< of the rows of A, >= 0
};

/// min 1/2 x^T B x + g^T x   subject to   A x <= b,   B symmetric and positive definite.
///
/// With B = L L^T and y = L^T x + L^-1 g this is the least-distance problem min |y| subject to -A L^-T y >= -b - A B^-1
/// g, solved by non-negative least squares (Lawson and Hanson, Solving Least Squares Problems, 1974, algorithm LDP).
/// The rows with a multiplier are then solved for exactly as equations. Nothing is returned when the rows contradict
/// each other or B is not positive definite.
[[nodiscard]] std::optional<QuadraticSolution> solve_quadratic_program(const Matrix& b_matrix, const Vector& gradient,
                                                                       const Matrix& a_matrix, const Vector& b_vector);

/// The symmetric matrix of the same eigenvectors whose eigenvalues e are max(|e|, floor).
[[nodiscard]] Matrix made_positive(const Matrix& symmetric, double floor);

}  // namespace percuss::pareto
