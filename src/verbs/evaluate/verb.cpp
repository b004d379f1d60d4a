#include "verbs/evaluate/verb.hpp"

#include "verbs/evaluate/evaluate.hpp"
#include "verbs/evaluation_results.hpp"

namespace percuss::verbs {

namespace {

/// percuss/evaluate/1
results::Json document(const problem::ProblemFile& problem, const EvaluateResult& result) {
    return evaluation_document(problem, "percuss/evaluate/1", result.evaluation, result.seconds, WithEdge::yes);
}

results::Presentation present(const problem::ProblemFile& problem, const EvaluateResult& result) {
    results::Presentation out;
    out.title = problem.name + ": evaluation";
    const design::Evaluation& evaluation = result.evaluation;
    out.blocks.push_back(results::status_sentence(design::to_string(evaluation.status), evaluation.reason));
    std::vector<std::pair<model::Key, double>> variables;
    for (const design::DesignVariable& variable : problem.design.variables) {
        variables.emplace_back(variable.key, problem.design.actuator.value(variable.key));
    }
    out.blocks.push_back(design_block(variables));
    add_evaluation(problem, evaluation, WithEdge::yes, out);
    return out;
}

Outcome run(Session& session) {
    start_evaluation(session);
    EvaluateResult result = run_evaluate(session.study(), session.gradients(), session.cancelled());
    result.ending = session.ending_of(result.ending);
    store_evaluation(session, result.evaluation);
    return {result.ending, std::string(design::to_string(result.evaluation.status)), result.evaluation.reason,
            results::printed(document(session.problem(), result)), present(session.problem(), result)};
}

}  // namespace

Verb evaluate_verb() {
    Verb verb;
    verb.name = "evaluate";
    verb.summary = "one design: operating point, quantities, uniqueness";
    verb.options = {{"gradients", "", "also the derivatives of what was found", ""}};
    verb.sections = {"design", "uniqueness"};
    verb.run = run;
    return verb;
}

}  // namespace percuss::verbs
