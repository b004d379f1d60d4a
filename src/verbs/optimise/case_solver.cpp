#include "verbs/optimise/case_solver.hpp"

#include "verbs/evaluate/evaluate.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

namespace percuss::verbs {
namespace {

using design::Quantity;
using optimise::Vector;

/// The claimed optimum is evaluated once more with the integrator this much tighter.
constexpr double verification_factor = 1e-2;

/// The search runs at tier 1; its result is then looked at by starts.
design::Problem at_tier_one(design::Problem problem) {
    problem.single_stable = std::min(problem.single_stable, design::SingleStable::orbit);
    return problem;
}

/// Why a search ended without a design that could be certified.
OptimiseStatus status_without_optimum(const optimise::MultiStartResult& solved, OptimiseStatus otherwise) {
    return solved.best.status == optimise::Outcome::Status::budget ? OptimiseStatus::budget : otherwise;
}

}  // namespace

design::Problem tightened(design::Problem problem) {
    // No integrator takes less than 1e-16.
    problem.solver.tolerance = std::max(1e-16, verification_factor * problem.solver.tolerance);
    return problem;
}

CaseSolver::CaseSolver(const StudyProblem& problem, RowSink* rows, numerics::CancelRequest cancelled)
    : problem_(problem),
      design_(design_problem(problem)),
      evaluator_(at_tier_one(design_)),
      tight_evaluator_(tightened(at_tier_one(design_))),
      rows_(rows),
      cancelled_(std::move(cancelled)) {}

IntegerCase CaseSolver::solve(const model::Specification& fixed, const std::vector<Vector>& warm_starts,
                              const std::vector<Exclusion>& exclusions) {
    IntegerCase c;
    c.fixed = fixed;
    c.exclusions = exclusions;
    c.report.layers = first_integer_value(design_, fixed);
    if (scale_ == 0.0) { scale_ = objective_scale(fixed); }
    DesignNlp nlp(evaluator_, fixed, scale_, rows_, exclusions, cancelled_);
    if (nlp.variables() == 0) {
        solve_fixed(c, nlp);
    } else {
        solve_continuous(c, nlp, warm_starts);
    }
    for (const auto& [status, count] : nlp.statuses()) { c.evaluations += count; }
    return c;
}

/// Order of magnitude of the objective, from the first designs of the box that can be evaluated.
double CaseSolver::objective_scale(const model::Specification& fixed) const {
    const DesignNlp probe(evaluator_, fixed, 1.0, nullptr);
    const Quantity q = design_.objectives.front().quantity;
    design::Demand demand;
    demand.quantities = {q};
    demand.cancelled = cancelled_;
    const int n = probe.variables();
    for (double t : {0.5, 0.3, 0.7, 0.15, 0.85}) {  // along the diagonal, from the middle outwards
        const design::Evaluation e = evaluator_.evaluate(probe.specification(Vector::Constant(n, t)), demand);
        const double value = std::abs(e.value(q));
        if (e.status == design::EvaluationStatus::ok && value > 0.0) { return value; }
    }
    return 1.0;
}

/// Nothing to move: the design is evaluated and checked against its limits.
void CaseSolver::solve_fixed(IntegerCase& c, DesignNlp& nlp) {
    c.x = Vector(0);
    const optimise::Evaluation e = nlp.evaluate(c.x, false);
    if (!e.ok) {
        c.report.status = OptimiseStatus::infeasible;
        c.report.reason = describe_failures(nlp);
        return;
    }
    c.solved.best.constraints = e.constraints;
    // A design on a bound to within rounding meets it.
    if (optimise::infeasibility_of(e.constraints) > activity) {
        c.report.status = OptimiseStatus::infeasible;
        c.report.reason = describe_infeasible(design_, c.solved);
        return;
    }
    verify(c, nlp);
    c.certificate.residual = 0.0;
    c.certificate.infeasibility = optimise::infeasibility_of(e.constraints);
    c.certificate.complementarity = 0.0;
    c.certificate.multipliers = Vector::Zero(nlp.constraints());
    settle(c, nlp);
}

optimise::MultiStartOptions CaseSolver::options_for(const IntegerCase& c,
                                                    const std::vector<Vector>& warm_starts) const {
    optimise::MultiStartOptions options;
    options.solver.method = problem_.optimiser.method;
    options.solver.max_evaluations = problem_.optimiser.max_evaluations;
    // The solver stops well inside the certificate's tolerance, which is asked for at a tighter integration.
    options.solver.tolerance = std::min(1e-8, 0.01 * problem_.optimiser.tolerance);
    options.solver.seed = problem_.seed;
    options.solver.cancelled = cancelled_;
    options.candidates = problem_.optimiser.samples;
    options.starts = problem_.optimiser.starts;
    if (!c.exclusions.empty()) {
        // Half of these problems have no solution, and each evaluation follows a window to its design.
        // The refuted optimum, given as a warm start, is taken to be close to the solution where there is one.
        options.candidates = std::min(options.candidates, 16);
        options.starts = 1;
        options.solver.max_evaluations = std::min(options.solver.max_evaluations, 400);
    }
    options.certificate_tolerance = problem_.optimiser.tolerance;
    options.warm_starts = warm_starts;
    return options;
}

void CaseSolver::solve_continuous(IntegerCase& c, DesignNlp& nlp, const std::vector<Vector>& warm_starts) {
    c.solved = optimise::multi_start(nlp, options_for(c, warm_starts));
    const optimise::Outcome& best = c.solved.best;
    c.x = best.x;
    const bool nothing_evaluated = best.constraints.size() == 0 && !std::isfinite(best.objective);
    if (nothing_evaluated || !best.feasible) {
        c.report.status = status_without_optimum(c.solved, OptimiseStatus::infeasible);
        c.report.reason = nothing_evaluated ? describe_failures(nlp) : describe_infeasible(design_, c.solved);
        return;
    }
    verify(c, nlp);
    settle(c, nlp);
}

/// Cold evaluation with the tighter integrator, and the certificate of its values. Not cancelled: it is one evaluation,
/// and without it a search that was cut short would have nothing to show.
void CaseSolver::verify(IntegerCase& c, const DesignNlp& nlp) {
    design::Demand demand = nlp.demand(true);
    // The best design is reported in full, not only in what the search needed.
    demand.quantities = quantities_to_report(at_tier_one(design_));
    demand.error_estimates = true;
    c.verified = tight_evaluator_.evaluate(nlp.specification(c.x), demand);
    const optimise::Evaluation e = nlp.translate(*c.verified, c.x, true);
    optimise::CertificateOptions options;
    options.activity = activity;
    if (nlp.variables() > 0) { c.certificate = optimise::certify(e, c.x, nlp.lower(), nlp.upper(), options); }
}

void CaseSolver::settle(IntegerCase& c, const DesignNlp& nlp) const {
    const bool ok = c.verified->status == design::EvaluationStatus::ok;
    const bool optimal = ok && c.certificate.certified(problem_.optimiser.tolerance);
    c.report.status =
        optimal ? OptimiseStatus::optimal : status_without_optimum(c.solved, OptimiseStatus::not_certified);
    if (!optimal) {
        c.report.reason = ok ? "the KKT residual stays above the tolerance"
                             : "the best design fails the verification: " + c.verified->reason;
    }
    c.report.objective = c.verified->value(design_.objectives.front().quantity);
    c.report.kkt_residual = c.certificate.residual;
    const model::Specification spec = nlp.specification(c.x);
    for (const design::DesignVariable& v : design_.variables) {
        c.report.design.emplace_back(v.key, spec.value(v.key));
    }
}

}  // namespace percuss::verbs
