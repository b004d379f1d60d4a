#include "verbs/explore/verb.hpp"

#include "problem/nearest_name.hpp"
#include "problem/row_types.hpp"
#include "verbs/explore/explore_results.hpp"

#include <cstdlib>
#include <optional>
#include <system_error>

namespace percuss::verbs {

namespace {

using problem::bad_value;
using problem::Context;
using problem::Echo;
using problem::ProblemError;
using problem::Setting;
using results::Journal;

/// A folder for the journal of a run that leaves none, away with the run.
class PassingFolder {
public:
    PassingFolder() {
        std::string name = (std::filesystem::temp_directory_path() / "percuss-explore-XXXXXX").string();
        if (mkdtemp(name.data()) == nullptr) {
            throw ProblemError(name + " cannot be created: set TMPDIR to a folder that can be written");
        }
        path_ = name;
    }
    ~PassingFolder() {
        std::error_code error;
        std::filesystem::remove_all(path_, error);
    }
    PassingFolder(const PassingFolder&) = delete;
    PassingFolder& operator=(const PassingFolder&) = delete;
    [[nodiscard]] const std::filesystem::path& path() const { return path_; }

private:
    std::filesystem::path path_;
};

void refuse_fewer_rows(const Journal& journal, std::int64_t rows) {
    if (journal.rows_wanted() <= rows) { return; }
    throw ProblemError("explore.samples = " + std::to_string(rows) + ": " + journal.file().string() +
                       " is of a table of " + std::to_string(journal.rows_wanted()) +
                       " already; give at least as many, or another folder with --out");
}

/// What there is to go on with is looked at before anything in the folder changes.
Journal open_journal(Session& session, const Exploration& exploration) {
    results::ResultFolder& folder = *session.folder();
    const std::filesystem::path file = folder.path() / results::journal_name;
    const auto files = exploration_files(session.get<ExploreOptions>());
    if (folder.resumes()) {
        folder.hold();
        Journal journal(file, exploration.work(), session.shard());
        refuse_fewer_rows(journal, exploration.space().rows());
        session.start(files);
        return journal;
    }
    session.start(files);
    folder.keep();
    return {file, exploration.work(), session.shard()};
}

Outcome run(Session& session) {
    const Exploration exploration(session.problem(), session.instruction_set());
    std::optional<PassingFolder> passing;
    if (session.folder() == nullptr) { passing.emplace(); }
    Journal journal = passing ? Journal(passing->path() / results::journal_name, exploration.work(), session.shard())
                              : open_journal(session, exploration);
    journal.set_rows_wanted(exploration.space().rows());

    const ExploreProgress progress =
        explore(session.study(), exploration, journal, session.observer(), session.cancelled());
    ExploreFacts facts;
    facts.designs = progress.designs;
    facts.seconds = progress.seconds;
    facts.ending = session.ending_of(progress.is_complete ? Ending::verified : Ending::interrupted);
    facts.is_in_a_hurry = facts.ending == Ending::interrupted;
    if (!progress.is_complete) {
        facts.reason =
            passing ? "nothing is kept: --out is none" : "finished blocks are kept, --resume goes on with the rest";
    }
    return conclude_exploration(session, exploration, journal, facts);
}

// ---- settings -------------------------------------------------------------------------------------------------------

std::vector<std::string> words_of(std::string_view text) {
    std::vector<std::string> words;
    while (true) {
        const auto comma = text.find(',');
        words.emplace_back(model::trimmed(text.substr(0, comma)));
        if (comma == std::string_view::npos) { return words; }
        text = text.substr(comma + 1);
    }
}

/// What explore.columns may name for this actuator.
std::vector<std::string> column_names(const model::Actuator& actuator) {
    std::vector<std::string> names;
    for (const design::Quantity quantity : design::reported_quantities(actuator)) {
        names.emplace_back(design::quantity_info(quantity).name);
    }
    for (const model::Key key : actuator.keys) { names.emplace_back(model::key_info(key).name); }
    for (const std::string_view word : {edge_kind_column, status_column, cause_column}) { names.emplace_back(word); }
    return names;
}

void read_columns(ExploreOptions& options, const Setting& s, const Context& context) {
    const std::vector<std::string> known = column_names(*context.actuator.type);
    options.columns = words_of(s.value);
    for (const std::string& word : options.columns) {
        if (std::find(known.begin(), known.end(), word) == known.end()) {
            throw bad_value(s, "'" + word +
                                   "' is no quantity or key here, nor edge_kind, status or cause; the nearest one is " +
                                   problem::nearest_name(word, known));
        }
    }
}

std::vector<Echo> columns_echo(const ExploreOptions& options, const Context& /*context*/) {
    std::string text;
    for (const std::string& name : options.columns) { text += (text.empty() ? "" : ", ") + name; }
    return text.empty() ? std::vector<Echo>{} : std::vector<Echo>{{text}};
}

std::vector<std::string> sampling_names() {
    std::vector<std::string> names;
    for (const numerics::Sampling& sampling : numerics::samplings()) { names.emplace_back(sampling.name); }
    return names;
}

std::string sampling_meanings() {
    std::string text;
    for (const numerics::Sampling& sampling : numerics::samplings()) {
        text += (text.empty() ? "" : "; ") + std::string(sampling.name) + ": " + std::string(sampling.meaning);
    }
    return text;
}

problem::Row samples_row() {
    problem::Row row = problem::count<ExploreOptions>("explore.samples", &ExploreOptions::samples, problem::Whole{1},
                                                      "designs in the table (a grid may have fewer)");
    row.of_run = true;
    return row;
}

}  // namespace

problem::Section explore_section() {
    using namespace problem;
    using Options = ExploreOptions;
    return section_of<Options>({
        samples_row(),
        word<Options>("explore.sampling", &Options::sampling, sampling_names(), sampling_meanings()),
        setting<Options>("explore.columns", "", "names separated by commas",
                         "objectives, limited quantities, drive_frequency, status, cause",
                         "columns of designs.csv besides the row's number and the variables: quantities, keys, "
                         "edge_kind, status, cause",
                         read_columns, columns_echo),
        choice<Options, bool>(
            "explore.sensitivities", &Options::sensitivities, {{"on", true}, {"off", false}},
            "sensitivities of the quantities, from exact gradients that make an evaluation a few percent slower"),
    });
}

Verb explore_verb() {
    Verb verb;
    verb.name = "explore";
    verb.summary = "a table over the design space, and which variables matter";
    VerbOption resume{"resume", "",
                      "go on with a run that was stopped or killed, or with more samples; begins one "
                      "where there is none",
                      ""};
    resume.apply = [](const Setting&, RunSettings& settings) { settings.resume = true; };
    VerbOption shard{"shard", "i/N",
                     "compute part i (from 0) of N alone, in a folder with -shard-i-of-N behind its name; auto: as a "
                     "Slurm array, mpirun or srun say",
                     ""};
    shard.apply = [](const Setting& s, RunSettings& settings) {
        const auto environment = [](const char* name) -> std::optional<std::string> {
            const char* value = std::getenv(name);
            return value == nullptr ? std::nullopt : std::optional<std::string>(value);
        };
        try {
            settings.shard = results::parse_shard(s.value, environment);
        } catch (const std::invalid_argument& error) { throw bad_value(s, error.what()); }
    };
    verb.options = {{"samples", "N", "short for --explore.samples", "explore.samples"},
                    {"sampling", "NAME", "short for --explore.sampling", "explore.sampling"},
                    resume,
                    shard};
    verb.sections = {"design", "uniqueness", "explore"};
    verb.run = run;
    return verb;
}

}  // namespace percuss::verbs
