#pragma once
/// \file
/// One run of a verb: its problem and its results folder.

#include "cli/arguments.hpp"
#include "io/presentation.hpp"
#include "io/problem_file.hpp"
#include "io/result_folder.hpp"

#include <memory>
#include <string>
#include <vector>

namespace percuss::cli {

/// Writes text to stdout. Throws std::runtime_error when that fails.
void print(const std::string& text);

/// With --out none all writing is skipped.
class Session {
public:
    /// Reads the problem and looks at the results folder, without touching it yet. Throws io::ProblemError.
    explicit Session(const Arguments& arguments, io::FrequencyUse use = io::FrequencyUse::operates);

    [[nodiscard]] const io::ProblemFile& problem() const { return problem_; }

    /// Creates the results folder, for these files.
    void start(std::vector<std::string> files);
    void write(const std::string& name, const std::string& content) const;
    /// A table in the results folder; null when nothing is written.
    [[nodiscard]] std::unique_ptr<study::RowSink> table(const std::string& name) const;
    /// The end of every verb: writes result.json and report.html, closes the folder and tells where it is, prints the
    /// document or the presentation. Returns the exit code.
    int conclude(study::Ending ending, const std::string& document, const io::Presentation& presentation);

private:
    void finish(study::Ending ending);

    io::ProblemFile problem_;
    bool quiet_;
    bool json_;
    io::RunRecord record_;
    std::unique_ptr<io::ResultFolder> folder_;
};

}  // namespace percuss::cli
