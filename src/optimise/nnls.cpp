#include "optimise/nnls.hpp"

#include <limits>
#include <vector>

namespace percuss::optimise {
namespace {

using numerics::Matrix;
using numerics::Vector;

/// The unconstrained solution on the columns of the support, zero elsewhere.
Vector least_squares_on(const Matrix& a, const Vector& b, const std::vector<Eigen::Index>& support) {
    Vector x = Vector::Zero(a.cols());
    const Matrix columns = a(Eigen::all, support);
    const Vector part = columns.colPivHouseholderQr().solve(b);
    for (std::size_t k = 0; k < support.size(); ++k) x[support[k]] = part[static_cast<Eigen::Index>(k)];
    return x;
}

/// The column outside the support along which the residual falls fastest, or -1 if none beyond rounding.
Eigen::Index entering_column(const Matrix& a, const Vector& residual, const Vector& norms, const Vector& x,
                             double scale) {
    // Slopes of the size of rounding in the residual, which is at most as long as b, would let columns enter and leave
    // for ever.
    const double rounding = 100 * std::numeric_limits<double>::epsilon() * scale;
    Eigen::Index best = -1;
    double steepest = 0.0;
    for (Eigen::Index j = 0; j < a.cols(); ++j) {
        if (x[j] > 0 || !(norms[j] > 0)) continue;
        const double slope = a.col(j).dot(residual) / norms[j];
        if (slope > rounding && slope > steepest) {
            best = j;
            steepest = slope;
        }
    }
    return best;
}

/// How far x can go towards the target with no entry of the support below zero.
double step_to_bound(const Vector& x, const Vector& target, const std::vector<Eigen::Index>& support) {
    double step = 1.0;
    for (const Eigen::Index j : support) {
        if (target[j] <= 0) step = std::min(step, x[j] / (x[j] - target[j]));
    }
    return step;
}

}  // namespace

NonNegativeLeastSquares solve_nnls(const Matrix& a, const Vector& b) {
    NonNegativeLeastSquares result;
    result.x = Vector::Zero(a.cols());
    Vector& x = result.x;
    const Vector norms = a.colwise().norm().transpose();
    std::vector<Eigen::Index> support;

    // Finite in exact arithmetic, where every entry lowers the residual; the cap is for rounding.
    int changes_left = 3 * static_cast<int>(a.cols()) + 10;
    while (changes_left-- > 0) {
        const Eigen::Index entering = entering_column(a, b - a * x, norms, x, b.norm());
        if (entering < 0) {
            result.converged = true;
            break;
        }
        support.push_back(entering);
        Vector target = least_squares_on(a, b, support);
        if (target[entering] <= 0) {  // only rounding made it look useful (Lawson and Hanson, section 23.3)
            support.pop_back();
            result.converged = true;
            break;
        }
        // The inner loop of Lawson and Hanson: go towards the least-squares solution until the first entry reaches
        // zero, drop it from the support, solve again on the rest.
        while (!support.empty() && target(support).minCoeff() <= 0) {
            const double step = step_to_bound(x, target, support);
            x += step * (target - x);
            std::erase_if(support, [&](Eigen::Index j) {
                // The entry that limited the step is zero up to rounding.
                const bool leaves = target[j] <= 0 && x[j] <= 1e-14 * std::max(1.0, x.maxCoeff());
                if (leaves) x[j] = 0;
                return leaves;
            });
            target = support.empty() ? Vector(Vector::Zero(a.cols())) : least_squares_on(a, b, support);
        }
        x = target;
    }
    return result;
}

}  // namespace percuss::optimise
