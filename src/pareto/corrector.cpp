#include "pareto/corrector.hpp"

#include "pareto/quadratic_program.hpp"

#include <algorithm>
#include <cmath>

namespace percuss::pareto {
namespace {

/// Newton steps on the models cost no evaluation; they converge in 3 to 6, and what has not by 40 does not.
constexpr int model_iterations = 40;
constexpr double model_tolerance = 1e-11;
/// Of the curvature of the Lagrangian: smaller or negative curvature along the active limits is not that of a minimum.
constexpr double least_curvature = 1e-3;

struct Multipliers {
    Vector rows;    ///< of objectives and constraints
    Vector bounds;  ///< as FrontCertificate::bound_multipliers
};

struct ModelSolution {
    Vector step;  ///< from the models' base
    Multipliers multipliers;
};

/// The largest violation of the objectives' rows decides t.
double level_of(const Vector& values, const Target& target) {
    double t = -std::numeric_limits<double>::infinity();
    for (Eigen::Index k = 0; k < target.anchor.size(); ++k) {
        if (target.direction[k] > 0) t = std::max(t, (values[k] - target.anchor[k]) / target.direction[k]);
    }
    return t;
}

/// The target with the problem's functions replaced by their models.
class ModelProblem {
public:
    ModelProblem(const QuadraticModels& models, const Target& target, const CorrectorOptions& options)
        : models_(models),
          target_(target),
          n_(models.base().size()),
          // Half the tolerance inside, so that rounding does not put the point outside.
          margin_(0.5 * options.feasibility_tolerance),
          lowest_((-models.base()).cwiseMax(-options.radius)),
          highest_((Vector::Ones(n_) - models.base()).cwiseMin(options.radius)) {}

    std::optional<ModelSolution> solve(Multipliers multipliers) const;

private:
    struct Rows {
        Matrix gradients;  ///< functions x (n + 1), the last column for t
        Vector values;     ///< to be <= 0
    };
    [[nodiscard]] Rows rows_at(const Vector& step, double t) const;
    [[nodiscard]] Matrix convexified(const Matrix& active, const Multipliers& multipliers, double& penalty) const;

    const QuadraticModels& models_;
    const Target& target_;
    Eigen::Index n_;
    double margin_;
    Vector lowest_, highest_;
};

ModelProblem::Rows ModelProblem::rows_at(const Vector& step, double t) const {
    const Eigen::Index k = target_.anchor.size();
    const Eigen::Index functions = models_.functions();
    Rows rows{Matrix::Zero(functions, n_ + 1), models_.values(step)};
    rows.gradients.leftCols(n_) = models_.gradients(step);
    rows.gradients.topRightCorner(k, 1) = -target_.direction;
    rows.values.head(k) -= target_.anchor + t * target_.direction;
    rows.values.tail(functions - k).array() += margin_;
    return rows;
}

/// Hessian of the Lagrangian plus penalty times A^T A over the active rows, which changes nothing on them, with what is
/// still not positive lifted.
Matrix ModelProblem::convexified(const Matrix& active, const Multipliers& multipliers, double& penalty) const {
    Matrix hessian = Matrix::Zero(n_ + 1, n_ + 1);
    hessian.topLeftCorner(n_, n_) = models_.hessian(multipliers.rows);
    const double size = std::max(hessian.cwiseAbs().maxCoeff(), 1e-2);
    penalty = 10.0 * size;
    hessian += penalty * active.transpose() * active;
    return made_positive(hessian, least_curvature * size);
}

std::optional<ModelSolution> ModelProblem::solve(Multipliers multipliers) const {
    const Eigen::Index functions = models_.functions();
    Vector step = Vector::Zero(n_);
    double t = level_of(models_.values(step), target_);
    for (int iteration = 0; iteration < model_iterations; ++iteration) {
        const Rows rows = rows_at(step, t);
        Matrix active = Matrix::Zero(functions + n_, n_ + 1);
        Vector residual = Vector::Zero(functions + n_);
        for (Eigen::Index i = 0; i < functions; ++i) {
            if (!(multipliers.rows[i] > 0)) continue;
            active.row(i) = rows.gradients.row(i);
            residual[i] = rows.values[i];
        }
        for (Eigen::Index j = 0; j < n_; ++j) {
            if (multipliers.bounds[j] == 0) continue;
            active(functions + j, j) = 1.0;
            residual[functions + j] = step[j] - (multipliers.bounds[j] > 0 ? highest_[j] : lowest_[j]);
        }
        double penalty = 0.0;
        const Matrix hessian = convexified(active, multipliers, penalty);
        const Vector gradient = Vector::Unit(n_ + 1, n_) + penalty * active.transpose() * residual;

        Matrix a = Matrix::Zero(functions + 2 * n_, n_ + 1);
        Vector b(functions + 2 * n_);
        a.topRows(functions) = rows.gradients;
        a.block(functions, 0, n_, n_).setIdentity();
        a.block(functions + n_, 0, n_, n_) = -Matrix::Identity(n_, n_);
        b << -rows.values, highest_ - step, step - lowest_;
        const auto solution = solve_quadratic_program(hessian, gradient, a, b);
        if (!solution) return std::nullopt;

        step += solution->x.head(n_);
        t += solution->x[n_];
        multipliers.rows = solution->multipliers.head(functions).cwiseMax(0.0);
        multipliers.bounds = solution->multipliers.segment(functions, n_) - solution->multipliers.tail(n_);
        if (solution->x.lpNorm<Eigen::Infinity>() <= model_tolerance) return ModelSolution{step, multipliers};
    }
    return std::nullopt;
}

Multipliers first_estimate(const FrontCertificate& from, const Target& target) {
    Multipliers multipliers{Vector(from.weights.size() + from.multipliers.size()), from.bound_multipliers};
    multipliers.rows << from.weights, from.multipliers;
    const double scale = from.weights.dot(target.direction);
    if (scale > 0) {
        multipliers.rows /= scale;
        multipliers.bounds /= scale;
    }
    return multipliers;
}

}  // namespace

Correction correct(UnitProblem& problem, QuadraticModels& models, const Target& target, const FrontCertificate& from,
                   const CorrectorOptions& options, const Vector& guess) {
    Correction result;
    const int before = problem.evaluations();
    const auto spent = [&] { return problem.evaluations() - before; };
    Multipliers multipliers = first_estimate(from, target);
    CorrectorOptions current = options;
    int refused = 0;
    const auto take = [&](const Vector& u, const VectorEvaluation& here) {
        models.move_to(u, here);
        result.u = u;
        result.here = here;
        result.certificate = certify_front(here, u);
        result.converged = result.certificate.certified(options.tolerance, options.feasibility_tolerance);
    };

    if (guess.size() > 0) {
        const Vector u = guess.cwiseMax(0.0).cwiseMin(1.0);
        const VectorEvaluation here = problem.evaluate(u, true);
        if (here.ok) take(u, here);
    }
    if (result.converged) {
        result.evaluations = spent();
        return result;
    }
    // A point known from before costs no evaluation, hence the second limit.
    for (int attempt = 0; attempt < 2 * options.evaluations && spent() < options.evaluations; ++attempt) {
        const auto model = ModelProblem(models, target, current).solve(multipliers);
        if (!model) break;
        const Vector u = (models.base() + model->step).cwiseMax(0.0).cwiseMin(1.0);
        const VectorEvaluation here = problem.evaluate(u, true);
        if (!here.ok) {  // nothing can be evaluated there: try a quarter of the way
            if (++refused > 2) break;
            current.radius = 0.25 * std::min(current.radius, model->step.lpNorm<Eigen::Infinity>());
            continue;
        }
        take(u, here);
        multipliers = model->multipliers;
        // A step that the radius cut short may end on the front, but not where it was to go.
        const bool cut = model->step.lpNorm<Eigen::Infinity>() >= 0.999 * current.radius;
        if (result.converged && !cut) break;
    }
    result.evaluations = spent();
    return result;
}

}  // namespace percuss::pareto
