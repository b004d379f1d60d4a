#pragma once
/// \file
/// Nearly singular matrices by way of bordered ones, which are not (W. Govaerts, Numerical Methods for Bifurcations of
/// Dynamical Equilibria, SIAM 2000, chapter 3).
///
///     [ A    b ] [v]   [0]        [ A^H  c ] [w]   [0]
///     [ c^H  0 ] [g] = [1],       [ b^H  0 ] [h] = [1],   h = conj(g)
///
/// By Cramer's rule g = det A / det of the bordered matrix: zero where A is singular, and there only. v and w are then
/// null vectors of A, right and left; in any direction and anywhere  g' = -w^H A' v.

#include "numerics/linear.hpp"

namespace percuss::numerics {

template <class Scalar>
struct NullVectors {
    Eigen::Matrix<Scalar, Eigen::Dynamic, 1> right;  ///< A right = sigma left, sigma the smallest singular value
    Eigen::Matrix<Scalar, Eigen::Dynamic, 1> left;
};

/// Singular vectors of the smallest singular value of a square matrix, each of length 1.
template <class Scalar>
NullVectors<Scalar> nearest_null_vectors(const Eigen::Matrix<Scalar, Eigen::Dynamic, Eigen::Dynamic>& a);

template <class Scalar>
struct BorderedSolution {
    Scalar g{};
    Eigen::Matrix<Scalar, Eigen::Dynamic, 1> v;
    Eigen::Matrix<Scalar, Eigen::Dynamic, 1> w;
};

/// The two systems above with borders b = left, c = right. Not finite where they do not make the matrix regular, as
/// when A has lost two ranks.
template <class Scalar>
BorderedSolution<Scalar> solve_bordered(const Eigen::Matrix<Scalar, Eigen::Dynamic, Eigen::Dynamic>& a,
                                        const NullVectors<Scalar>& borders);

/// With the nearest null vectors of A itself as borders: the bordered matrix is then as well conditioned as A without
/// its smallest singular value, and g = -sigma.
template <class Scalar>
BorderedSolution<Scalar> solve_bordered(const Eigen::Matrix<Scalar, Eigen::Dynamic, Eigen::Dynamic>& a);

/// The square matrix with A (n x (n + 1)) above and one more row below: the Jacobian of a curve and a plane across it.
Matrix bordered_below(const Matrix& a, const Vector& row);

}  // namespace percuss::numerics
