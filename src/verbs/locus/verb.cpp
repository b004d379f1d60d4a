#include "verbs/locus/verb.hpp"

#include "problem/problem_error.hpp"
#include "problem/row_types.hpp"
#include "verbs/along.hpp"
#include "verbs/locus/locus_results.hpp"

namespace percuss::verbs {

namespace {

void require_range(const LocusOptions& options) {
    if (!options.along) {
        throw problem::ProblemError("locus.along is missing: give the key to vary besides the drive frequency, as in "
                                    "--along stop.gap");
    }
    if (!options.from || !options.to) {
        throw problem::ProblemError(std::string(options.from ? "locus.to" : "locus.from") +
                                    " is missing: give both ends of the range of " +
                                    std::string(model::key_info(*options.along).name));
    }
}

Outcome run(Session& session) {
    const auto& options = session.get<LocusOptions>();
    require_range(options);
    session.start({"locus.csv"});
    LocusResult result = run_locus(session.study(), options, session.observer(), session.cancelled());
    result.ending = session.ending_of(result.ending);

    const problem::ProblemFile& problem = session.problem();
    session.write("locus.csv", locus_csv(problem, result));
    return {result.ending, std::string(to_string(result.ending)), result.reason, locus_document(problem, result),
            present_locus(problem, result)};
}

std::optional<model::Key> key_of(const LocusOptions& options, const problem::Context& /*context*/) {
    return options.along;
}

}  // namespace

problem::Section locus_section() {
    using namespace problem;
    using boundary::Kind;
    using Options = LocusOptions;
    return section_of<Options>({
        choice<Options, Kind>(
            "locus.boundary", &Options::kind,
            {{"fold", Kind::fold}, {"flip", Kind::flip}, {"torus", Kind::torus}, {"grazing", Kind::grazing}},
            "kind of boundary to follow"),
        along_row<Options>("locus", "none", "what is varied besides the drive frequency", false),
        end_row<Options>("locus", "from", "none", "start of the range", key_of),
        end_row<Options>("locus", "to", "none", "end of the range", key_of),
        count<Options>("locus.steps", &Options::steps, Whole{1, 100'000},
                       "about so many round values of the key are among the points"),
        count<Options>("locus.max_points", &Options::max_points, Whole{2, 1'000'000}, "most points of a curve"),
    });
}

Verb locus_verb() {
    Verb verb;
    verb.name = "locus";
    verb.summary = "follow a boundary in two parameters";
    verb.options = {{"from", "VALUE", "short for --locus.from", "locus.from"},
                    {"to", "VALUE", "short for --locus.to", "locus.to"},
                    {"steps", "N", "short for --locus.steps", "locus.steps"},
                    {"along", "KEY", "short for --locus.along", "locus.along"},
                    {"boundary", "KIND", "short for --locus.boundary", "locus.boundary"}};
    verb.sections = {"locus"};
    verb.run = run;
    verb.frequency = problem::FrequencyUse::ranges;
    return verb;
}

}  // namespace percuss::verbs
