#include "numerics/bordered.hpp"

namespace percuss::numerics {

template <class Scalar>
NullVectors<Scalar> nearest_null_vectors(const Eigen::Matrix<Scalar, Eigen::Dynamic, Eigen::Dynamic>& a) {
    const Eigen::JacobiSVD<Eigen::Matrix<Scalar, Eigen::Dynamic, Eigen::Dynamic>> svd(a, Eigen::ComputeFullU |
                                                                                             Eigen::ComputeFullV);
    const auto last = a.cols() - 1;
    return {svd.matrixV().col(last), svd.matrixU().col(last)};
}

template <class Scalar>
BorderedSolution<Scalar> solve_bordered(const Eigen::Matrix<Scalar, Eigen::Dynamic, Eigen::Dynamic>& a,
                                        const NullVectors<Scalar>& borders) {
    using AnyVector = Eigen::Matrix<Scalar, Eigen::Dynamic, 1>;
    using AnyMatrix = Eigen::Matrix<Scalar, Eigen::Dynamic, Eigen::Dynamic>;
    const auto n = a.rows();
    AnyMatrix bordered = AnyMatrix::Zero(n + 1, n + 1);
    bordered.topLeftCorner(n, n) = a;
    bordered.topRightCorner(n, 1) = borders.left;
    bordered.bottomLeftCorner(1, n) = borders.right.adjoint();
    AnyVector unit = AnyVector::Zero(n + 1);
    unit[n] = 1.0;
    const AnyVector right = bordered.partialPivLu().solve(unit);
    const AnyVector left = bordered.adjoint().partialPivLu().solve(unit);
    return {right[n], right.head(n), left.head(n)};
}

template <class Scalar>
BorderedSolution<Scalar> solve_bordered(const Eigen::Matrix<Scalar, Eigen::Dynamic, Eigen::Dynamic>& a) {
    return solve_bordered(a, nearest_null_vectors(a));
}

Matrix bordered_below(const Matrix& a, const Vector& row) {
    Matrix m(row.size(), row.size());
    m.topRows(a.rows()) = a;
    m.bottomRows(1) = row.transpose();
    return m;
}

template NullVectors<double> nearest_null_vectors(const Matrix&);
template NullVectors<Complex> nearest_null_vectors(const ComplexMatrix&);
template BorderedSolution<double> solve_bordered(const Matrix&, const NullVectors<double>&);
template BorderedSolution<Complex> solve_bordered(const ComplexMatrix&, const NullVectors<Complex>&);
template BorderedSolution<double> solve_bordered(const Matrix&);
template BorderedSolution<Complex> solve_bordered(const ComplexMatrix&);

}  // namespace percuss::numerics
