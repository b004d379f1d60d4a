#pragma once
/// \file
/// What a results folder says of itself.

#include "problem/problem_file.hpp"

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace percuss::results {

/// How far the run that writes a folder has come.
enum class RunState : std::uint8_t { started, finished, interrupted };

struct Manifest {
    std::string verb;
    std::string problem;  ///< name of the problem
    std::string hash;     ///< of the problem as resolved
    RunState state = RunState::started;
    std::vector<std::string> files;  ///< that the run has written or will write
};

/// What else there is to say about a run when its manifest is written.
struct RunRecord {
    std::string instruction_set;  ///< that the kernels use
    std::string ending;           ///< "verified", "infeasible", ...; empty while running
    std::string started;          ///< time stamps, ISO 8601 UTC
    std::string finished;
};

/// manifest.json: percuss/manifest/1 with program version, compiler, instruction set, seed, the problem as resolved
/// and its hash.
std::string manifest_document(const Manifest& manifest, const problem::ProblemFile& problem, const RunRecord& record);

/// The manifest of a folder, or nothing if the folder has none that percuss wrote.
std::optional<Manifest> read_manifest(const std::filesystem::path& folder);

/// Current time as ISO 8601 UTC.
std::string time_stamp();

}  // namespace percuss::results
