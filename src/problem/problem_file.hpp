#pragma once
/// \file
/// From a problem file and options to a problem that can be studied.

#include "design/problem.hpp"
#include "problem/row.hpp"
#include "problem/sections.hpp"
#include "problem/setting.hpp"

#include <cstdint>
#include <filesystem>
#include <limits>
#include <map>
#include <memory>
#include <span>
#include <string>
#include <typeindex>
#include <vector>

namespace percuss::problem {

enum class Origin : std::uint8_t { file, option, fallback };
std::string_view to_string(Origin origin);

/// One key of the problem as it is used.
struct ResolvedSetting {
    std::string name;
    double value = std::numeric_limits<double>::quiet_NaN();  ///< SI or nondimensional; NaN for text
    std::string unit;                                         ///< of the value; empty for pure numbers and text
    std::string text;                                         ///< for people
    Origin origin = Origin::file;
    std::string trouble;      ///< what is wrong with it, empty if nothing is
    std::string exact;        ///< for the hash where the text is rounded
    bool repeatable = false;  ///< one entry of a list
};

struct ProblemFile {
    std::string name;  ///< file name without folder and ending
    design::Problem design;
    std::vector<ResolvedSetting> settings;  ///< every key in force, section by section
    std::vector<std::string> troubles;      ///< all that is wrong; always empty from read_problem

    /// The options of a section that was read with the problem. Throws std::logic_error for others.
    template <class Options>
    [[nodiscard]] const Options& get() const {
        return *static_cast<const Options*>(find(typeid(Options)));
    }
    [[nodiscard]] const void* find(std::type_index type) const;

    std::map<std::type_index, std::shared_ptr<void>> options;  ///< by the type of the struct
};

/// Whether the actuator is run at its drive frequency or over a range of its own: only the first needs a frequency or
/// an edge.
enum class FrequencyUse : std::uint8_t { operates, ranges };

/// Reads a file, lets options win, and checks everything that can be checked without computing. The keys known are
/// those of `sections`, which begin with the actuator's. Throws ProblemError with one sentence that names key, value
/// and what is allowed.
ProblemFile read_problem(const std::filesystem::path& file, std::span<const Setting> options,
                         std::span<const Section> sections, FrequencyUse use = FrequencyUse::operates);

/// The same, but what is missing, out of range or not understood is collected in `troubles` and marked at the
/// settings. Throws ProblemError only when the file cannot be read or its lines are not settings.
ProblemFile inspect_problem(const std::filesystem::path& file, std::span<const Setting> options,
                            std::span<const Section> sections);

/// Number of entries of a state.
int problem_states(const ProblemFile& problem);

/// Identifies the resolved problem: FNV-1a (64 bit) over its settings in force, 16 hexadecimal digits.
std::string problem_hash(const ProblemFile& problem);

bool is_nondimensional(const design::Problem& problem);

/// "si" or "nondimensional".
std::string_view units_of(const ProblemFile& problem);

/// A value of this quantity for people, with unit unless the problem is nondimensional.
std::string text_of(const ProblemFile& problem, design::Quantity quantity, double value);

}  // namespace percuss::problem
