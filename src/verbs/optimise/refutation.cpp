#include "verbs/optimise/refutation.hpp"

#include "design/integrators.hpp"

#include <cmath>
#include <memory>
#include <string>
#include <utility>

namespace percuss::verbs {
namespace {

/// Counterexamples in a row. Each side of a window is a search of its own, so a round may take as long as the first
/// optimisation did.
constexpr int most_rounds = 12;

design::Problem sampled(const StudyProblem& problem) {
    design::Problem looked_at = tightened(design_problem(problem));
    looked_at.single_stable = design::SingleStable::sampled;
    return looked_at;
}

void reject(IntegerCase& c, const std::string& reason) {
    c.report.status = OptimiseStatus::not_certified;
    c.report.reason = reason;
}

class Refuter {
public:
    Refuter(std::vector<IntegerCase>& cases, CaseSolver& solver, const StudyProblem& problem, const Observer& observer,
            const numerics::CancelRequest& cancelled)
        : cases_(cases),
          solver_(solver),
          problem_(problem),
          observer_(observer),
          cancelled_(cancelled),
          sampled_(sampled(problem)) {}

    Refutation run() {
        for (int round = 0; round < most_rounds && !cancelled(); ++round) {
            IntegerCase* best = best_of(problem_.design, cases_);
            // Keeping off a window costs, so another case may be the best one now. The rounds end when the best one has
            // been looked at.
            if (best == nullptr || !best->optimal() || best->looked_at) { return std::move(found_); }
            if (!answer(*best, look_by_starts(*best))) { return std::move(found_); }
        }
        IntegerCase* best = best_of(problem_.design, cases_);
        if (best != nullptr && !best->looked_at) { reject(*best, "the budget of counterexamples is spent"); }
        return std::move(found_);
    }

private:
    [[nodiscard]] bool cancelled() const { return cancelled_ && cancelled_(); }
    void say(const char* words) const {
        if (observer_) { observer_(-1.0, words); }
    }

    [[nodiscard]] model::Specification specification_of(const IntegerCase& c) const {
        return DesignNlp(solver_.evaluator(), c.fixed, 1.0, nullptr).specification(c.x);
    }

    design::Evaluation look_by_starts(IntegerCase& c) const {
        say("starts around the best design");
        design::Demand demand;
        demand.quantities = {problem_.design.objectives.front().quantity};
        demand.cancelled = cancelled_;
        design::Evaluation evaluation = sampled_.evaluate(specification_of(c), demand);
        c.verified->uniqueness = evaluation.uniqueness;
        c.looked_at = true;
        return evaluation;
    }

    /// False when there is nothing more to be done: the best design is not refuted, or nothing can be done about it.
    bool answer(IntegerCase& c, const design::Evaluation& evaluation) {
        if (evaluation.uniqueness.verdict == design::Verdict::unique) { return false; }
        if (evaluation.uniqueness.verdict == design::Verdict::not_checked) {
            reject(c, "whether it is alone could not be decided: " + evaluation.uniqueness.checked);
            return false;
        }
        // Of the first refuted design: what being alone costs is the difference to it.
        if (std::isnan(found_.objective_unrefuted)) { found_.objective_unrefuted = c.report.objective; }
        found_.counterexamples.push_back(describe(c, evaluation));
        if (problem_.design.single_stable == design::SingleStable::sampled) {
            reject(c, evaluation.reason);
            return false;
        }
        avoid(c, evaluation, found_.counterexamples.back());
        return true;
    }

    [[nodiscard]] static Counterexample describe(const IntegerCase& c, const design::Evaluation& evaluation) {
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

    /// The window of the intruder becomes a constraint.
    void avoid(IntegerCase& c, const design::Evaluation& evaluation, Counterexample& account) {
        const model::Specification spec = specification_of(c);
        flow::Cost cost;
        cost.cancelled = cancelled_;
        cost.step_budget = design::default_step_budget;
        const auto intruder = std::make_shared<const design::Intruder>(design::find_window(
            solver_.evaluator(), spec, evaluation.operating_point.omega, evaluation.uniqueness.attractors, &cost));
        if (!intruder->ok) {
            account.remedy = intruder->trouble;
            return reject(c, evaluation.reason + "; " + intruder->trouble);
        }
        const model::Scales scales = model::scale(spec).scales;
        account.period = intruder->period;
        account.window_lower = design::drive_frequency(intruder->lower.omega, scales);
        account.window_upper = design::drive_frequency(intruder->upper.omega, scales);
        if (!move_beside(c, intruder, account)) {
            account.remedy = "no certified design was found below or above the window";
            reject(c, evaluation.reason + "; " + account.remedy);
        }
    }

    /// Both sides of the window are tried, and the case becomes the better one; false when neither has a design.
    bool move_beside(IntegerCase& c, const std::shared_ptr<const design::Intruder>& intruder, Counterexample& account) {
        const design::Problem& design = problem_.design;
        IntegerCase best = c;
        bool found = false;
        // The window splits the frequencies in two; a local solver does not cross it.
        for (const bool below : {true, false}) {
            if (cancelled()) { break; }
            say(below ? "operating below the window" : "operating above the window");
            std::vector<Exclusion> exclusions = c.exclusions;
            exclusions.emplace_back(intruder, below, design.sampling.margin.value_or(design.margin));
            IntegerCase moved = solver_.solve(c.fixed, {c.x}, exclusions);
            c.evaluations += moved.evaluations;
            if (moved.optimal() && (!found || better(design, moved, best))) {
                best = std::move(moved);
                found = true;
                account.remedy = below ? "operate below the window" : "operate above the window";
            }
        }
        if (!found) { return false; }
        best.evaluations = c.evaluations;
        c = std::move(best);
        return true;
    }

    std::vector<IntegerCase>& cases_;
    CaseSolver& solver_;
    const StudyProblem& problem_;
    const Observer& observer_;
    const numerics::CancelRequest& cancelled_;
    design::Evaluator sampled_;
    Refutation found_;
};

}  // namespace

Refutation refute(std::vector<IntegerCase>& cases, CaseSolver& solver, const StudyProblem& problem,
                  const Observer& observer, const numerics::CancelRequest& cancelled) {
    return Refuter(cases, solver, problem, observer, cancelled).run();
}

}  // namespace percuss::verbs
