#pragma once
/// \file
/// The table of verbs: all that the command line needs to know of each.

#include "problem/reading.hpp"
#include "verbs/session.hpp"

#include <filesystem>
#include <span>
#include <string_view>
#include <vector>

namespace percuss::verbs {

/// An option of one verb that is not a key of problem files; most stand for one.
struct VerbOption {
    std::string_view name;
    std::string_view value;  ///< placeholder; empty for a flag
    std::string_view meaning;
    std::string_view key;          ///< that it stands for; empty: none
    std::string_view key_value{};  ///< given to the key by a flag
};

struct Verb {
    std::string_view name;
    std::string_view summary;
    std::vector<VerbOption> options;
    /// Sections of problem files that the verb reads besides those that describe the actuator and the solver.
    std::vector<std::string_view> sections;
    Outcome (*run)(Session&) = nullptr;  ///< null: not in this version
    problem::FrequencyUse frequency = problem::FrequencyUse::operates;
    bool inspects = false;  ///< reads problems with troubles as well, and writes no folder
};

/// Every verb, in the order of a typical session.
std::span<const Verb> verbs();

/// The verb of this name or of another spelling of it ("optimize"). Throws problem::ProblemError that names the nearest
/// one, and for verbs that are not in this version.
const Verb& find_verb(std::string_view word);

/// The rows of all keys that a problem file may have, whichever verb reads it.
std::span<const problem::Section> sections();

/// Whether a verb reads a key.
bool reads(const Verb& verb, const problem::Row& row);

/// The problem as the runs of verbs take it.
StudyProblem study_problem(const problem::ProblemFile& problem);

/// problem::read_problem and problem::inspect_problem with the keys of all verbs.
problem::ProblemFile read_problem(const std::filesystem::path& file, std::span<const problem::Setting> options,
                                  problem::FrequencyUse use = problem::FrequencyUse::operates);
problem::ProblemFile inspect_problem(const std::filesystem::path& file, std::span<const problem::Setting> options);

}  // namespace percuss::verbs
