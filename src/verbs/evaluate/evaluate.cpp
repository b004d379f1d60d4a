#include "verbs/evaluate/evaluate.hpp"

#include "design/evaluate.hpp"
#include "design/operating_point.hpp"

#include <chrono>
#include <stdexcept>

namespace percuss::verbs {
namespace {

Ending ending_of(design::EvaluationStatus status) {
    switch (status) {
        // Another stable motion beside this one is a finding, told by status and verdict; the evaluation itself
        // succeeded.
        case design::EvaluationStatus::ok:
        case design::EvaluationStatus::not_unique: return Ending::verified;
        case design::EvaluationStatus::no_impact: return Ending::infeasible;
        default: return Ending::some_failed;
    }
}

}  // namespace

std::vector<model::Key> gradient_keys(const design::Problem& problem) {
    std::vector<model::Key> keys;
    for (const design::DesignVariable& variable : problem.variables) { keys.push_back(variable.key); }
    if (!keys.empty()) { return keys; }
    const model::Specification& spec = problem.actuator;
    for (model::Key key : spec.type->keys) {
        if (spec.has(key)) { keys.push_back(key); }
    }
    return keys;
}

std::vector<design::Quantity> quantities_to_report(const design::Problem& problem) {
    const auto all = design::reported_quantities(*problem.actuator.type);
    std::vector<design::Quantity> quantities(all.begin(), all.end());
    bool with_band = problem.single_stable > design::SingleStable::orbit;
    const auto is_band = [](design::Quantity q) {
        return q == design::Quantity::band_lower || q == design::Quantity::band_upper;
    };
    for (const design::Limit& limit : problem.limits) { with_band = with_band || is_band(limit.quantity); }
    for (const design::Objective& objective : problem.objectives) {
        with_band = with_band || is_band(objective.quantity);
    }
    if (!with_band) { std::erase_if(quantities, is_band); }
    return quantities;
}

bool was_cancelled(const design::Evaluation& evaluation, const numerics::CancelRequest& cancelled) {
    const bool cut_short = evaluation.status == design::EvaluationStatus::failed ||
                           evaluation.uniqueness.verdict == design::Verdict::not_checked;
    return cut_short && cancelled && cancelled();
}

EvaluateResult run_evaluate(const StudyProblem& problem, bool gradients, const numerics::CancelRequest& cancelled) {
    const auto start = std::chrono::steady_clock::now();
    EvaluateResult result;
    const design::Evaluator evaluator(design_problem(problem));
    const model::Specification& actuator = problem.design.actuator;
    if (!model::has_frequency(actuator)) {
        if (const auto why = design::edge_ruled_out(evaluator.system(actuator))) { throw std::invalid_argument(*why); }
    }
    design::Demand demand;
    demand.quantities = quantities_to_report(problem.design);
    if (gradients) { demand.gradients = gradient_keys(problem.design); }
    demand.error_estimates = true;
    demand.cancelled = cancelled;
    result.evaluation = evaluator.evaluate(demand);
    result.ending = ending_of(result.evaluation.status);
    if (was_cancelled(result.evaluation, cancelled)) { result.ending = Ending::interrupted; }
    result.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
    return result;
}

}  // namespace percuss::verbs
