#include "verbs/result_folder.hpp"

#include "problem/problem_error.hpp"
#include "results/csv_table.hpp"

#include <fstream>
#include <stdexcept>
#include <system_error>
#include <utility>

namespace percuss::verbs {

namespace fs = std::filesystem;

namespace {

constexpr const char* manifest_name = "manifest.json";

/// A plain file name: what a manifest lists is deleted, so nothing that could point elsewhere.
bool is_plain_name(const std::string& name) {
    return !name.empty() && name != "." && name != ".." && name.find('/') == std::string::npos;
}

}  // namespace

ResultFolder::ResultFolder(fs::path path, std::string verb, std::string problem_name, bool force)
    : path_(std::move(path)) {
    manifest_.verb = std::move(verb);
    manifest_.problem = std::move(problem_name);
    if (path_.empty()) { throw ProblemError("--out '': give the name of a folder, or none"); }
    std::error_code error;
    const auto status = fs::symlink_status(path_, error);
    existed_ = fs::exists(status);
    if (!existed_) { return; }
    const std::string name = path_.string();
    if (!fs::is_directory(fs::status(path_, error))) {
        throw ProblemError(name + " is in the way and is not a folder: give another one with --out");
    }
    if (fs::is_empty(path_, error)) { return; }
    const auto old = read_manifest(path_);
    if (!old) {
        throw ProblemError(name + " is not a results folder of percuss and is left alone: give another one with --out");
    }
    if (old->verb != manifest_.verb || old->problem != manifest_.problem) {
        throw ProblemError(name + " holds the results of " + old->verb + " on " + old->problem +
                           " and is left alone: give another one with --out");
    }
    if (old->state != RunState::finished && !force) {
        throw ProblemError(name + " holds the results of an unfinished run: give --force to replace them");
    }
    old_files_ = old->files;
    old_files_.emplace_back(manifest_name);
}

ResultFolder::~ResultFolder() {
    if (started_ && !finished_) {
        remove_files(manifest_.files);
        std::error_code error;
        fs::remove(path_ / manifest_name, error);
        if (!existed_) {
            fs::remove(path_, error);  // refuses if something else has appeared inside
        }
    }
}

void ResultFolder::start(std::vector<std::string> files, const ProblemFile& problem, const RunRecord& record) {
    std::error_code error;
    fs::create_directories(path_, error);
    if (error) { throw ProblemError(path_.string() + " cannot be created: " + error.message()); }
    remove_files(old_files_);
    started_ = true;
    manifest_.files = std::move(files);
    manifest_.state = RunState::started;
    write(manifest_name, manifest_document(manifest_, problem, record));
}

void ResultFolder::write(const std::string& name, const std::string& content) const {
    const fs::path partial = path_ / (name + std::string(results::partial_ending));
    std::ofstream stream(partial, std::ios::binary);
    stream << content;
    stream.close();
    if (!stream) { throw std::runtime_error(partial.string() + " cannot be written"); }
    fs::rename(partial, path_ / name);
}

std::unique_ptr<results::RowSink> ResultFolder::table(const std::string& name) const {
    return std::make_unique<results::CsvTable>(path_ / name);
}

void ResultFolder::finish(RunState state, const ProblemFile& problem, const RunRecord& record) {
    manifest_.state = state;
    std::erase_if(manifest_.files, [&](const std::string& name) { return !fs::exists(path_ / name); });
    write(manifest_name, manifest_document(manifest_, problem, record));
    finished_ = true;
}

void ResultFolder::remove_files(const std::vector<std::string>& files) const {
    for (const std::string& name : files) {
        if (is_plain_name(name)) {
            std::error_code error;
            fs::remove(path_ / name, error);
            fs::remove(path_ / (name + std::string(results::partial_ending)), error);
        }
    }
}

}  // namespace percuss::verbs
