#include "pareto/epsilon_constraint.hpp"

#include <cmath>
#include <stdexcept>
#include <string>

namespace percuss::pareto {

EpsilonNlp::EpsilonNlp(UnitProblem& problem, int objective, const Vector& limits)
    : problem_(problem),
      objective_(objective),
      limits_(limits) {
    if (objective < 0 || objective >= problem.objectives()) {
        throw std::invalid_argument("objective = " + std::to_string(objective) + ", must be in 0.." +
                                    std::to_string(problem.objectives() - 1));
    }
    if (limits.size() != problem.objectives() || limits.hasNaN()) {
        throw std::invalid_argument("limits: " + std::to_string(limits.size()) + " numbers, must be " +
                                    std::to_string(problem.objectives()) + ", none of them NaN");
    }
    for (int k = 0; k < problem.objectives(); ++k) {
        if (k != objective && std::isfinite(limits[k])) limited_.push_back(k);
    }
}

int EpsilonNlp::constraints() const { return problem_.constraints() + static_cast<int>(limited_.size()); }

optimise::Evaluation EpsilonNlp::evaluate(const Vector& u, bool want_gradient) {
    const VectorEvaluation here = problem_.evaluate(u, want_gradient);
    optimise::Evaluation e;
    e.ok = here.ok;
    if (!e.ok) return e;
    const Eigen::Index m = problem_.constraints();
    e.objective = here.objectives[objective_];
    e.constraints.resize(constraints());
    e.constraints.head(m) = here.constraints;
    for (std::size_t i = 0; i < limited_.size(); ++i) {
        const int k = limited_[i];
        e.constraints[m + static_cast<Eigen::Index>(i)] = here.objectives[k] - limits_[k];
    }
    if (!want_gradient) return e;
    e.gradient = here.gradients.row(objective_).transpose();
    e.jacobian.resize(constraints(), variables());
    e.jacobian.topRows(m) = here.jacobian;
    for (std::size_t i = 0; i < limited_.size(); ++i) {
        e.jacobian.row(m + static_cast<Eigen::Index>(i)) = here.gradients.row(limited_[i]);
    }
    return e;
}

optimise::MultiStartResult search(UnitProblem& problem, int objective, const Vector& limits,
                                  const std::vector<Vector>& warm_starts, const SearchOptions& options) {
    EpsilonNlp nlp(problem, objective, limits);
    optimise::MultiStartOptions multi;
    multi.solver.method = options.method;
    multi.solver.max_evaluations = options.max_evaluations;
    multi.solver.feasibility_tolerance = options.feasibility_tolerance;
    multi.solver.seed = options.seed;
    multi.candidates = options.candidates;
    multi.starts = options.starts;
    multi.warm_starts = warm_starts;
    return optimise::multi_start(nlp, multi);
}

}  // namespace percuss::pareto
