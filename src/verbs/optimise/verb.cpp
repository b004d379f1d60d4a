#include "verbs/optimise/verb.hpp"

#include "problem/problem_error.hpp"
#include "verbs/evaluation_results.hpp"
#include "verbs/optimise/optimise_results.hpp"

namespace percuss::verbs {

namespace {

Outcome run(Session& session) {
    const problem::ProblemFile& problem = session.problem();
    require_one_objective(problem.design);
    session.start({"evaluations.csv", "quantities.csv", "gradients.csv", "layers.csv", "limits.csv"});
    OptimiseStudyResult result;
    {
        const auto rows = session.table("evaluations.csv");
        result = run_optimise(session.study(), rows.get(), session.observer(), session.cancelled());
    }
    result.ending = session.ending_of(result.ending);
    session.write("quantities.csv", quantities_csv(problem, result.design, result.best));
    session.write("gradients.csv", gradients_csv(problem, result.best));
    session.write("layers.csv", layers_csv(problem, result));
    session.write("limits.csv", limits_csv(problem, result));
    return {result.ending, std::string(to_string(result.status)), result.reason, optimise_document(problem, result),
            present_optimum(problem, result)};
}

}  // namespace

void require_one_objective(const design::Problem& design) {
    using problem::ProblemError;
    if (design.variables.empty()) {
        throw ProblemError("design.variable is missing: optimise needs at least one, as in "
                           "'stop.gap in 0.2 mm .. 1.6 mm'");
    }
    if (design.objectives.empty()) {
        throw ProblemError("design.maximise is missing: optimise needs one quantity to maximise or minimise");
    }
    if (design.objectives.size() > 1) {
        throw ProblemError("design.maximise and design.minimise name " + std::to_string(design.objectives.size()) +
                           " objectives: optimise takes exactly one");
    }
}

Verb optimise_verb() {
    Verb verb;
    verb.name = "optimise";
    verb.summary = "the best design, certified";
    verb.sections = {"design", "uniqueness", "optimiser"};
    verb.run = run;
    return verb;
}

}  // namespace percuss::verbs
