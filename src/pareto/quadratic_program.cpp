#include "pareto/quadratic_program.hpp"

#include "optimise/nnls.hpp"

#include <cmath>
#include <vector>

namespace percuss::pareto {
namespace {

/// The solution with the rows of the support as equations; nothing where they are dependent.
std::optional<QuadraticSolution> solve_on_support(const Matrix& b_matrix, const Vector& gradient,
                                                  const Matrix& a_matrix, const Vector& b_vector,
                                                  const std::vector<Eigen::Index>& support) {
    const Eigen::Index n = gradient.size();
    const auto rows = static_cast<Eigen::Index>(support.size());
    Matrix kkt = Matrix::Zero(n + rows, n + rows);
    Vector right(n + rows);
    kkt.topLeftCorner(n, n) = b_matrix;
    kkt.bottomLeftCorner(rows, n) = a_matrix(support, Eigen::all);
    kkt.topRightCorner(n, rows) = a_matrix(support, Eigen::all).transpose();
    right << -gradient, b_vector(support);
    const Eigen::FullPivLU<Matrix> lu(kkt);
    if (!lu.isInvertible()) return std::nullopt;
    const Vector solution = lu.solve(right);
    QuadraticSolution result{solution.head(n), Vector::Zero(a_matrix.rows())};
    for (Eigen::Index k = 0; k < rows; ++k) result.multipliers[support[static_cast<std::size_t>(k)]] = solution[n + k];
    return result;
}

}  // namespace

std::optional<QuadraticSolution> solve_quadratic_program(const Matrix& b_matrix, const Vector& gradient,
                                                         const Matrix& a_matrix, const Vector& b_vector) {
    const Eigen::Index n = gradient.size();
    const Eigen::Index m = a_matrix.rows();
    const Eigen::LLT<Matrix> cholesky(b_matrix);
    if (cholesky.info() != Eigen::Success) return std::nullopt;

    // Least distance: min |y| subject to G y >= h.
    const Vector shift = cholesky.matrixL().solve(gradient);  // L^-1 g
    const Matrix g_matrix = -cholesky.matrixL().solve(a_matrix.transpose()).transpose();
    const Vector h = -b_vector + g_matrix * shift;
    Matrix e(n + 1, m);
    e.topRows(n) = g_matrix.transpose();
    e.row(n) = h.transpose();
    const optimise::NonNegativeLeastSquares dual = optimise::solve_nnls(e, Vector::Unit(n + 1, n));
    const Vector residual = e * dual.x - Vector::Unit(n + 1, n);
    // The last entry is -|r|^2 of the least-squares residual: 0 means that the rows contradict each other.
    const double distance = -residual[n];
    if (!dual.converged || !(distance > 1e-13)) return std::nullopt;

    const Vector y = residual.head(n) / distance;
    QuadraticSolution rough;
    rough.x = cholesky.matrixU().solve(y - shift);
    rough.multipliers = dual.x / distance;

    std::vector<Eigen::Index> support;
    for (Eigen::Index i = 0; i < m; ++i) {
        if (dual.x[i] > 0) support.push_back(i);
    }
    const auto exact = solve_on_support(b_matrix, gradient, a_matrix, b_vector, support);
    if (!exact) return rough;
    // Taken unless it contradicts the working set from which it was computed.
    const double scale = 1.0 + rough.x.norm();
    const bool feasible = m == 0 || (a_matrix * exact->x - b_vector).maxCoeff() <= 1e-9 * scale;
    const bool signs =
        m == 0 || exact->multipliers.minCoeff() >= -1e-9 * (1.0 + exact->multipliers.cwiseAbs().maxCoeff());
    return feasible && signs ? *exact : rough;
}

Matrix made_positive(const Matrix& symmetric, double floor) {
    const Eigen::SelfAdjointEigenSolver<Matrix> eigen(0.5 * (symmetric + symmetric.transpose()));
    const Vector lifted = eigen.eigenvalues().cwiseAbs().cwiseMax(floor);
    return eigen.eigenvectors() * lifted.asDiagonal() * eigen.eigenvectors().transpose();
}

}  // namespace percuss::pareto
