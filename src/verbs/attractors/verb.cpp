#include "verbs/attractors/verb.hpp"

#include "problem/row_types.hpp"
#include "verbs/attractors/attractors_results.hpp"

namespace percuss::verbs {

namespace {

Outcome run(Session& session) {
    session.start({"attractors.csv"});
    AttractorsResult result =
        run_attractors(session.study(), session.get<AttractorsOptions>(), session.observer(), session.cancelled());
    result.ending = session.ending_of(result.ending);
    const problem::ProblemFile& problem = session.problem();
    session.write("attractors.csv", attractors_csv(problem, result));
    return {result.ending, std::string(status_of(result)), result.reason, attractors_document(problem, result),
            present_attractors(problem, result)};
}

}  // namespace

problem::Section attractors_section() {
    using namespace problem;
    using Options = AttractorsOptions;
    return section_of<Options>({
        count<Options>("attractors.starts", &Options::starts, Whole{1}, "starts drawn from the box"),
        count<Options>("attractors.cycles", &Options::cycles, Whole{1, 1'000'000},
                       "drive cycles each start is followed at most (four times that when it creeps towards an "
                       "orbit)"),
        state<Options>("attractors.lower", &Options::lower, "from gap and stroke",
                       "corner of the box: lowest states; both corners or none"),
        state<Options>("attractors.upper", &Options::upper, "from gap and stroke",
                       "corner of the box: highest states; both corners or none"),
    });
}

Verb attractors_verb() {
    Verb verb;
    verb.name = "attractors";
    verb.summary = "every stable motion found at one operating point";
    verb.options = {{"starts", "N", "short for --attractors.starts", "attractors.starts"}};
    verb.sections = {"attractors"};
    verb.run = run;
    return verb;
}

}  // namespace percuss::verbs
