#include "pareto/front.hpp"

#include "pareto/dominance.hpp"

#include <algorithm>
#include <cmath>

namespace percuss::pareto {
namespace {

/// A limit or bound nearer than this is active; as optimise::CertificateOptions has it.
constexpr double activity = optimise::CertificateOptions{}.activity;

}  // namespace

const char* to_string(Origin origin) {
    switch (origin) {
        case Origin::anchor: return "anchor";
        case Origin::traced: return "traced";
        case Origin::bisected: return "bisected";
        case Origin::change: return "change";
        case Origin::searched: return "searched";
    }
    return "unknown";
}

/// The certificate of: minimise t subject to y_k(u) - y_k(here) <= t, at t = 0, where all k are active.
FrontCertificate certify_front(const VectorEvaluation& evaluation, const Vector& u) {
    FrontCertificate result;
    const Eigen::Index n = u.size();
    const Eigen::Index k = evaluation.objectives.size();
    const Eigen::Index m = evaluation.constraints.size();
    result.weights = Vector::Zero(k);
    result.multipliers = Vector::Zero(m);
    result.bound_multipliers = Vector::Zero(n);
    if (!evaluation.ok || evaluation.gradients.size() == 0) return result;

    optimise::Evaluation lifted;
    lifted.ok = true;
    lifted.objective = 0.0;
    lifted.gradient = Vector::Unit(n + 1, n);
    lifted.constraints.resize(k + m);
    lifted.constraints << Vector::Zero(k), evaluation.constraints;
    lifted.jacobian = Matrix::Zero(k + m, n + 1);
    lifted.jacobian.topLeftCorner(k, n) = evaluation.gradients;
    lifted.jacobian.topRightCorner(k, 1).setConstant(-1.0);
    lifted.jacobian.bottomLeftCorner(m, n) = evaluation.jacobian;
    const auto joined = [&](double x, double t) {
        Vector z(n + 1);
        z << Vector::Constant(n, x), t;
        return z;
    };
    Vector z(n + 1);
    z << u, 0.0;
    const optimise::Certificate c = optimise::certify(lifted, z, joined(0.0, -1.0), joined(1.0, 1.0), {activity});

    // Least squares shares a remaining residual out between the weights' sum and the rest: put it into the rest.
    const double sum = c.multipliers.head(k).sum();
    if (!(sum > 0)) return result;
    result.weights = c.multipliers.head(k) / sum;
    result.multipliers = c.multipliers.tail(m) / sum;
    result.bound_multipliers = c.bound_multipliers.head(n) / sum;
    result.residual = (evaluation.gradients.transpose() * result.weights +
                       evaluation.jacobian.transpose() * result.multipliers + result.bound_multipliers)
                          .lpNorm<Eigen::Infinity>();
    result.infeasibility = c.infeasibility;
    result.complementarity = c.complementarity / sum;
    return result;
}

double slope(const FrontPoint& point) { return -point.weights[0] / point.weights[1]; }

FrontPoint front_point(const UnitProblem& problem, const Vector& u, const FrontCertificate& certificate, Origin origin,
                       int evaluations) {
    const VectorEvaluation& here = problem.raw(u);
    FrontPoint point;
    point.x = problem.point(u);
    point.objectives = here.objectives;
    point.constraints = here.constraints;
    const Vector weights = certificate.weights.cwiseQuotient(problem.range());
    const double sum = weights.sum();
    point.weights = weights / sum;
    point.multipliers = certificate.multipliers / sum;
    point.bound_multipliers = certificate.bound_multipliers.cwiseQuotient(problem.width()) / sum;
    point.kkt_residual = certificate.residual;
    point.infeasibility = certificate.infeasibility;
    for (int i = 0; i < problem.constraints(); ++i) {
        if (point.multipliers[i] > 0 || std::abs(point.constraints[i]) <= activity) point.active_limits.push_back(i);
    }
    for (int j = 0; j < problem.variables(); ++j) {
        if (u[j] <= activity || u[j] >= 1.0 - activity) point.active_bounds.push_back(j);
    }
    point.origin = origin;
    point.evaluations = evaluations;
    return point;
}

std::vector<FrontPoint> merge_fronts(const std::vector<std::vector<FrontPoint>>& fronts) {
    std::vector<FrontPoint> all;
    std::vector<Vector> objectives;
    for (std::size_t f = 0; f < fronts.size(); ++f) {
        for (const FrontPoint& point : fronts[f]) {
            all.push_back(point);
            all.back().case_index = static_cast<int>(f);
            objectives.push_back(point.objectives);
        }
    }
    std::vector<FrontPoint> merged;
    for (const std::size_t i : non_dominated(objectives)) merged.push_back(all[i]);
    std::stable_sort(merged.begin(), merged.end(), [](const FrontPoint& a, const FrontPoint& b) {
        return std::lexicographical_compare(a.objectives.begin(), a.objectives.end(), b.objectives.begin(),
                                            b.objectives.end());
    });
    return merged;
}

}  // namespace percuss::pareto
