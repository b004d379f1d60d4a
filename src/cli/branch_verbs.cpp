#include "cli/verbs.hpp"

#include "cli/progress.hpp"
#include "cli/session.hpp"
#include "cli/stopping.hpp"
#include "io/branch_results.hpp"

namespace percuss::cli {

int branch(const Arguments& arguments) {
    Session session(arguments, io::FrequencyUse::ranges);
    io::require_branch_range(session.problem());
    study::BranchStudy study = session.problem().branch;
    study.gradients = arguments.gradients;
    session.start({"result.json", "report.html", "branch.csv", "boundaries.csv"});
    study::BranchStudyResult result;
    {
        Progress progress(arguments.quiet);
        result =
            study::run_branch(session.problem().study, study, progress.observer(), stop_request(arguments.time_limit));
    }
    result.ending = told_apart(result.ending);

    const io::ProblemFile& problem = session.problem();
    const std::string document = io::branch_document(problem, result);
    const auto presentation = io::present_branch(problem, result);
    session.write("branch.csv", io::branch_csv(problem, result));
    session.write("boundaries.csv", io::boundaries_csv(problem, result));
    return session.conclude(result.ending, document, presentation);
}

int locus(const Arguments& arguments) {
    Session session(arguments, io::FrequencyUse::ranges);
    io::require_locus_range(session.problem());
    session.start({"result.json", "report.html", "locus.csv"});
    study::LocusStudyResult result;
    {
        Progress progress(arguments.quiet);
        result = study::run_locus(session.problem().study, session.problem().locus, progress.observer(),
                                  stop_request(arguments.time_limit));
    }
    result.ending = told_apart(result.ending);

    const io::ProblemFile& problem = session.problem();
    const std::string document = io::locus_document(problem, result);
    const auto presentation = io::present_locus(problem, result);
    session.write("locus.csv", io::locus_csv(problem, result));
    return session.conclude(result.ending, document, presentation);
}

}  // namespace percuss::cli
