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

/// The journal of a run, where it keeps one.
inline constexpr const char* journal_name = "journal.sqlite";

/// What to do with what a folder holds of an earlier run.
enum class EarlierRun : std::uint8_t {
    protect,  ///< replaced if it is finished and was of the same resolved problem
    replace,  ///< of the same verb: replaced
    resume,   ///< of the same verb: gone on with
};

/// Life of a folder: the constructor only looks, start() locks and creates it (or empties one that may be replaced),
/// write() and table() fill it, finish() closes it. Every file appears under its name only when it is complete. What
/// start() made is taken away again by the destructor unless finish() was called or a journal is in it.
class ResultFolder {
public:
    /// Throws ProblemError if `path` is something that must not be touched: anything but a new name, an empty folder,
    /// or a folder of the same verb, which `earlier` decides about; never while another run writes into it. Whether a
    /// run that is resumed was of the same problem (`hash`) is left to its journal.
    ResultFolder(std::filesystem::path path, std::string verb, std::string problem_name, std::string hash,
                 EarlierRun earlier);
    ~ResultFolder();
    ResultFolder(const ResultFolder&) = delete;
    ResultFolder& operator=(const ResultFolder&) = delete;

    [[nodiscard]] const std::filesystem::path& path() const { return path_; }

    /// Whether there is an earlier run to go on with.
    [[nodiscard]] bool resumes() const { return resumes_; }

    /// Before start(), for what has to be read first: locks the folder of an earlier run and changes nothing in it.
    /// Throws as start() does.
    void hold();

    /// What the folder holds is worth more than its end: whatever happens, nothing is taken away from now on.
    void keep() { keeps_ = true; }

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
    EarlierRun earlier_ = EarlierRun::protect;
    FolderLock lock_;
    std::vector<std::string> old_files_;          ///< of the run to be replaced
    std::vector<std::filesystem::path> created_;  ///< folders, innermost first
    bool resumes_ = false;
    bool holds_ = false;
    bool keeps_ = false;
    bool started_ = false;
    bool finished_ = false;
};

}  // namespace percuss::results
