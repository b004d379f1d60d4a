#pragma once
/// \file
/// The folder a run leaves its results in.

#include "verbs/manifest.hpp"
#include "verbs/study.hpp"

#include <filesystem>
#include <memory>
#include <string>
#include <vector>

namespace percuss::verbs {

/// Life of a folder: the constructor only looks, start() creates it (or empties one that may be replaced), write() and
/// table() fill it, finish() closes it. Every file appears under its name only when it is complete. What start() made
/// is taken away again by the destructor unless finish() was called.
class ResultFolder {
public:
    /// Throws ProblemError if `path` is something that must not be touched: anything but a new name, an empty folder,
    /// or the folder of a finished run of the same verb on a problem of the same name (unfinished: only with `force`).
    ResultFolder(std::filesystem::path path, std::string verb, std::string problem_name, bool force);
    ~ResultFolder();
    ResultFolder(const ResultFolder&) = delete;
    ResultFolder& operator=(const ResultFolder&) = delete;

    [[nodiscard]] const std::filesystem::path& path() const { return path_; }

    /// Creates the folder with a manifest that says "started". `files`: names that will be written.
    void start(std::vector<std::string> files, const ProblemFile& problem, const RunRecord& record);

    /// Writes one file. Throws std::runtime_error when that fails.
    void write(const std::string& name, const std::string& content) const;

    /// A table written row by row as CSV, "name [unit]" in its header; complete when destroyed.
    [[nodiscard]] std::unique_ptr<results::RowSink> table(const std::string& name) const;

    /// Writes the last manifest.
    void finish(RunState state, const ProblemFile& problem, const RunRecord& record);

private:
    void remove_files(const std::vector<std::string>& files) const;

    std::filesystem::path path_;
    Manifest manifest_;
    std::vector<std::string> old_files_;  ///< of the run to be replaced
    bool existed_ = false;
    bool started_ = false;
    bool finished_ = false;
};

}  // namespace percuss::verbs
