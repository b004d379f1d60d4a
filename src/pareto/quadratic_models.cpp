#include "pareto/quadratic_models.hpp"

#include <algorithm>
#include <cmath>

namespace percuss::pareto {
namespace {

/// Curvature beyond this, over a box of size one and functions of order one, is a kink between the two points.
constexpr double largest_curvature = 1e4;
/// Steps below this show more of the gradients' noise (about 1e-10) than of their change.
constexpr double shortest_secant = 1e-7;

Vector stacked_values(const VectorEvaluation& e) {
    Vector v(e.objectives.size() + e.constraints.size());
    v << e.objectives, e.constraints;
    return v;
}

Matrix stacked_gradients(const VectorEvaluation& e) {
    Matrix g(e.gradients.rows() + e.jacobian.rows(), e.gradients.cols());
    g << e.gradients, e.jacobian;
    return g;
}

void update(Matrix& hessian, const Vector& step, const Vector& change) {
    const Vector error = change - hessian * step;
    const double along = error.dot(step);
    if (!(change.norm() <= largest_curvature * step.norm())) return;
    // The usual safeguard of the rank-one update against a vanishing denominator.
    if (std::abs(along) <= 1e-8 * error.norm() * step.norm()) return;
    if (!(error.squaredNorm() / std::abs(along) <= largest_curvature)) return;
    hessian += error * error.transpose() / along;
}

}  // namespace

QuadraticModels::QuadraticModels(int variables, int functions)
    : hessians_(static_cast<std::size_t>(functions), Matrix::Zero(variables, variables)) {}

void QuadraticModels::learn(const Vector& u, const VectorEvaluation& here, const Vector& from,
                            const VectorEvaluation& there) {
    const Vector step = u - from;
    if (!(step.norm() > shortest_secant)) return;
    const Matrix change = stacked_gradients(here) - stacked_gradients(there);
    for (std::size_t i = 0; i < hessians_.size(); ++i) {
        update(hessians_[i], step, change.row(static_cast<Eigen::Index>(i)).transpose());
    }
}

void QuadraticModels::move_to(const Vector& u, const VectorEvaluation& here) {
    if (has_base()) learn(u, here, base_, at_base_);
    base_ = u;
    at_base_ = here;
    value_ = stacked_values(here);
    gradient_ = stacked_gradients(here);
}

Vector QuadraticModels::values(const Vector& step) const {
    Vector v = value_ + gradient_ * step;
    for (std::size_t i = 0; i < hessians_.size(); ++i) {
        v[static_cast<Eigen::Index>(i)] += 0.5 * step.dot(hessians_[i] * step);
    }
    return v;
}

Matrix QuadraticModels::gradients(const Vector& step) const {
    Matrix g = gradient_;
    for (std::size_t i = 0; i < hessians_.size(); ++i) {
        g.row(static_cast<Eigen::Index>(i)) += (hessians_[i] * step).transpose();
    }
    return g;
}

Matrix QuadraticModels::hessian(const Vector& multipliers) const {
    Matrix sum = Matrix::Zero(base_.size(), base_.size());
    for (std::size_t i = 0; i < hessians_.size(); ++i) sum += multipliers[static_cast<Eigen::Index>(i)] * hessians_[i];
    return sum;
}

void learn_from_archive(QuadraticModels& models, const UnitProblem& problem, const Vector& u, double radius, int most) {
    struct Near {
        double distance;
        const UnitProblem::Visited* visited;
    };
    std::vector<Near> near;
    for (const UnitProblem::Visited& visited : problem.archive()) {
        const double distance = (visited.u - u).lpNorm<Eigen::Infinity>();
        if (visited.raw.ok && visited.raw.gradients.size() > 0 && distance <= radius)
            near.push_back({distance, &visited});
    }
    std::stable_sort(near.begin(), near.end(), [](const Near& a, const Near& b) { return a.distance < b.distance; });
    if (near.size() > static_cast<std::size_t>(most)) near.resize(static_cast<std::size_t>(most));
    for (std::size_t k = near.size(); k-- > 1;) {
        models.learn(near[k - 1].visited->u, problem.scaled(near[k - 1].visited->raw), near[k].visited->u,
                     problem.scaled(near[k].visited->raw));
    }
}

}  // namespace percuss::pareto
