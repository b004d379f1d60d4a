#include "verbs/orbit/orbit.hpp"

#include "design/evaluate.hpp"
#include "verbs/evaluate/evaluate.hpp"

#include <chrono>

namespace percuss::verbs {

OrbitResult run_orbit(const StudyProblem& problem, const OrbitOptions& study,
                      const numerics::CancelRequest& cancelled) {
    const auto start = std::chrono::steady_clock::now();
    OrbitResult result;
    const design::Evaluator evaluator(problem.design);
    design::Demand demand;
    demand.quantities = quantities_to_report(problem.design);
    if (study.gradients) { demand.gradients = gradient_keys(problem.design); }
    demand.error_estimates = true;
    demand.cancelled = cancelled;
    result.evaluation = evaluator.orbit(problem.design.actuator, study.start, study.period, demand);
    // An unstable orbit that was asked for by its state is an answer; only a missing one is a failure.
    const bool found = !result.evaluation.orbit.state.empty();
    result.ending = found ? Ending::verified : Ending::some_failed;
    if (was_cancelled(result.evaluation, cancelled)) { result.ending = Ending::interrupted; }
    result.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
    return result;
}

}  // namespace percuss::verbs
