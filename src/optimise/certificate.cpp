#include "optimise/certificate.hpp"

#include "optimise/nnls.hpp"

#include <cmath>
#include <sstream>
#include <stdexcept>
#include <vector>

namespace percuss::optimise {
namespace {

/// One unknown of the least-squares problem: a multiplier of a constraint, or of a bound (sign +1 upper, -1 lower).
struct Candidate {
    enum class Kind { constraint, bound } kind;
    Eigen::Index index;
    double sign;
};

void check(const Evaluation& evaluation, const Vector& x, const Vector& lower, const Vector& upper, double activity) {
    if (!(activity > 0)) {
        std::ostringstream message;
        message << "activity = " << activity << ", must be > 0";
        throw std::invalid_argument(message.str());
    }
    const Eigen::Index n = x.size();
    const Eigen::Index entries = evaluation.gradient.size();
    const bool usable = !evaluation.ok || entries == 0 || entries == n;
    if (lower.size() == n && upper.size() == n && usable) return;
    std::ostringstream message;
    message << "certify: x has " << n << " entries, the bounds " << lower.size() << " and " << upper.size()
            << ", the gradient " << entries << "; must be the same";
    throw std::invalid_argument(message.str());
}

/// What may have a multiplier: solvers end a little inside their constraints, hence all within `activity`. A narrow
/// variable may be at both of its bounds.
std::vector<Candidate> active_set(const Evaluation& evaluation, const Vector& x, const Vector& lower,
                                  const Vector& upper, double activity) {
    std::vector<Candidate> active;
    for (Eigen::Index i = 0; i < evaluation.constraints.size(); ++i) {
        if (evaluation.constraints[i] >= -activity) active.push_back({Candidate::Kind::constraint, i, 1.0});
    }
    for (Eigen::Index j = 0; j < x.size(); ++j) {
        if (upper[j] - x[j] <= activity) active.push_back({Candidate::Kind::bound, j, 1.0});
        if (x[j] - lower[j] <= activity) active.push_back({Candidate::Kind::bound, j, -1.0});
    }
    return active;
}

/// Columns: the gradient of each active constraint, and +-e_j for each active bound.
Matrix active_gradients(const std::vector<Candidate>& active, const Evaluation& evaluation) {
    Matrix columns = Matrix::Zero(evaluation.gradient.size(), static_cast<Eigen::Index>(active.size()));
    for (std::size_t k = 0; k < active.size(); ++k) {
        const auto column = static_cast<Eigen::Index>(k);
        if (active[k].kind == Candidate::Kind::constraint) {
            columns.col(column) = evaluation.jacobian.row(active[k].index).transpose();
        } else {
            columns(active[k].index, column) = active[k].sign;
        }
    }
    return columns;
}

}  // namespace

Certificate certify(const Evaluation& evaluation, const Vector& x, const Vector& lower, const Vector& upper,
                    const CertificateOptions& options) {
    check(evaluation, x, lower, upper, options.activity);
    Certificate certificate;
    certificate.multipliers = Vector::Zero(evaluation.constraints.size());
    certificate.bound_multipliers = Vector::Zero(x.size());
    if (!evaluation.ok || evaluation.gradient.size() == 0) return certificate;

    const Vector& g = evaluation.gradient;
    const Vector& c = evaluation.constraints;
    const std::vector<Candidate> active = active_set(evaluation, x, lower, upper, options.activity);
    const Matrix columns = active_gradients(active, evaluation);
    // g + J^T lambda + b = 0 in the least-squares sense, with the sign of a bound in its column so that every unknown
    // is non-negative.
    const Vector multipliers = solve_nnls(columns, -g).x;

    certificate.residual =
        (g + columns * multipliers).lpNorm<Eigen::Infinity>() / std::max(1.0, g.lpNorm<Eigen::Infinity>());
    certificate.complementarity = 0.0;
    for (std::size_t k = 0; k < active.size(); ++k) {
        const auto& [kind, index, sign] = active[k];
        const double multiplier = multipliers[static_cast<Eigen::Index>(k)];
        double distance = 0.0;
        if (kind == Candidate::Kind::constraint) {
            certificate.multipliers[index] = multiplier;
            // Not exactly zero for an active constraint: the product tells how much that matters.
            distance = c[index];
        } else if (multiplier > 0) {
            certificate.bound_multipliers[index] += sign * multiplier;
            distance = (sign > 0 ? upper[index] : lower[index]) - x[index];
        }
        certificate.complementarity = std::max(certificate.complementarity, multiplier * std::abs(distance));
    }
    const double outside = std::max((x - upper).maxCoeff(), (lower - x).maxCoeff());
    certificate.infeasibility = std::max(infeasibility_of(c), outside);
    return certificate;
}

}  // namespace percuss::optimise
