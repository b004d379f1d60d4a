#include "cli/verbs.hpp"

#include "cli/exit_code.hpp"
#include "cli/progress.hpp"
#include "cli/session.hpp"
#include "cli/stopping.hpp"
#include "problem/problem_error.hpp"
#include "verbs/documents.hpp"
#include "verbs/presentation.hpp"
#include "verbs/result_tables.hpp"

#include <memory>

namespace percuss::cli {

namespace {

std::vector<std::string> files_of_evaluation(bool gradients) {
    std::vector<std::string> files = {"result.json", "report.html", "quantities.csv"};
    if (gradients) { files.emplace_back("gradients.csv"); }
    return files;
}

/// Writes what evaluate and orbit have in common.
void store_evaluation(Session& session, const design::Evaluation& evaluation, bool gradients) {
    session.start(files_of_evaluation(gradients));
    const verbs::ProblemFile& problem = session.problem();
    session.write("quantities.csv",
                  verbs::quantities_csv(problem, verbs::design_values(problem.study.design), evaluation));
    if (gradients) { session.write("gradients.csv", verbs::gradients_csv(problem, evaluation)); }
}

}  // namespace

int check(const Arguments& arguments) {
    const verbs::ProblemFile problem = verbs::inspect_problem(arguments.problem, arguments.keys);
    print(arguments.json ? verbs::check_document(problem) : results::plain_text(verbs::present_check(problem)));
    if (problem.troubles.empty()) { return exit_done; }
    const std::size_t others = problem.troubles.size() - 1;
    throw problem::ProblemError(problem.troubles.front() +
                                (others == 0 ? "" : " (and " + std::to_string(others) + " more)"));
}

int orbit(const Arguments& arguments) {
    Session session(arguments);
    verbs::require_frequency(session.problem());
    verbs::OrbitOptions study = session.problem().orbit;
    study.gradients = arguments.gradients;
    const auto result = verbs::run_orbit(session.problem().study, study);

    const std::string document = verbs::orbit_document(session.problem(), result);
    const auto presentation = verbs::present_orbit(session.problem(), result);
    store_evaluation(session, result.evaluation, arguments.gradients);
    return session.conclude(result.ending, document, presentation);
}

int evaluate(const Arguments& arguments) {
    Session session(arguments);
    const auto result = verbs::run_evaluate(session.problem().study, arguments.gradients);

    const std::string document = verbs::evaluate_document(session.problem(), result);
    const auto presentation = verbs::present_evaluation(session.problem(), result);
    store_evaluation(session, result.evaluation, arguments.gradients);
    return session.conclude(result.ending, document, presentation);
}

int optimise(const Arguments& arguments) {
    Session session(arguments);
    verbs::require_one_objective(session.problem());
    session.start({"result.json", "report.html", "evaluations.csv", "quantities.csv", "gradients.csv", "layers.csv",
                   "limits.csv"});
    verbs::OptimiseStudyResult result;
    {
        const auto rows = session.table("evaluations.csv");
        Progress progress(arguments.quiet);
        result = verbs::run_optimise(session.problem().study, rows.get(), progress.observer(),
                                     stop_request(arguments.time_limit));
    }
    result.ending = told_apart(result.ending);

    const verbs::ProblemFile& problem = session.problem();
    const std::string document = verbs::optimise_document(problem, result);
    const auto presentation = verbs::present_optimum(problem, result);
    session.write("quantities.csv", verbs::quantities_csv(problem, result.design, result.best));
    session.write("gradients.csv", verbs::gradients_csv(problem, result.best));
    session.write("layers.csv", verbs::layers_csv(problem, result));
    session.write("limits.csv", verbs::limits_csv(problem, result));
    return session.conclude(result.ending, document, presentation);
}

}  // namespace percuss::cli
