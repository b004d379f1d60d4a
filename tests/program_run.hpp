#pragma once
/// \file
/// Runs the program itself, named by the environment variable PERCUSS_BIN.

#include "scratch_folder.hpp"

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <stdexcept>
#include <string>
#include <vector>

#include <sys/wait.h>

namespace percuss::tests {

struct Outcome {
    int exit_code = -1;
    std::string out;
    std::string err;
};

inline std::string environment(const char* name, const std::string& fallback) {
    const char* value = std::getenv(name);
    return value == nullptr ? fallback : value;
}

inline std::string quoted(const std::string& word) {
    std::string text = "'";
    for (const char c : word) { text += c == '\'' ? "'\\''" : std::string(1, c); }
    return text + "'";
}

/// Runs the program inside a folder; `prefix` stands before it in the shell command.
inline Outcome run(const ScratchFolder& folder, const std::vector<std::string>& arguments,
                   const std::string& prefix = "") {
    const ScratchFolder streams;
    std::string command =
        "cd " + quoted(folder.path().string()) + " && " + prefix + " " + quoted(environment("PERCUSS_BIN", "percuss"));
    for (const std::string& argument : arguments) { command += " " + quoted(argument); }
    command += " >" + quoted((streams.path() / "out").string()) + " 2>" + quoted((streams.path() / "err").string());
    const int status = std::system(command.c_str());
    Outcome outcome;
    outcome.exit_code = WIFEXITED(status) ? WEXITSTATUS(status) : -1;
    outcome.out = read_file(streams.path() / "out");
    outcome.err = read_file(streams.path() / "err");
    return outcome;
}

inline std::string shipped(const std::string& name) {
    return (std::filesystem::absolute(environment("PERCUSS_SOURCE_DIR", ".")) / "problems" / name).string();
}

/// The folder in results/ that a run without --out has left: its name, and six digits of the problem's hash behind it
/// where options changed the problem. Fails where there is none, or more than one.
inline std::filesystem::path results_of(const ScratchFolder& folder, const std::string& name) {
    std::vector<std::filesystem::path> found;
    const std::filesystem::path all = folder.path() / "results";
    if (std::filesystem::exists(all)) {
        for (const auto& entry : std::filesystem::directory_iterator(all)) {
            const std::string own = entry.path().filename().string();
            const bool with_hash = own.size() == name.size() + 7 && own.starts_with(name + "-");
            if (own == name || with_hash) { found.push_back(entry.path()); }
        }
    }
    if (found.size() != 1) { throw std::runtime_error(std::to_string(found.size()) + " results folders of " + name); }
    return found.front();
}

inline long lines(const std::string& text) { return std::count(text.begin(), text.end(), '\n'); }

inline bool has(const std::string& text, const std::string& part) { return text.find(part) != std::string::npos; }

}  // namespace percuss::tests
