#include "results/result_folder.hpp"

#include "problem/problem_error.hpp"
#include "results/csv_table.hpp"

#include <algorithm>
#include <fstream>
#include <stdexcept>
#include <system_error>
#include <utility>

namespace percuss::results {

namespace fs = std::filesystem;

namespace {

const std::string manifest_name = "manifest.json";

/// A plain file name: what a manifest lists is deleted, so nothing that could point elsewhere.
bool is_plain_name(const std::string& name) {
    return !name.empty() && name != "." && name != ".." && name.find('/') == std::string::npos;
}

/// Whether a folder holds nothing but perhaps the lock of a run and a manifest that it was killed over.
bool holds_nothing(const fs::path& folder) {
    std::error_code error;
    const fs::directory_iterator entries(folder, error);
    return std::all_of(begin(entries), end(entries), [](const auto& entry) {
        const std::string name = entry.path().filename().string();
        return name == FolderLock::file_name || name == manifest_name + std::string(partial_ending);
    });
}

problem::ProblemError in_use(const fs::path& folder) {
    return problem::ProblemError(folder.string() +
                                 " is being written by another run: wait for it, or give another folder with --out");
}

}  // namespace

ResultFolder::ResultFolder(fs::path path, std::string verb, std::string problem_name, std::string hash,
                           EarlierRun earlier)
    : path_(std::move(path)),
      earlier_(earlier) {
    manifest_.verb = std::move(verb);
    manifest_.problem = std::move(problem_name);
    manifest_.hash = std::move(hash);
    if (path_.empty()) { throw problem::ProblemError("--out '': give the name of a folder, or none"); }
    // Before anything is computed; whoever gets the lock is decided in start().
    if (FolderLock::is_taken(path_)) { throw in_use(path_); }
    look();
}

ResultFolder::~ResultFolder() {
    if (started_ && !finished_ && !keeps_) {
        remove_files(manifest_.files);
        remove_files({manifest_name});
    }
    lock_.release();
    if (!finished_) { remove_created(); }
}

void ResultFolder::look() {
    std::error_code error;
    if (!fs::exists(fs::symlink_status(path_, error))) { return; }
    const std::string name = path_.string();
    if (!fs::is_directory(fs::status(path_, error))) {
        throw problem::ProblemError(name + " is in the way and is not a folder: give another one with --out");
    }
    if (holds_nothing(path_)) { return; }
    const auto old = read_manifest(path_);
    if (!old) {
        throw problem::ProblemError(name + " is not a results folder of percuss and is left alone: give another one "
                                           "with --out");
    }
    if (old->verb != manifest_.verb) {
        throw problem::ProblemError(name + " holds the results of " + old->verb + " on " + old->problem +
                                    " and is left alone: give another one with --out");
    }
    if (earlier_ == EarlierRun::resume) {
        resumes_ = true;
        return;
    }
    const bool force = earlier_ == EarlierRun::replace;
    if (old->hash != manifest_.hash && !force) {
        throw problem::ProblemError(name + " holds the results of another problem (" + old->problem + ", hash " +
                                    old->hash + "): give --force to replace them, or another folder with --out");
    }
    if (old->state != RunState::finished && !force) {
        const bool has_journal = fs::exists(path_ / journal_name, error);
        throw problem::ProblemError(name + " holds the results of an unfinished run: give " +
                                    (has_journal ? "--resume to go on with it, or " : "") + "--force to replace them");
    }
    old_files_ = old->files;
    old_files_.emplace_back(manifest_name);
}

void ResultFolder::create() {
    std::error_code error;
    // Innermost first: in this order they can be removed again.
    for (fs::path each = path_; !each.empty() && !fs::exists(each, error); each = each.parent_path()) {
        created_.push_back(each);
    }
    fs::create_directories(path_, error);
    if (error) { throw problem::ProblemError(path_.string() + " cannot be created: " + error.message()); }
}

void ResultFolder::hold() {
    create();
    if (!lock_.take(path_)) { throw in_use(path_); }
    holds_ = true;
    look();  // another run may have come and gone since the constructor looked
}

void ResultFolder::start(std::vector<std::string> files, const problem::ProblemFile& problem, const RunRecord& record) {
    if (!holds_) { hold(); }
    keeps_ = keeps_ || resumes_;
    remove_files(old_files_);
    started_ = true;
    manifest_.files = std::move(files);
    manifest_.state = RunState::started;
    write(manifest_name, manifest_document(manifest_, problem, record));
}

/// Folders that this run made, as far as nothing else has appeared in them.
void ResultFolder::remove_created() const {
    std::error_code error;
    for (const fs::path& folder : created_) { fs::remove(folder, error); }
}

void ResultFolder::write(const std::string& name, const std::string& content) const {
    // Written beside and renamed: a reader sees the old file or the new one, never half of it.
    const fs::path partial = path_ / (name + std::string(partial_ending));
    std::ofstream stream(partial, std::ios::binary);
    stream << content;
    stream.close();
    if (!stream) { throw std::runtime_error(partial.string() + " cannot be written"); }
    fs::rename(partial, path_ / name);
}

std::unique_ptr<RowSink> ResultFolder::table(const std::string& name) const {
    return std::make_unique<CsvTable>(path_ / name);
}

void ResultFolder::finish(RunState state, const problem::ProblemFile& problem, const RunRecord& record) {
    manifest_.state = state;
    // Tables of a run that ended early may not have come to be.
    std::erase_if(manifest_.files, [&](const std::string& name) { return !fs::exists(path_ / name); });
    write(manifest_name, manifest_document(manifest_, problem, record));
    finished_ = true;
    lock_.release();
}

void ResultFolder::remove_files(const std::vector<std::string>& files) const {
    for (const std::string& name : files) {
        if (is_plain_name(name)) {
            std::error_code error;
            fs::remove(path_ / name, error);
            // A run that was killed leaves partial files.
            fs::remove(path_ / (name + std::string(partial_ending)), error);
        }
    }
}

}  // namespace percuss::results
