#pragma once
/// \file
/// From a problem file and options to a problem that can be studied.

#include "model/specification.hpp"
#include "verbs/attractors/attractors.hpp"
#include "verbs/branch/branch.hpp"
#include "verbs/locus/locus.hpp"
#include "verbs/orbit/orbit.hpp"
#include "verbs/settings.hpp"
#include "verbs/simulate/simulate.hpp"
#include "verbs/study.hpp"
#include "verbs/sweep/sweep.hpp"

#include <cstdint>
#include <filesystem>
#include <limits>
#include <span>
#include <string>
#include <vector>

namespace percuss::verbs {

enum class Origin : std::uint8_t { file, option, fallback };

/// One key of the problem as it is used.
struct ResolvedSetting {
    std::string name;
    double value = std::numeric_limits<double>::quiet_NaN();  ///< SI or nondimensional; NaN for text
    std::string unit;                                         ///< of the value; empty for pure numbers and text
    std::string text;                                         ///< for people
    Origin origin = Origin::file;
    std::string trouble;  ///< what is wrong with it, empty if nothing is
};

struct ProblemFile {
    std::string name;  ///< file name without folder and ending
    verbs::StudyProblem study;
    verbs::OrbitOptions orbit;
    verbs::SimulateOptions simulate;
    verbs::SweepOptions sweep;
    verbs::BranchOptions branch;
    verbs::LocusOptions locus;
    verbs::AttractorsOptions attractors;
    std::vector<ResolvedSetting> settings;  ///< every key in force, section by section
    std::vector<std::string> troubles;      ///< all that is wrong; always empty from read_problem
};

/// Whether a verb runs the actuator at its drive frequency or over a range of its own: only the first needs a frequency
/// or an edge.
enum class FrequencyUse : std::uint8_t { operates, ranges };

/// Reads a file, lets options win, and checks everything that can be checked without computing. Throws ProblemError
/// with one sentence that names key, value and what is allowed.
ProblemFile read_problem(const std::filesystem::path& file, std::span<const Setting> options,
                         FrequencyUse use = FrequencyUse::operates);

/// The same, but what is missing, out of range or not understood is collected in `troubles` and marked at the
/// settings. Throws ProblemError only when the file cannot be read or its lines are not settings.
ProblemFile inspect_problem(const std::filesystem::path& file, std::span<const Setting> options);

/// Throw ProblemError when the problem lacks what a verb needs: a drive frequency; variables and one objective.
void require_frequency(const ProblemFile& problem);
void require_one_objective(const ProblemFile& problem);
/// Both ends of the range, and for a locus the key.
void require_branch_range(const ProblemFile& problem);
void require_locus_range(const ProblemFile& problem);

/// Number of entries of a state.
int problem_states(const ProblemFile& problem);

/// Identifies the resolved problem: FNV-1a (64 bit) over its settings in force, 16 hexadecimal digits.
std::string problem_hash(const ProblemFile& problem);

/// "si" or "nondimensional".
std::string_view units_of(const ProblemFile& problem);

/// A value of this quantity or key for people, with unit unless the problem is nondimensional.
std::string text_of(const ProblemFile& problem, design::Quantity quantity, double value);
std::string text_of(model::Key key, double value);

}  // namespace percuss::verbs
