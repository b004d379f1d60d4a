#include "study/optimise.hpp"

#include "design/integrators.hpp"
#include "optimise/multi_start.hpp"
#include "optimise/solve.hpp"
#include "study/evaluate.hpp"
#include "study/integer_case.hpp"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <optional>
#include <stdexcept>

namespace percuss::study {
namespace {

using design::Evaluator;
using design::Quantity;
using optimise::Vector;

/// The claimed optimum is evaluated once more with the integrator this much tighter.
constexpr double verification_factor = 1e-2;

void check(const StudyProblem& problem) {
    const design::Problem& d = problem.design;
    if (d.variables.empty()) { throw std::invalid_argument("design.variable: optimise needs at least one"); }
    if (d.objectives.size() != 1) {
        throw std::invalid_argument("design.maximise or design.minimise: optimise needs exactly one objective");
    }
    for (Quantity q : wanted_quantities(d)) {
        const design::QuantityInfo& info = design::quantity_info(q);
        if (!info.smooth) {
            throw std::invalid_argument(std::string(info.name) +
                                        ": has no gradient, so it can be neither objective nor limit");
        }
    }
}

class Optimisation {
public:
    Optimisation(const StudyProblem& problem, RowSink* rows, const Observer& observer, const StopRequest& stop)
        : problem_(problem),
          design_(design_problem(problem)),
          evaluator_(at_tier_one(design_)),
          tight_evaluator_(tightened(at_tier_one(design_))),
          rows_(rows),
          observer_(observer),
          stop_(stop) {}

    OptimiseStudyResult run() {
        const std::vector<model::Specification> fixed = enumerate_integers(design_);
        std::vector<IntegerCase> cases;
        for (std::size_t i = 0; i < fixed.size() && !stopped(); ++i) {
            report_progress(static_cast<double>(i) / static_cast<double>(fixed.size()), fixed[i]);
            cases.push_back(solve(fixed[i], cases));
        }
        if (design_.single_stable > design::SingleStable::orbit) { refute(cases); }
        return conclude(cases, fixed.size());
    }

private:
    /// The search runs at tier 1; its result is then looked at by starts.
    static design::Problem at_tier_one(design::Problem problem) {
        problem.single_stable = std::min(problem.single_stable, design::SingleStable::orbit);
        return problem;
    }
    static design::Problem tightened(design::Problem problem) {
        problem.solver.tolerance = std::max(1e-16, verification_factor * problem.solver.tolerance);
        return problem;
    }
    [[nodiscard]] bool stopped() const { return stop_ && stop_(); }
    void report_progress(double share, const model::Specification& spec) const {
        if (!observer_) { return; }
        const double value = first_integer_value(design_, spec);
        observer_(share, std::isnan(value) ? "optimising" : "integer case " + std::to_string(std::lround(value)));
    }

    /// Order of magnitude of the objective, from the first designs of the box that can be evaluated.
    double objective_scale(const model::Specification& fixed) const {
        DesignNlp probe(evaluator_, fixed, 1.0, nullptr);
        const Quantity q = design_.objectives.front().quantity;
        design::Demand demand;
        demand.quantities = {q};
        const int n = probe.variables();
        for (double t : {0.5, 0.3, 0.7, 0.15, 0.85}) {
            const design::Evaluation e = evaluator_.evaluate(probe.specification(Vector::Constant(n, t)), demand);
            const double value = std::abs(e.value(q));
            if (e.status == design::EvaluationStatus::ok && value > 0.0) { return value; }
        }
        return 1.0;
    }

    IntegerCase solve(const model::Specification& fixed, const std::vector<IntegerCase>& before) {
        return solve(
            fixed, before.empty() || !before.back().optimal ? std::vector<Vector>{} : std::vector{before.back().x}, {});
    }

    IntegerCase solve(const model::Specification& fixed, const std::vector<Vector>& warm_starts,
                      const std::vector<Exclusion>& exclusions) {
        IntegerCase c;
        c.fixed = fixed;
        c.exclusions = exclusions;
        c.report.layers = first_integer_value(design_, fixed);
        if (scale_ == 0.0) { scale_ = objective_scale(fixed); }
        DesignNlp nlp(evaluator_, fixed, scale_, rows_, exclusions);
        if (nlp.variables() == 0) {
            solve_fixed(c, nlp);
        } else {
            solve_continuous(c, nlp, warm_starts);
        }
        for (const auto& [status, count] : nlp.statuses()) { c.evaluations += count; }
        return c;
    }

    /// Nothing to move: the design is evaluated and checked against its limits.
    void solve_fixed(IntegerCase& c, DesignNlp& nlp) {
        c.x = Vector(0);
        const optimise::Evaluation e = nlp.evaluate(c.x, false);
        if (!e.ok) {
            c.report.status = "infeasible";
            c.report.reason = describe_failures(nlp);
            return;
        }
        c.solved.best.constraints = e.constraints;
        if (optimise::infeasibility_of(e.constraints) > activity) {
            c.report.status = "infeasible";
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

    void solve_continuous(IntegerCase& c, DesignNlp& nlp, const std::vector<Vector>& warm_starts) {
        optimise::MultiStartOptions options;
        options.solver.method = problem_.optimiser.method;
        options.solver.max_evaluations = problem_.optimiser.max_evaluations;
        options.solver.tolerance = std::min(1e-8, 0.01 * problem_.optimiser.tolerance);
        options.solver.seed = problem_.seed;
        options.solver.stop = stop_;
        options.candidates = problem_.optimiser.samples;
        options.starts = problem_.optimiser.starts;
        if (!c.exclusions.empty()) {
            // Half of these problems have no solution, and each evaluation follows a window to its design.
            options.candidates = std::min(options.candidates, 16);
            options.starts = 1;
            options.solver.max_evaluations = std::min(options.solver.max_evaluations, 400);
        }
        options.certificate_tolerance = problem_.optimiser.tolerance;
        options.warm_starts = warm_starts;
        c.solved = optimise::multi_start(nlp, options);
        c.x = c.solved.best.x;
        if (c.solved.best.constraints.size() == 0 && !std::isfinite(c.solved.best.objective)) {
            c.report.status = c.solved.best.status == optimise::Outcome::Status::budget ? "budget" : "infeasible";
            c.report.reason = describe_failures(nlp);
            return;
        }
        if (!c.solved.best.feasible) {
            c.report.status = c.solved.best.status == optimise::Outcome::Status::budget ? "budget" : "infeasible";
            c.report.reason = describe_infeasible(design_, c.solved);
            return;
        }
        verify(c, nlp);
        settle(c, nlp);
    }

    /// Cold evaluation with the tighter integrator, and the certificate of its values.
    void verify(IntegerCase& c, const DesignNlp& nlp) {
        design::Demand demand = nlp.demand(true);
        demand.quantities = quantities_to_report(at_tier_one(design_));
        demand.error_estimates = true;
        c.verified = tight_evaluator_.evaluate(nlp.specification(c.x), demand);
        const optimise::Evaluation e = nlp.translate(*c.verified, c.x, true);
        optimise::CertificateOptions options;
        options.activity = activity;
        if (nlp.variables() > 0) { c.certificate = optimise::certify(e, c.x, nlp.lower(), nlp.upper(), options); }
    }

    void settle(IntegerCase& c, const DesignNlp& nlp) {
        const double tolerance = problem_.optimiser.tolerance;
        const bool ok = c.verified->status == design::EvaluationStatus::ok;
        c.optimal = ok && c.certificate.certified(tolerance);
        c.report.status = c.optimal                                                 ? "optimal"
                        : c.solved.best.status == optimise::Outcome::Status::budget ? "budget"
                                                                                    : "not-certified";
        if (!c.optimal) {
            c.report.reason = ok ? "the KKT residual stays above the tolerance"
                                 : "the best design fails the verification: " + c.verified->reason;
        }
        c.report.objective = c.verified->value(design_.objectives.front().quantity);
        c.report.kkt_residual = c.certificate.residual;
        c.report.design = design_of(nlp.specification(c.x));
    }

    [[nodiscard]] std::vector<std::pair<model::Key, double>> design_of(const model::Specification& spec) const {
        std::vector<std::pair<model::Key, double>> values;
        for (const design::DesignVariable& v : design_.variables) { values.emplace_back(v.key, spec.value(v.key)); }
        return values;
    }

    [[nodiscard]] bool better(const IntegerCase& a, const IntegerCase& b) const {
        return design_.objectives.front().maximise ? a.report.objective > b.report.objective
                                                   : a.report.objective < b.report.objective;
    }

    /// The best certified case; without one the best that could be verified; null if there is none.
    [[nodiscard]] std::size_t best_of(const std::vector<IntegerCase>& cases) const {
        std::size_t best = cases.size();
        for (std::size_t i = 0; i < cases.size(); ++i) {
            const IntegerCase& c = cases[i];
            if (!c.verified || c.verified->status != design::EvaluationStatus::ok) { continue; }
            const bool first = best == cases.size();
            const bool differ = !first && c.optimal != cases[best].optimal;  // a certified case comes first
            if (first || (differ ? c.optimal : better(c, cases[best]))) { best = i; }
        }
        return best;
    }

    // ---- tiers 2 and 3

    /// Looks at the best design by starts; a counterexample becomes a constraint of its case, which is solved again,
    /// until no start refutes the best design.
    void refute(std::vector<IntegerCase>& cases) {
        const Evaluator sampled(sampled_problem());
        for (int round = 0; round < most_rounds && !stopped(); ++round) {
            const std::size_t at = best_of(cases);
            if (at == cases.size() || !cases[at].optimal || cases[at].looked_at) { return; }
            IntegerCase& c = cases[at];
            if (observer_) { observer_(-1.0, "starts around the best design"); }
            const design::Evaluation evaluation = look_by_starts(sampled, c);
            c.looked_at = true;
            if (evaluation.uniqueness.verdict == design::Verdict::unique) { return; }
            if (evaluation.uniqueness.verdict == design::Verdict::not_checked) {
                reject(c, "whether it is alone could not be decided: " + evaluation.uniqueness.checked);
                return;
            }
            if (std::isnan(unrefuted_)) { unrefuted_ = c.report.objective; }
            counterexamples_.push_back(describe_counterexample(c, evaluation));
            if (design_.single_stable == design::SingleStable::sampled) {
                reject(c, evaluation.reason);
                return;
            }
            avoid(c, evaluation, counterexamples_.back());
        }
        const std::size_t at = best_of(cases);
        if (at < cases.size() && !cases[at].looked_at) { reject(cases[at], "the budget of counterexamples is spent"); }
    }

    [[nodiscard]] design::Problem sampled_problem() const {
        design::Problem problem = tightened(design_);
        problem.single_stable = design::SingleStable::sampled;
        return problem;
    }

    design::Evaluation look_by_starts(const Evaluator& sampled, IntegerCase& c) const {
        const DesignNlp nlp(evaluator_, c.fixed, scale_, nullptr);
        design::Demand demand;
        demand.quantities = {design_.objectives.front().quantity};
        design::Evaluation evaluation = sampled.evaluate(nlp.specification(c.x), demand);
        c.verified->uniqueness = evaluation.uniqueness;
        return evaluation;
    }

    static void reject(IntegerCase& c, const std::string& reason) {
        c.optimal = false;
        c.report.status = "not-certified";
        c.report.reason = reason;
    }

    Counterexample describe_counterexample(const IntegerCase& c, const design::Evaluation& evaluation) const {
        Counterexample found;
        found.layers = c.report.layers;
        found.design = c.report.design;
        found.objective = c.report.objective;
        const design::Attractor& other = evaluation.uniqueness.attractors.front();
        found.period = other.period;
        found.peak_force = other.peak_force;
        found.remedy = "none tried";
        return found;
    }

    /// The window of the intruder becomes a constraint: operate below it or above it, whichever is better.
    void avoid(IntegerCase& c, const design::Evaluation& evaluation, Counterexample& account) {
        const DesignNlp nlp(evaluator_, c.fixed, scale_, nullptr);
        const model::Specification spec = nlp.specification(c.x);
        const auto intruder = std::make_shared<const design::Intruder>(
            design::find_window(evaluator_, spec, evaluation.operating_point.omega, evaluation.uniqueness.attractors));
        if (!intruder->ok) {
            account.remedy = intruder->trouble;
            return reject(c, evaluation.reason + "; " + intruder->trouble);
        }
        const model::Scales scales = model::scale(spec).scales;
        account.period = intruder->period;
        account.window_lower = design::drive_frequency(intruder->lower.omega, scales);
        account.window_upper = design::drive_frequency(intruder->upper.omega, scales);
        IntegerCase best = c;
        bool found = false;
        for (const bool below : {true, false}) {
            if (stopped()) { break; }
            if (observer_) { observer_(-1.0, below ? "operating below the window" : "operating above the window"); }
            std::vector<Exclusion> exclusions = c.exclusions;
            exclusions.emplace_back(intruder, below, design_.sampling.margin.value_or(design_.margin));
            IntegerCase moved = solve(c.fixed, {c.x}, exclusions);
            c.evaluations += moved.evaluations;
            if (moved.optimal && (!found || better(moved, best))) {
                best = std::move(moved);
                found = true;
                account.remedy = below ? "operate below the window" : "operate above the window";
            }
        }
        if (!found) {
            account.remedy = "no certified design was found below or above the window";
            return reject(c, evaluation.reason + "; " + account.remedy);
        }
        best.evaluations = c.evaluations;
        c = std::move(best);
    }

    /// The best certified case; without one the best feasible; without that an account of what stood in the way.
    OptimiseStudyResult conclude(const std::vector<IntegerCase>& cases, std::size_t expected) const {
        OptimiseStudyResult result;
        for (const IntegerCase& c : cases) {
            result.per_layers.push_back(c.report);
            result.evaluations += c.evaluations;
        }
        result.counterexamples = counterexamples_;
        result.objective_unrefuted = unrefuted_;
        const std::size_t at = best_of(cases);
        const IntegerCase* best = at < cases.size() ? &cases[at] : nullptr;
        const bool cut_short =
            cases.size() < expected ||
            std::any_of(cases.begin(), cases.end(), [](const IntegerCase& c) { return c.report.status == "budget"; });
        if (best == nullptr) {
            result.status = cut_short ? "budget" : "infeasible";
            result.ending = cut_short ? Ending::budget : Ending::infeasible;
            result.reason = cases.empty() ? "stopped before the first design" : least_infeasible(cases).report.reason;
            return result;
        }
        fill(result, *best);
        if (cut_short) {
            result.status = "budget";
            result.ending = Ending::budget;
            result.reason = "the search was cut short";
        } else if (!best->optimal) {
            result.status = "not-certified";
            result.ending = Ending::not_certified;
            result.reason = best->report.reason;
        } else {
            result.status = "optimal";
            result.ending = Ending::verified;
        }
        return result;
    }

    static const IntegerCase& least_infeasible(const std::vector<IntegerCase>& cases) {
        return *std::min_element(cases.begin(), cases.end(), [](const IntegerCase& a, const IntegerCase& b) {
            return a.solved.best.infeasibility < b.solved.best.infeasibility;
        });
    }

    void fill(OptimiseStudyResult& result, const IntegerCase& best) const {
        result.best = *best.verified;
        result.kkt_residual = best.certificate.residual;
        const Quantity objective = design_.objectives.front().quantity;
        result.objective_error = best.verified->error_estimates[static_cast<std::size_t>(objective)];
        result.design = best.report.design;
        result.limits = report_limits(design_, evaluator_, best, scale_);
    }

    const StudyProblem& problem_;
    design::Problem design_;
    Evaluator evaluator_;
    Evaluator tight_evaluator_;
    RowSink* rows_;
    const Observer& observer_;
    const StopRequest& stop_;
    double scale_ = 0.0;
    std::vector<Counterexample> counterexamples_;
    double unrefuted_ = design::absent;

    static constexpr int most_rounds = 12;  ///< counterexamples in a row
};

}  // namespace

OptimiseStudyResult run_optimise(const StudyProblem& problem, RowSink* rows, const Observer& observer,
                                 const StopRequest& stop) {
    const auto start = std::chrono::steady_clock::now();
    check(problem);
    if (rows != nullptr) { rows->header(design_columns(problem.design)); }
    Optimisation optimisation(problem, rows, observer, stop);
    OptimiseStudyResult result = optimisation.run();
    if (observer) { observer(1.0, "done"); }
    result.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
    return result;
}

}  // namespace percuss::study
