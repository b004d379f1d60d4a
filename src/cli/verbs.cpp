#include "cli/verbs.hpp"

#include "cli/exit_code.hpp"
#include "cli/progress.hpp"
#include "cli/session.hpp"
#include "cli/stopping.hpp"
#include "io/documents.hpp"
#include "io/presentation.hpp"
#include "io/problem_error.hpp"
#include "io/result_tables.hpp"

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
    const io::ProblemFile& problem = session.problem();
    session.write("quantities.csv", io::quantities_csv(problem, io::design_values(problem.study.design), evaluation));
    if (gradients) { session.write("gradients.csv", io::gradients_csv(problem, evaluation)); }
}

}  // namespace

int check(const Arguments& arguments) {
    const io::ProblemFile problem = io::inspect_problem(arguments.problem, arguments.keys);
    print(arguments.json ? io::check_document(problem) : io::plain_text(io::present_check(problem)));
    if (problem.troubles.empty()) { return exit_done; }
    const std::size_t others = problem.troubles.size() - 1;
    throw io::ProblemError(problem.troubles.front() +
                           (others == 0 ? "" : " (and " + std::to_string(others) + " more)"));
}

int orbit(const Arguments& arguments) {
    Session session(arguments);
    io::require_frequency(session.problem());
    study::OrbitStudy study = session.problem().orbit;
    study.gradients = arguments.gradients;
    const auto result = study::run_orbit(session.problem().study, study);

    const std::string document = io::orbit_document(session.problem(), result);
    const auto presentation = io::present_orbit(session.problem(), result);
    store_evaluation(session, result.evaluation, arguments.gradients);
    return session.conclude(result.ending, document, presentation);
}

int evaluate(const Arguments& arguments) {
    Session session(arguments);
    const auto result = study::run_evaluate(session.problem().study, arguments.gradients);

    const std::string document = io::evaluate_document(session.problem(), result);
    const auto presentation = io::present_evaluation(session.problem(), result);
    store_evaluation(session, result.evaluation, arguments.gradients);
    return session.conclude(result.ending, document, presentation);
}

int optimise(const Arguments& arguments) {
    Session session(arguments);
    io::require_one_objective(session.problem());
    session.start({"result.json", "report.html", "evaluations.csv", "quantities.csv", "gradients.csv", "layers.csv",
                   "limits.csv"});
    study::OptimiseStudyResult result;
    {
        const auto rows = session.table("evaluations.csv");
        Progress progress(arguments.quiet);
        result = study::run_optimise(session.problem().study, rows.get(), progress.observer(),
                                     stop_request(arguments.time_limit));
    }
    result.ending = told_apart(result.ending);

    const io::ProblemFile& problem = session.problem();
    const std::string document = io::optimise_document(problem, result);
    const auto presentation = io::present_optimum(problem, result);
    session.write("quantities.csv", io::quantities_csv(problem, result.design, result.best));
    session.write("gradients.csv", io::gradients_csv(problem, result.best));
    session.write("layers.csv", io::layers_csv(problem, result));
    session.write("limits.csv", io::limits_csv(problem, result));
    return session.conclude(result.ending, document, presentation);
}

}  // namespace percuss::cli
