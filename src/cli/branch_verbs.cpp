#include "cli/verbs.hpp"

#include "cli/progress.hpp"
#include "cli/session.hpp"
#include "cli/stopping.hpp"
#include "verbs/branch/branch_results.hpp"

namespace percuss::cli {

int branch(const Arguments& arguments) {
    Session session(arguments, verbs::FrequencyUse::ranges);
    verbs::require_branch_range(session.problem());
    verbs::BranchOptions study = session.problem().branch;
    study.gradients = arguments.gradients;
    session.start({"result.json", "report.html", "branch.csv", "boundaries.csv"});
    verbs::BranchResult result;
    {
        Progress progress(arguments.quiet);
        result =
            verbs::run_branch(session.problem().study, study, progress.observer(), stop_request(arguments.time_limit));
    }
    result.ending = told_apart(result.ending);

    const verbs::ProblemFile& problem = session.problem();
    const std::string document = verbs::branch_document(problem, result);
    const auto presentation = verbs::present_branch(problem, result);
    session.write("branch.csv", verbs::branch_csv(problem, result));
    session.write("boundaries.csv", verbs::boundaries_csv(problem, result));
    return session.conclude(result.ending, document, presentation);
}

int locus(const Arguments& arguments) {
    Session session(arguments, verbs::FrequencyUse::ranges);
    verbs::require_locus_range(session.problem());
    session.start({"result.json", "report.html", "locus.csv"});
    verbs::LocusResult result;
    {
        Progress progress(arguments.quiet);
        result = verbs::run_locus(session.problem().study, session.problem().locus, progress.observer(),
                                  stop_request(arguments.time_limit));
    }
    result.ending = told_apart(result.ending);

    const verbs::ProblemFile& problem = session.problem();
    const std::string document = verbs::locus_document(problem, result);
    const auto presentation = verbs::present_locus(problem, result);
    session.write("locus.csv", verbs::locus_csv(problem, result));
    return session.conclude(result.ending, document, presentation);
}

}  // namespace percuss::cli
