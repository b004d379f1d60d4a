#pragma once
/// \file
/// The folder a run leaves its results in.

#include "results/folder_lock.hpp"
#include "results/manifest.hpp"
#include "results/row_sink.hpp"

#include <filesystem>
#include <memory>
#include <string>
#include <vector>

namespace percuss::results {

/// Life of a folder: the constructor only looks, start() locks and creates it (or empties one that may be replaced),
/// write() and table() fill it, finish() closes it. Every file appears under its name only when it is complete. What
/// start() made is taken away again by the destructor unless finish() was called.
class ResultFolder {
public:
    /// Throws ProblemError if `path` is something that must not be touched: anything but a new name, an empty folder,
    /// or a folder of the same verb. That is replaced if its run is finished and was of the same resolved problem
    /// (`hash`), else only with `force`; never while another run writes into it.
    ResultFolder(std::filesystem::path path, std::string verb, std::string problem_name, std::string hash, bool force);
    ~ResultFolder();
    ResultFolder(const ResultFolder&) = delete;
    ResultFolder& operator=(const ResultFolder&) = delete;

    [[nodiscard]] const std::filesystem::path& path() const { return path_; }

    /// Creates the folder with a manifest that says "started". `files`: names that will be written. Throws ProblemError
    /// as the constructor does, if something has changed since.
    void start(std::vector<std::string> files, const problem::ProblemFile& problem, const RunRecord& record);

    /// Writes one file. Throws std::runtime_error when that fails.
    void write(const std::string& name, const std::string& content) const;

    /// A table written row by row as CSV, "name [unit]" in its header; complete when destroyed.
    [[nodiscard]] std::unique_ptr<RowSink> table(const std::string& name) const;

    /// Writes the last manifest.
    void finish(RunState state, const problem::ProblemFile& problem, const RunRecord& record);

private:
    void look();
    void create();
    void remove_files(const std::vector<std::string>& files) const;
    void remove_created() const;

    std::filesystem::path path_;
    Manifest manifest_;
    bool force_ = false;
    FolderLock lock_;
    std::vector<std::string> old_files_;          ///< of the run to be replaced
    std::vector<std::filesystem::path> created_;  ///< folders, innermost first
    bool started_ = false;
    bool finished_ = false;
};

}  // namespace percuss::results
