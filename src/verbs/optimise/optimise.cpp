#include "verbs/optimise/optimise.hpp"

#include "verbs/optimise/case_solver.hpp"
#include "verbs/optimise/integer_case.hpp"
#include "verbs/optimise/refutation.hpp"

#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <stdexcept>
#include <utility>

namespace percuss::verbs {
namespace {

using design::Quantity;
using optimise::Vector;

/// Throws std::invalid_argument for what a gradient method cannot work on.
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

/// Name for documents, and how a verb with this status ends.
struct StatusRow {
    OptimiseStatus status;
    std::string_view name;
    Ending ending;
};

constexpr std::array status_table = {
    StatusRow{OptimiseStatus::not_run, "not-run", Ending::not_run},
    StatusRow{OptimiseStatus::optimal, "optimal", Ending::verified},
    StatusRow{OptimiseStatus::infeasible, "infeasible", Ending::infeasible},
    StatusRow{OptimiseStatus::not_certified, "not-certified", Ending::not_certified},
    StatusRow{OptimiseStatus::budget, "budget", Ending::budget},
};

const StatusRow& row_of(OptimiseStatus status) {
    return *std::find_if(status_table.begin(), status_table.end(),
                         [status](const StatusRow& row) { return row.status == status; });
}

class Optimisation {
public:
    Optimisation(const StudyProblem& problem, RowSink* rows, const Observer& observer,
                 const numerics::CancelRequest& cancelled)
        : problem_(problem),
          solver_(problem, rows, cancelled),
          observer_(observer),
          cancelled_(cancelled) {}

    OptimiseResult run() {
        const std::vector<model::Specification> fixed = enumerate_integers(problem_.design);
        std::vector<IntegerCase> cases = solve_each(fixed);
        Refutation refutation;
        if (problem_.design.single_stable > design::SingleStable::orbit) {
            refutation = refute(cases, solver_, problem_, observer_, cancelled_);
        }
        OptimiseResult result = conclude(cases, fixed.size());
        result.counterexamples = std::move(refutation.counterexamples);
        result.objective_unrefuted = refutation.objective_unrefuted;
        return result;
    }

private:
    [[nodiscard]] bool cancelled() const { return cancelled_ && cancelled_(); }

    void report_progress(double share, const model::Specification& spec) const {
        if (!observer_) { return; }
        const double value = first_integer_value(problem_.design, spec);
        observer_(share, std::isnan(value) ? "optimising" : "integer case " + std::to_string(std::lround(value)));
    }

    /// One case after the other, each from the optimum of the one before, too, where that is certified.
    std::vector<IntegerCase> solve_each(const std::vector<model::Specification>& fixed) {
        std::vector<IntegerCase> cases;
        for (std::size_t i = 0; i < fixed.size() && !cancelled(); ++i) {
            report_progress(static_cast<double>(i) / static_cast<double>(fixed.size()), fixed[i]);
            // Of a case that is not certified the last point may be anywhere.
            const bool neighbour = !cases.empty() && cases.back().optimal();
            cases.push_back(
                solver_.solve(fixed[i], neighbour ? std::vector{cases.back().x} : std::vector<Vector>{}, {}));
        }
        return cases;
    }

    /// The best certified case; without one the best feasible; without that an account of what stood in the way.
    OptimiseResult conclude(const std::vector<IntegerCase>& cases, std::size_t expected) const {
        OptimiseResult result;
        for (const IntegerCase& c : cases) {
            result.per_layers.push_back(c.report);
            result.evaluations += c.evaluations;
        }
        const IntegerCase* best = best_of(problem_.design, cases);
        const bool cut_short =
            cases.size() < expected || std::any_of(cases.begin(), cases.end(), [](const IntegerCase& c) {
                return c.report.status == OptimiseStatus::budget;
            });
        if (best != nullptr) { fill(result, *best); }
        if (cut_short) {
            result.status = OptimiseStatus::budget;
            result.reason = best != nullptr ? "the search was cut short" : reason_of_none(cases);
        } else if (best == nullptr) {
            result.status = OptimiseStatus::infeasible;
            result.reason = reason_of_none(cases);
        } else {
            result.status = best->optimal() ? OptimiseStatus::optimal : OptimiseStatus::not_certified;
            if (!best->optimal()) { result.reason = best->report.reason; }
        }
        result.ending = ending_of(result.status);
        return result;
    }

    static std::string reason_of_none(const std::vector<IntegerCase>& cases) {
        return cases.empty() ? "stopped before the first design" : least_infeasible(cases).report.reason;
    }

    static const IntegerCase& least_infeasible(const std::vector<IntegerCase>& cases) {
        return *std::min_element(cases.begin(), cases.end(), [](const IntegerCase& a, const IntegerCase& b) {
            return a.solved.best.infeasibility < b.solved.best.infeasibility;
        });
    }

    void fill(OptimiseResult& result, const IntegerCase& best) const {
        result.best = *best.verified;
        result.kkt_residual = best.certificate.residual;
        const Quantity objective = problem_.design.objectives.front().quantity;
        result.objective_error = best.verified->error_estimates[static_cast<std::size_t>(objective)];
        result.design = best.report.design;
        result.limits = report_limits(problem_.design, solver_.evaluator(), best, solver_.objective_scale());
    }

    const StudyProblem& problem_;
    CaseSolver solver_;
    const Observer& observer_;
    const numerics::CancelRequest& cancelled_;
};

}  // namespace

std::string_view to_string(OptimiseStatus status) { return row_of(status).name; }
Ending ending_of(OptimiseStatus status) { return row_of(status).ending; }

OptimiseResult run_optimise(const StudyProblem& problem, RowSink* rows, const Observer& observer,
                            const numerics::CancelRequest& cancelled) {
    const auto start = std::chrono::steady_clock::now();
    check(problem);
    if (rows != nullptr) { rows->header(design_columns(problem.design)); }
    Optimisation optimisation(problem, rows, observer, cancelled);
    OptimiseResult result = optimisation.run();
    if (observer) { observer(1.0, "done"); }
    result.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
    return result;
}

}  // namespace percuss::verbs
