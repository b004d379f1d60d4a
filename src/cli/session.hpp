#pragma once
/// \file
/// One run of a verb: its problem and its results folder.

#include "cli/arguments.hpp"
#include "verbs/presentation.hpp"
#include "verbs/problem_file.hpp"
#include "verbs/result_folder.hpp"

#include <memory>
#include <string>
#include <vector>

namespace percuss::cli {

/// Writes text to stdout. Throws std::runtime_error when that fails.
void print(const std::string& text);

/// With --out none all writing is skipped.
class Session {
public:
    /// Reads the problem and looks at the results folder, without touching it yet. Throws problem::ProblemError.
    explicit Session(const Arguments& arguments, verbs::FrequencyUse use = verbs::FrequencyUse::operates);

    [[nodiscard]] const verbs::ProblemFile& problem() const { return problem_; }

    /// Creates the results folder, for these files.
    void start(std::vector<std::string> files);
    void write(const std::string& name, const std::string& content) const;
    /// A table in the results folder; null when nothing is written.
    [[nodiscard]] std::unique_ptr<results::RowSink> table(const std::string& name) const;
    /// The end of every verb: writes result.json and report.html, closes the folder and tells where it is, prints the
    /// document or the presentation. Returns the exit code.
    int conclude(verbs::Ending ending, const std::string& document, const results::Presentation& presentation);

private:
    void finish(verbs::Ending ending);

    verbs::ProblemFile problem_;
    bool quiet_;
    bool json_;
    verbs::RunRecord record_;
    std::unique_ptr<verbs::ResultFolder> folder_;
};

}  // namespace percuss::cli
