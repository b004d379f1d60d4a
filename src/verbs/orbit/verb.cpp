#include "verbs/orbit/verb.hpp"

#include "problem/problem_error.hpp"
#include "problem/row_types.hpp"
#include "verbs/evaluation_results.hpp"
#include "verbs/orbit/orbit.hpp"

namespace percuss::verbs {

namespace {

void require_frequency(const problem::ProblemFile& problem) {
    if (model::has_frequency(problem.design.actuator)) { return; }
    throw problem::ProblemError(
        std::string(problem::is_nondimensional(problem.design) ? "nondimensional.omega" : "drive.frequency") +
        " = edge: an orbit is computed at a given frequency, give one");
}

/// percuss/orbit/1: as percuss/evaluate/1 without what belongs to an edge.
results::Json document(const problem::ProblemFile& problem, const OrbitResult& result) {
    return evaluation_document(problem, "percuss/orbit/1", result.evaluation, result.seconds, WithEdge::no);
}

results::Presentation present(const problem::ProblemFile& problem, const OrbitResult& result) {
    results::Presentation out;
    out.title = problem.name + ": periodic orbit";
    const design::Evaluation& evaluation = result.evaluation;
    out.blocks.push_back(results::status_sentence(design::to_string(evaluation.status), evaluation.reason));
    add_evaluation(problem, evaluation, WithEdge::no, out);
    return out;
}

Outcome run(Session& session) {
    require_frequency(session.problem());
    OrbitOptions options = session.get<OrbitOptions>();
    options.gradients = session.gradients();
    start_evaluation(session);
    OrbitResult result = run_orbit(session.study(), options, session.cancelled());
    result.ending = session.ending_of(result.ending);
    store_evaluation(session, result.evaluation);
    return {result.ending, std::string(design::to_string(result.evaluation.status)), result.evaluation.reason,
            results::printed(document(session.problem(), result)), present(session.problem(), result)};
}

}  // namespace

problem::Section orbit_section() {
    using namespace problem;
    using Options = OrbitOptions;
    return section_of<Options>({
        state<Options>("orbit.start", &Options::start, "the motion reached from rest",
                       "state at theta = 0 that Newton's method starts from"),
        count<Options>("orbit.period", &Options::period, Whole{1, 64}, "period of the orbit in drive cycles"),
    });
}

Verb orbit_verb() {
    Verb verb;
    verb.name = "orbit";
    verb.summary = "the periodic orbit at one frequency: state, multipliers, quantities";
    verb.options = {{"gradients", "", "also the derivatives of what was found", ""},
                    {"period", "N", "short for --orbit.period", "orbit.period"}};
    verb.sections = {"orbit", "design"};
    verb.run = run;
    return verb;
}

}  // namespace percuss::verbs
