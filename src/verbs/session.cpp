#include "verbs/session.hpp"

#include "design/integrators.hpp"
#include "kernels/kernels.hpp"
#include "problem/problem_error.hpp"
#include "results/page.hpp"
#include "verbs/verbs.hpp"

#include <stdexcept>
#include <utility>

namespace percuss::verbs {

namespace {

constexpr std::string_view no_folder = "none";
/// 16 million folders: enough to keep the variants of one problem apart, short enough to read. Should two meet, the
/// manifest tells their full hashes apart.
constexpr std::size_t hash_digits = 6;

/// Whether the options make another problem of the file. A file that is no problem by itself is made one by them.
bool changes_problem(const RunSettings& settings, const Verb& verb, const std::string& hash) {
    if (settings.keys.empty()) { return false; }
    try {
        return problem::problem_hash(problem::read_problem(settings.file, {}, sections(), verb.frequency)) != hash;
    } catch (const problem::ProblemError&) { return true; }
}

/// results/PROBLEM-VERB unless told otherwise, with digits of the hash where options changed the problem: so the
/// results of the file alone stay.
std::filesystem::path whole_path(const RunSettings& settings, const Verb& verb, const problem::ProblemFile& problem) {
    if (settings.out) { return *settings.out; }
    const std::string hash = problem::problem_hash(problem);
    std::string name = problem.name + "-" + std::string(verb.name);
    if (changes_problem(settings, verb, hash)) { name += "-" + hash.substr(0, hash_digits); }
    return std::filesystem::path("results") / name;
}

std::filesystem::path folder_path(const RunSettings& settings, const Verb& verb, const problem::ProblemFile& problem) {
    const std::filesystem::path whole = whole_path(settings, verb, problem);
    return settings.shard.is_whole() || whole.empty() ? whole : shard_folder(whole, settings.shard);
}

results::EarlierRun earlier_run(const RunSettings& settings) {
    using problem::ProblemError;
    if (settings.resume && settings.force) {
        throw ProblemError("--resume goes on with a run and --force replaces it: give one of them");
    }
    if (settings.resume && settings.out == no_folder) {
        throw ProblemError("--resume needs a results folder: --out is none");
    }
    return settings.resume ? results::EarlierRun::resume
         : settings.force  ? results::EarlierRun::replace
                           : results::EarlierRun::protect;
}

problem::ProblemFile problem_of(const Verb& verb, RunSettings& settings) {
    if (verb.problem != nullptr) { return verb.problem(settings); }
    return verb.inspects ? problem::inspect_problem(settings.file, settings.keys, sections())
                         : problem::read_problem(settings.file, settings.keys, sections(), verb.frequency);
}

constexpr std::string_view shard_mark = "-shard-";

}  // namespace

std::filesystem::path shard_folder(const std::filesystem::path& whole, const results::Shard& shard) {
    std::filesystem::path name = whole.has_filename() ? whole : whole.parent_path();
    name += std::string(shard_mark) + std::to_string(shard.index) + "-of-" + std::to_string(shard.count);
    return name;
}

std::optional<std::filesystem::path> whole_folder(const std::filesystem::path& shard) {
    const std::filesystem::path folder = shard.has_filename() ? shard : shard.parent_path();
    const std::string name = folder.filename().string();
    const auto mark = name.rfind(shard_mark);
    if (mark == std::string::npos || mark == 0) { return std::nullopt; }
    return folder.parent_path() / name.substr(0, mark);
}

Session::Session(const Verb& verb, RunSettings settings)
    : settings_(std::move(settings)),
      problem_(problem_of(verb, settings_)) {
    design::Sampling& sampling = problem_.design.sampling;
    sampling.seed = settings_.seed.value_or(sampling.seed);
    sampling.jobs = settings_.jobs.value_or(sampling.jobs);
    study_ = study_problem(problem_);
    record_.instruction_set = kernels::instruction_set_in_use(problem_.design.solver.instruction_set);
    record_.integrator = problem_.troubles.empty() ? design::integrator_in_use(problem_.design) : "";
    record_.started = results::time_stamp();
    const results::EarlierRun earlier = earlier_run(settings_);
    if (!verb.inspects && settings_.out != no_folder) {
        const std::string writes_as(verb.writes_as.empty() ? verb.name : verb.writes_as);
        folder_ = std::make_unique<results::ResultFolder>(folder_path(settings_, verb, problem_), writes_as,
                                                          problem_.name, problem::problem_hash(problem_), earlier);
    }
}

Ending Session::ending_of(Ending ending) const {
    const bool unfinished =
        ending == Ending::interrupted || ending == Ending::budget || ending == Ending::not_certified;
    // A run that was cancelled cannot know by what: with a signal it was interrupted, without one its time was over.
    if (unfinished && settings_.interrupted && settings_.interrupted()) { return Ending::interrupted; }
    return ending == Ending::interrupted ? Ending::budget : ending;
}

void Session::start(std::vector<std::string> files) {
    if (!folder_) { return; }
    // Told before anything is written: a later run removes what is listed, also of a run that was killed.
    files.insert(files.begin(), {"result.json", "report.html"});
    folder_->start(std::move(files), problem_, record_);
}

void Session::write(const std::string& name, const std::string& content) const {
    if (folder_) { folder_->write(name, content); }
}

std::unique_ptr<results::RowSink> Session::table(const std::string& name) const {
    return folder_ ? folder_->table(name) : nullptr;
}

std::string Session::conclude(const Outcome& outcome) {
    if (!folder_) { return ""; }
    folder_->write("result.json", outcome.document);
    folder_->write("report.html", results::report_page(outcome.presentation, problem_, record_.instruction_set));
    record_.finished = results::time_stamp();
    record_.ending = to_string(outcome.ending);
    const bool cut_short = outcome.ending == Ending::interrupted || outcome.resumable;
    folder_->finish(cut_short ? results::RunState::interrupted : results::RunState::finished, problem_, record_);
    return folder_->path().string();
}

std::string_view to_string(Ending ending) {
    switch (ending) {
        case Ending::verified: return "verified";
        case Ending::infeasible: return "infeasible";
        case Ending::not_certified: return "not-certified";
        case Ending::budget: return "budget";
        case Ending::some_failed: return "some-failed";
        case Ending::interrupted: return "interrupted";
        case Ending::refused: return "refused";
        case Ending::not_run: break;
    }
    return "not-run";
}

}  // namespace percuss::verbs
