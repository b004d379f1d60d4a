#include "verbs/merge/verb.hpp"

#include "problem/problem_error.hpp"
#include "results/merge.hpp"
#include "verbs/explore/exploration_text.hpp"
#include "verbs/explore/explore_results.hpp"

#include <algorithm>
#include <set>

namespace percuss::verbs {

namespace {

using problem::ProblemError;
using results::Journal;

std::filesystem::path journal_of(const std::filesystem::path& folder) { return folder / results::journal_name; }

/// The problem that the shards are about, from the journal of the first; the results folder by the shards' own name.
/// What has been merged before is gone on with: shards may come one after the other.
problem::ProblemFile problem_of_shards(RunSettings& settings) {
    if (!settings.keys.empty()) {
        throw ProblemError("option --" + settings.keys.front().key +
                           ": the problem of a merge is that of its shards; give no keys");
    }
    if (settings.seed) { throw ProblemError("option --seed: the seed of a merge is that of its shards"); }
    const std::filesystem::path& first = settings.folders.front();
    const auto whole = whole_folder(first);
    if (!settings.out) {
        if (!whole) {
            throw ProblemError(first.string() + " is not named as a shard (NAME-shard-i-of-N): give the folder to "
                                                "write with --out");
        }
        settings.out = whole->string();
    }
    settings.resume = !settings.force && settings.out != "none";
    const auto manifest = results::read_manifest(first);
    if (!manifest) { throw ProblemError(first.string() + " is not a results folder of percuss"); }
    const Journal journal(journal_of(first));
    if (journal.work().kind != explore_kind) {
        throw ProblemError(first.string() + " holds shards of " + journal.work().kind + ", which cannot be merged");
    }
    return parse_exploration(manifest->problem, journal.work().problem, journal.rows_wanted());
}

/// "shard 1/3, shard 2/3": those of the same division that no source is.
std::string shards_not_given(const std::vector<std::filesystem::path>& sources) {
    std::set<std::int64_t> given;
    std::int64_t count = 1;
    for (const std::filesystem::path& source : sources) {
        const results::Shard shard = Journal(source).shard();
        given.insert(shard.index);
        count = std::max(count, shard.count);
    }
    std::string words;
    constexpr std::int64_t enough = 10;  // so that the line can be read
    for (std::int64_t i = 0, told = 0; i < count && told < enough; ++i) {
        if (given.contains(i)) { continue; }
        words += (words.empty() ? "shard " : ", shard ") + results::text_of({i, count}) + " (not given)";
        ++told;
    }
    return words;
}

std::string lacking_in_words(const results::MergeReport& report, const std::vector<std::filesystem::path>& sources) {
    std::string words;
    for (const std::string& shard : report.lacking) { words += (words.empty() ? "" : ", ") + shard; }
    const std::string others = shards_not_given(sources);
    words += (words.empty() || others.empty() ? "" : ", ") + others;
    std::string blocks;
    for (const results::BlockRange& range : report.missing) {
        blocks += (blocks.empty() ? "" : ", ") + std::to_string(range.first) +
                  (range.last > range.first ? ".." + std::to_string(range.last) : "");
        constexpr std::size_t enough = 60;  // characters, so that the line can be read
        if (blocks.size() > enough) {
            blocks += ", ...";
            break;
        }
    }
    return "blocks " + blocks + " are missing; run these again with --resume, then merge again: " + words;
}

Outcome run(Session& session) {
    results::ResultFolder* folder = session.folder();
    if (folder == nullptr) { throw ProblemError("--out none: merge needs a results folder"); }
    std::vector<std::filesystem::path> sources;
    for (const std::filesystem::path& shard : session.folders()) { sources.push_back(journal_of(shard)); }
    const std::filesystem::path target = journal_of(folder->path());
    const auto files = exploration_files(session.get<ExploreOptions>());
    if (folder->resumes()) {
        folder->hold();
    } else {
        session.start(files);
    }
    const results::MergeReport report = results::merge_journals(sources, target);
    if (folder->resumes()) { session.start(files); }

    const Exploration exploration(session.problem(), session.instruction_set());
    const Journal journal(target);
    ExploreFacts facts;
    facts.ending = report.is_complete() ? Ending::verified : Ending::not_certified;
    if (!report.is_complete()) { facts.reason = lacking_in_words(report, sources); }
    return conclude_exploration(session, exploration, journal, facts);
}

}  // namespace

Verb merge_verb() {
    Verb verb;
    verb.name = "merge";
    verb.summary =
        "join the shards of an exploration into the table one process would have written, in the folder of their "
        "name without -shard-i-of-N or that of --out";
    verb.folders = "SHARD_DIR...";
    verb.problem = problem_of_shards;
    verb.writes_as = explore_kind;
    verb.run = run;
    return verb;
}

}  // namespace percuss::verbs
