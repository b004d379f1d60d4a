#include "cli/verbs.hpp"

#include "cli/progress.hpp"
#include "cli/session.hpp"
#include "cli/stopping.hpp"
#include "verbs/simulate/simulate_results.hpp"
#include "verbs/sweep/sweep_results.hpp"

#include <memory>

namespace percuss::cli {

int simulate(const Arguments& arguments) {
    Session session(arguments);
    verbs::SimulateOptions study = session.problem().simulate;
    study.orbit_start = session.problem().orbit.start;
    study.orbit_period = session.problem().orbit.period;
    session.start({"result.json", "report.html", "series.csv", "contacts.csv"});
    verbs::SimulateResult result;
    {
        const auto series = session.table("series.csv");
        const auto contacts = session.table("contacts.csv");
        Progress progress(arguments.quiet);
        result = verbs::run_simulate(session.problem().study, study, series.get(), contacts.get(), progress.observer(),
                                     stop_request(arguments.time_limit));
    }
    result.ending = told_apart(result.ending);

    const std::string document = verbs::simulate_document(session.problem(), result);
    const auto presentation = verbs::present_simulation(session.problem(), result);
    return session.conclude(result.ending, document, presentation);
}

int sweep(const Arguments& arguments) {
    Session session(arguments, verbs::FrequencyUse::ranges);
    session.start({"result.json", "report.html", "sweep.csv"});
    verbs::SweepResult result;
    {
        const auto rows = session.table("sweep.csv");
        Progress progress(arguments.quiet);
        result = verbs::run_sweep(session.problem().study, session.problem().sweep, rows.get(), progress.observer(),
                                  stop_request(arguments.time_limit));
    }
    result.ending = told_apart(result.ending);

    const std::string document = verbs::sweep_document(session.problem(), result);
    const auto presentation = verbs::present_sweep(session.problem(), result);
    return session.conclude(result.ending, document, presentation);
}

}  // namespace percuss::cli
