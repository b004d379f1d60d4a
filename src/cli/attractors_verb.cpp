#include "cli/progress.hpp"
#include "cli/session.hpp"
#include "cli/stopping.hpp"
#include "cli/verbs.hpp"
#include "verbs/attractors/attractors_results.hpp"

namespace percuss::cli {

int attractors(const Arguments& arguments) {
    Session session(arguments);
    verbs::AttractorsResult result;
    {
        Progress progress(arguments.quiet);
        result = verbs::run_attractors(session.problem().study, session.problem().attractors, progress.observer(),
                                       stop_request(arguments.time_limit));
    }
    result.ending = told_apart(result.ending);

    const verbs::ProblemFile& problem = session.problem();
    const std::string document = verbs::attractors_document(problem, result);
    const auto presentation = verbs::present_attractors(problem, result);
    session.start({"result.json", "report.html", "attractors.csv"});
    session.write("attractors.csv", verbs::attractors_csv(problem, result));
    return session.conclude(result.ending, document, presentation);
}

}  // namespace percuss::cli
