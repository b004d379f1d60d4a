#include "optimise/solve.hpp"

#include "optimise/certificate.hpp"
#include "optimise/method.hpp"
#include "optimise/repair.hpp"

#include <algorithm>
#include <cmath>
#include <sstream>
#include <stdexcept>

namespace percuss::optimise {
namespace {

using Status = Outcome::Status;

void check_start(const Vector& start, const MemoisedNlp& nlp) {
    if (start.size() == nlp.variables() && !start.hasNaN()) return;
    std::ostringstream message;
    message << "start = (" << start.transpose() << "), must be " << nlp.variables() << " numbers";
    throw std::invalid_argument(message.str());
}

/// What polishes the best point of a global method.
const Method& polisher() { return find_method("slsqp"); }

/// The search of a global method on its share of the budget; returns the point to polish.
Vector explored(MemoisedNlp& memo, const Method& method, const Vector& start, const Options& options) {
    // A share only: the rest is for the polish, to which all points evaluated here are free.
    memo.allow(static_cast<int>(std::ceil(options.global_share * options.max_evaluations)));
    Guard guard(memo);
    (void)method.solver(guard, start, options);
    (void)guard.halt();  // throws what the evaluator has thrown
    memo.allow(options.max_evaluations);
    if (memo.best_feasible()) return memo.best_feasible()->x;
    return memo.least_infeasible() ? memo.least_infeasible()->x : start;
}

/// A visited point as the outcome's.
void fill(Outcome& outcome, const Visited& point, double feasibility_tolerance) {
    outcome.x = point.x;
    outcome.objective = point.objective;
    outcome.constraints = point.constraints;
    outcome.infeasibility = point.infeasibility;
    outcome.feasible = point.infeasibility <= feasibility_tolerance;
}

/// The point within the bounds, evaluated (free if known); nothing if it cannot be or the guard has halted.
std::optional<Visited> visit(Guard& guard, const Vector& x) {
    if (x.size() == 0 || guard.halted()) return std::nullopt;
    const Evaluation& here = guard(x, false);
    if (!here.ok) return std::nullopt;
    return Visited{guard.nlp().clip(x), here.objective, here.constraints, infeasibility_of(here.constraints)};
}

/// Whether the solver's point is to be taken rather than the archive's: feasible, and no worse than what a
/// feasibility tolerance is worth.
bool preferred(const Visited& point, const MemoisedNlp& memo) {
    const double tolerance = memo.limits().feasibility_tolerance;
    if (!(point.infeasibility <= tolerance) || !memo.best_feasible()) return false;
    const double best = memo.best_feasible()->objective;
    // Multipliers of constraints stand behind the factor; 1e-14 is for a tolerance of zero.
    return point.objective <= best + (10 * tolerance + 1e-14) * std::max(1.0, std::abs(best));
}

/// Of the certificate at x; infinite where there is no gradient.
double kkt_residual(Guard& guard, const Vector& x) {
    return certify(guard(x, true), x, guard.nlp().lower(), guard.nlp().upper()).residual;
}

/// The point on which the solver ended, moved to feasibility if it is slightly off. The point that it returns is its
/// best within its tolerance of feasibility, which can be an earlier one than the one it converged to: of the two the
/// one with the smaller gradient of the Lagrangian.
std::optional<Visited> solution_of(Guard& guard, const SolverAnswer& answer) {
    std::optional<Visited> solution;
    for (const Vector& end : {answer.x, answer.last}) {
        std::optional<Visited> point = visit(guard, end);
        if (point && point->infeasibility > guard.nlp().limits().feasibility_tolerance) {
            if (const std::optional<Vector> feasible = repaired(guard, end)) point = visit(guard, *feasible);
        }
        if (!point || !preferred(*point, guard.nlp())) continue;
        if (!solution || kkt_residual(guard, point->x) < kkt_residual(guard, solution->x)) solution = point;
    }
    return solution;
}

/// The status that the archive and the solver's word together justify.
Outcome settle(Guard& guard, const SolverAnswer& answer) {
    const MemoisedNlp& memo = guard.nlp();
    const std::optional<Visited> solution = solution_of(guard, answer);

    Outcome outcome;
    outcome.message = answer.message;
    const double tolerance = memo.limits().feasibility_tolerance;
    if (solution) fill(outcome, *solution, tolerance);
    else if (memo.best_feasible()) fill(outcome, *memo.best_feasible(), tolerance);
    else if (memo.least_infeasible()) fill(outcome, *memo.least_infeasible(), tolerance);

    if (const std::optional<Halt> halt = guard.halt()) {
        // Circles over known points spend no budget: the method has failed.
        outcome.status = halt->reason() == Halt::Reason::circling ? Status::failed : Status::budget;
        outcome.message = halt->what();
    } else if (solution && answer.claim == SolverAnswer::Claim::optimum) {
        outcome.status = Status::converged;
    } else if (!outcome.feasible && answer.claim != SolverAnswer::Claim::none) {
        // A claim of an optimum at a point that turns out infeasible is a local minimum of infeasibility at best.
        outcome.status = Status::infeasible;
    } else {
        outcome.status = Status::failed;
        if (answer.claim == SolverAnswer::Claim::optimum) outcome.message += ", but a better point had been seen";
    }
    return outcome;
}

}  // namespace

const char* to_string(Status status) {
    switch (status) {
        case Status::not_run: return "not run";
        case Status::converged: return "converged";
        case Status::infeasible: return "infeasible";
        case Status::budget: return "budget";
        case Status::failed: return "failed";
    }
    return "unknown";
}

const std::vector<std::string>& methods() {
    static const std::vector<std::string> names = [] {
        std::vector<std::string> list;
        for (const Method& method : method_table()) list.push_back(method.name);
        return list;
    }();
    return names;
}

void check(const Options& options) {
    (void)find_method(options.method);
    std::ostringstream message;
    if (!(options.tolerance > 0 && options.tolerance < 1)) {
        message << "tolerance = " << options.tolerance << ", must be in (0, 1)";
    } else if (!(options.global_share > 0 && options.global_share <= 1)) {
        message << "global_share = " << options.global_share << ", must be in (0, 1]";
    } else if (!(options.failure_penalty > 0 && std::isfinite(options.failure_penalty))) {
        message << "failure_penalty = " << options.failure_penalty << ", must be positive and finite";
    } else {
        return;
    }
    throw std::invalid_argument(message.str());
}

bool is_global(const std::string& method) { return find_method(method).capabilities.global; }

Outcome minimise(Nlp& nlp, const Vector& start, const Options& options) {
    check(options);
    const Method* method = &find_method(options.method);
    MemoisedNlp memo(nlp, {options.max_evaluations, options.feasibility_tolerance, options.cancelled});
    check_start(start, memo);
    check_fits(*method, memo);

    Vector from = memo.clip(start);
    if (method->capabilities.global) {
        from = explored(memo, *method, from, options);
        method = &polisher();
    }
    Guard guard(memo);
    SolverAnswer answer;
    // Ipopt cannot begin without values, and NLopt's methods would model the penalty.
    if (guard(from, true).ok) answer = method->solver(guard, from, options);
    else answer.message = "the start could not be evaluated";

    Outcome outcome = settle(guard, answer);
    if (outcome.x.size() == 0) outcome.x = memo.clip(start);
    outcome.evaluations = memo.evaluations();
    return outcome;
}

}  // namespace percuss::optimise
