#pragma once
/// \file
/// The one place where Eigen is included: vocabulary types for dense linear algebra.

#include <Eigen/Dense>

namespace percuss::numerics {

using Vector = Eigen::VectorXd;
using Matrix = Eigen::MatrixXd;
using Complex = std::complex<double>;
using ComplexVector = Eigen::VectorXcd;
using ComplexMatrix = Eigen::MatrixXcd;

/// Vectors and matrices of at most eight rows and columns, kept on the stack: orbit states, monodromy matrices,
/// directional derivatives.
using SmallVector = Eigen::Matrix<double, Eigen::Dynamic, 1, Eigen::ColMajor, 8, 1>;
using SmallMatrix = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::ColMajor, 8, 8>;
using SmallComplexVector = Eigen::Matrix<std::complex<double>, Eigen::Dynamic, 1, Eigen::ColMajor, 8, 1>;
using SmallComplexMatrix = Eigen::Matrix<std::complex<double>, Eigen::Dynamic, Eigen::Dynamic, Eigen::ColMajor, 8, 8>;

}  // namespace percuss::numerics
