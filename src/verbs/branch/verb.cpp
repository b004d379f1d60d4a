#include "verbs/branch/verb.hpp"

#include "design/families.hpp"
#include "problem/problem_error.hpp"
#include "problem/row_types.hpp"
#include "verbs/along.hpp"
#include "verbs/branch/branch_results.hpp"
#include "verbs/branch/branch_setup.hpp"

namespace percuss::verbs {

namespace {

/// Both ends of the range, unless it is one of drive frequencies, which has defaults.
void require_range(const BranchOptions& options) {
    if (!options.along || model::is_frequency(*options.along) || (options.from && options.to)) { return; }
    throw problem::ProblemError(std::string(options.from ? "branch.to" : "branch.from") +
                                " is missing: give both ends of the range of " +
                                std::string(model::key_info(*options.along).name));
}

Outcome run(Session& session) {
    BranchOptions options = session.get<BranchOptions>();
    options.gradients = session.gradients();
    require_range(options);
    session.start({"branch.csv", "boundaries.csv"});
    BranchResult result = run_branch(session.study(), options, session.observer(), session.cancelled());
    result.ending = session.ending_of(result.ending);

    const problem::ProblemFile& problem = session.problem();
    session.write("branch.csv", branch_csv(problem, result));
    session.write("boundaries.csv", boundaries_csv(problem, result));
    return {result.ending, std::string(to_string(result.ending)), result.reason, branch_document(problem, result),
            present_branch(problem, result)};
}

std::optional<model::Key> key_of(const BranchOptions& options, const problem::Context& context) {
    return options.along.value_or(model::frequency_key(context.actuator));
}

}  // namespace

problem::Section branch_section() {
    using namespace problem;
    using Options = BranchOptions;
    return section_of<Options>({
        along_row<Options>("branch", "the drive frequency", "what is varied", true),
        end_row<Options>("branch", "from", "3 linear resonance", "start of the range", key_of),
        end_row<Options>("branch", "to", "0.6 linear resonance", "end of the range", key_of),
        count<Options>("branch.period", &Options::period, Whole{1, 64},
                       "also branches of motions of up to this many drive cycles"),
        count<Options>("branch.starts", &Options::starts, Whole{0, 1'000'000},
                       "starts of the search for such motions, at each frequency it looks at"),
        count<Options>("branch.max_points", &Options::max_points, Whole{2, 1'000'000}, "most points of a branch"),
    });
}

Verb branch_verb() {
    Verb verb;
    verb.name = "branch";
    verb.summary = "continuation in the drive frequency or a design variable: hysteresis map, all boundaries";
    verb.options = {{"gradients", "", "also the derivatives of what was found", ""},
                    {"period", "N", "short for --branch.period", "branch.period"},
                    {"from", "VALUE", "short for --branch.from", "branch.from"},
                    {"to", "VALUE", "short for --branch.to", "branch.to"},
                    {"along", "KEY", "short for --branch.along", "branch.along"},
                    {"starts", "N", "short for --branch.starts", "branch.starts"}};
    verb.sections = {"branch", "design"};
    verb.run = run;
    verb.frequency = problem::FrequencyUse::ranges;
    return verb;
}

}  // namespace percuss::verbs
