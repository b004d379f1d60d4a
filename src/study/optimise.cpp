#include "study/optimise.hpp"

#include "optimise/multi_start.hpp"
#include "optimise/solve.hpp"
#include "study/design_nlp.hpp"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <optional>
#include <stdexcept>

namespace percuss::study {
namespace {

using design::Evaluator;
using design::Quantity;
using optimise::MultiStartResult;
using optimise::Vector;

/// The claimed optimum is evaluated once more with the integrator this much tighter.
constexpr double verification_factor = 1e-2;
/// A limit within this relative distance of its bound is active.
constexpr double activity = 1e-6;

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

/// All combinations of the integer variables, in order.
std::vector<model::Specification> enumerate_integers(const design::Problem& problem) {
    std::vector<model::Specification> cases = {problem.actuator};
    for (const design::DesignVariable& v : problem.variables) {
        if (!v.integer) { continue; }
        std::vector<model::Specification> extended;
        for (const model::Specification& base : cases) {
            for (double value = std::ceil(v.lower); value <= v.upper; value += 1.0) {
                extended.push_back(base);
                extended.back().set(v.key, value);
            }
        }
        cases = std::move(extended);
    }
    if (cases.empty()) { throw std::invalid_argument("design.variable: an integer range holds no integer"); }
    if (cases.size() > 256) {
        throw std::invalid_argument("design.variable: integer variables have more than 256 combinations");
    }
    return cases;
}

double first_integer_value(const design::Problem& problem, const model::Specification& spec) {
    for (const design::DesignVariable& v : problem.variables) {
        if (v.integer) { return spec.value(v.key); }
    }
    return design::absent;
}

/// One integer case solved.
struct Case {
    model::Specification fixed;
    MultiStartResult solved;
    std::optional<design::Evaluation> verified;  ///< at the tighter tolerance, all quantities
    optimise::Certificate certificate;           ///< of the verified values
    IntegerCaseReport report;
    Vector x;
    long evaluations = 0;
    bool optimal = false;
};

std::string describe_failures(const DesignNlp& nlp) {
    std::string text = "no design of the box could be evaluated:";
    for (const auto& [status, count] : nlp.statuses()) {
        text += " " + std::to_string(count) + " " + std::string(design::to_string(status)) + ",";
    }
    text.pop_back();
    return text;
}

/// The limits that cannot be met together: those with a multiplier of the elastic problem, else the most violated one.
std::string describe_infeasible(const design::Problem& problem, const MultiStartResult& solved) {
    std::string names;
    const Vector& multipliers = solved.certificate.multipliers;
    const Vector& violations = solved.best.constraints;
    for (std::size_t i = 0; i < problem.limits.size(); ++i) {
        const int k = static_cast<int>(i);
        const bool blamed = multipliers.size() > k && multipliers[k] > 1e-3 && violations[k] > 0.0;
        if (blamed) { names += (names.empty() ? "" : " and ") + problem.limits[i].text; }
    }
    if (names.empty()) {
        int worst = 0;
        violations.maxCoeff(&worst);
        names = problem.limits[static_cast<std::size_t>(worst)].text;
    }
    return "no design was found that meets the limit " + names;
}

class Optimisation {
public:
    Optimisation(const StudyProblem& problem, RowSink* rows, const Observer& observer, const StopRequest& stop)
        : problem_(problem),
          design_(problem.design),
          evaluator_(design_),
          tight_evaluator_(tightened(design_)),
          rows_(rows),
          observer_(observer),
          stop_(stop) {}

    OptimiseStudyResult run() {
        const std::vector<model::Specification> fixed = enumerate_integers(design_);
        std::vector<Case> cases;
        for (std::size_t i = 0; i < fixed.size() && !stopped(); ++i) {
            report_progress(static_cast<double>(i) / static_cast<double>(fixed.size()), fixed[i]);
            cases.push_back(solve(fixed[i], cases));
        }
        return conclude(cases, fixed.size());
    }

private:
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

    Case solve(const model::Specification& fixed, const std::vector<Case>& before) {
        Case c;
        c.fixed = fixed;
        c.report.layers = first_integer_value(design_, fixed);
        if (scale_ == 0.0) { scale_ = objective_scale(fixed); }
        DesignNlp nlp(evaluator_, fixed, scale_, rows_);
        if (nlp.variables() == 0) {
            solve_fixed(c, nlp);
        } else {
            solve_continuous(c, nlp, before);
        }
        for (const auto& [status, count] : nlp.statuses()) { c.evaluations += count; }
        return c;
    }

    /// Nothing to move: the design is evaluated and checked against its limits.
    void solve_fixed(Case& c, DesignNlp& nlp) {
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

    void solve_continuous(Case& c, DesignNlp& nlp, const std::vector<Case>& before) {
        optimise::MultiStartOptions options;
        options.solver.method = problem_.optimiser.method;
        options.solver.max_evaluations = problem_.optimiser.max_evaluations;
        options.solver.tolerance = std::min(1e-8, 0.01 * problem_.optimiser.tolerance);
        options.solver.seed = problem_.seed;
        options.solver.stop = stop_;
        options.candidates = problem_.optimiser.samples;
        options.starts = problem_.optimiser.starts;
        options.certificate_tolerance = problem_.optimiser.tolerance;
        if (!before.empty() && before.back().optimal) { options.warm_starts.push_back(before.back().x); }
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
    void verify(Case& c, const DesignNlp& nlp) {
        design::Demand demand = nlp.demand(true);
        const auto all = design::reported_quantities(design_.actuator.family);
        demand.quantities.assign(all.begin(), all.end());
        demand.error_estimates = true;
        c.verified = tight_evaluator_.evaluate(nlp.specification(c.x), demand);
        const optimise::Evaluation e = nlp.translate(*c.verified, c.x, true);
        optimise::CertificateOptions options;
        options.activity = activity;
        if (nlp.variables() > 0) { c.certificate = optimise::certify(e, c.x, nlp.lower(), nlp.upper(), options); }
    }

    void settle(Case& c, const DesignNlp& nlp) {
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

    /// The best certified case; without one the best feasible; without that an account of what stood in the way.
    OptimiseStudyResult conclude(const std::vector<Case>& cases, std::size_t expected) const {
        OptimiseStudyResult result;
        const Case* best = nullptr;
        const bool maximise = design_.objectives.front().maximise;
        const auto better = [&](const Case& a, const Case& b) {
            return maximise ? a.report.objective > b.report.objective : a.report.objective < b.report.objective;
        };
        for (const Case& c : cases) {
            result.per_layers.push_back(c.report);
            result.evaluations += c.evaluations;
            const bool usable = c.verified && c.verified->status == design::EvaluationStatus::ok;
            if (!usable) { continue; }
            const bool differ = best != nullptr && c.optimal != best->optimal;  // a certified case comes first
            if (best == nullptr || (differ ? c.optimal : better(c, *best))) { best = &c; }
        }
        const bool cut_short = cases.size() < expected || std::any_of(cases.begin(), cases.end(), [](const Case& c) {
                                   return c.report.status == "budget";
                               });
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

    static const Case& least_infeasible(const std::vector<Case>& cases) {
        return *std::min_element(cases.begin(), cases.end(), [](const Case& a, const Case& b) {
            return a.solved.best.infeasibility < b.solved.best.infeasibility;
        });
    }

    void fill(OptimiseStudyResult& result, const Case& best) const {
        result.best = *best.verified;
        result.kkt_residual = best.certificate.residual;
        const Quantity objective = design_.objectives.front().quantity;
        result.objective_error = best.verified->error_estimates[static_cast<std::size_t>(objective)];
        result.design = best.report.design;
        const DesignNlp nlp(evaluator_, best.fixed, scale_, nullptr);
        for (std::size_t i = 0; i < design_.limits.size(); ++i) {
            const design::Limit& limit = design_.limits[i];
            LimitReport report;
            report.name = design::quantity_info(limit.quantity).name;
            report.text = limit.text;
            report.value = best.verified->value(limit.quantity);
            report.limit = limit.bound;
            report.upper = limit.upper;
            const double multiplier = best.certificate.multipliers[static_cast<int>(i)];
            report.active = std::abs(report.value - limit.bound) <= activity * nlp.limit_scale(i);
            report.multiplier = multiplier * scale_ / nlp.limit_scale(i);
            result.limits.push_back(report);
        }
        add_active_bounds(result, best, nlp);
    }

    /// Bounds of design variables that the optimum presses on.
    void add_active_bounds(OptimiseStudyResult& result, const Case& best, const DesignNlp& nlp) const {
        const auto& variables = nlp.continuous();
        for (std::size_t j = 0; j < variables.size(); ++j) {
            const double unit = best.x[static_cast<int>(j)];
            const bool at_upper = unit >= 1.0 - activity;
            if (!at_upper && unit > activity) { continue; }
            const model::KeyInfo& info = model::key_info(variables[j].key);
            LimitReport report;
            report.name = info.name;
            report.upper = at_upper;
            report.limit = at_upper ? variables[j].upper : variables[j].lower;
            report.value = variables[j].value(unit);
            report.text = report.name + (at_upper ? " at its upper bound" : " at its lower bound");
            report.active = true;
            const double scaled = std::abs(best.certificate.bound_multipliers[static_cast<int>(j)]);
            report.multiplier = scaled * scale_ / variables[j].slope(unit);
            result.limits.push_back(report);
        }
    }

    const StudyProblem& problem_;
    const design::Problem& design_;
    Evaluator evaluator_;
    Evaluator tight_evaluator_;
    RowSink* rows_;
    const Observer& observer_;
    const StopRequest& stop_;
    double scale_ = 0.0;
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
