#pragma once
/// \file
/// One run of a verb: its problem, its results folder, who watches it and who may end it.

#include "problem/problem_file.hpp"
#include "results/presentation.hpp"
#include "results/result_folder.hpp"
#include "verbs/study.hpp"

#include <filesystem>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace percuss::verbs {

/// What a run is told besides the problem.
struct RunSettings {
    std::filesystem::path file;          ///< of the problem
    std::vector<problem::Setting> keys;  ///< keys given as options
    std::optional<std::string> out;      ///< results folder, or "none"
    std::optional<int> jobs;
    std::optional<std::uint64_t> seed;
    bool force = false;
    bool gradients = false;
    Observer observer;
    numerics::CancelRequest cancelled;
    /// Whether it was a signal that cancelled, rather than the time limit.
    numerics::CancelRequest interrupted;
};

/// What a verb leaves behind.
struct Outcome {
    Ending ending = Ending::not_run;
    std::string status;  ///< in the verb's words: "no-impact"
    std::string reason;  ///< one sentence unless verified
    std::string document;
    results::Presentation presentation;
};

struct Verb;

/// With --out none all writing is skipped.
class Session {
public:
    /// Reads the problem and looks at the results folder, without touching it yet. Throws problem::ProblemError.
    Session(const Verb& verb, RunSettings settings);

    [[nodiscard]] const problem::ProblemFile& problem() const { return problem_; }
    [[nodiscard]] const StudyProblem& study() const { return study_; }
    template <class Options>
    [[nodiscard]] const Options& get() const {
        return problem_.get<Options>();
    }
    [[nodiscard]] bool gradients() const { return settings_.gradients; }
    [[nodiscard]] const Observer& observer() const { return settings_.observer; }
    [[nodiscard]] const numerics::CancelRequest& cancelled() const { return settings_.cancelled; }

    /// A run that was cancelled cannot know by what: with a signal it was interrupted, without one its time was over.
    [[nodiscard]] Ending ending_of(Ending ending) const;

    /// Creates the results folder, for these files besides result.json and report.html.
    void start(std::vector<std::string> files);
    void write(const std::string& name, const std::string& content) const;
    /// A table in the results folder; null when nothing is written.
    [[nodiscard]] std::unique_ptr<results::RowSink> table(const std::string& name) const;

    /// Writes result.json and report.html and closes the folder; its name, empty if nothing was written.
    std::string conclude(const Outcome& outcome);

private:
    RunSettings settings_;
    problem::ProblemFile problem_;
    StudyProblem study_;
    results::RunRecord record_;
    std::unique_ptr<results::ResultFolder> folder_;
};

/// "infeasible", "some-failed", ...
std::string_view to_string(Ending ending);

}  // namespace percuss::verbs
