#pragma once
/// \file
/// Problem files and command lines taken apart into settings. One description of the keys serves both.

#include "problem/row.hpp"
#include "problem/setting.hpp"

#include <filesystem>
#include <span>
#include <string>
#include <vector>

namespace percuss::problem {

/// The settings of an INI file in the order of the file; # and ; begin a comment. Throws ProblemError for a file that
/// cannot be read, a line that is neither section, assignment nor comment, an unknown key (the nearest known one is
/// named) and a key that is given twice without being repeatable.
std::vector<Setting> read_settings(const std::filesystem::path& file, std::span<const Section> sections);

/// Splits command-line arguments (without the program's name and the verb). Throws ProblemError for unknown options
/// (the nearest known one is named), missing values and options given twice without being repeatable.
CommandLine parse_command_line(std::span<const std::string> arguments, std::span<const RunOption> run_options,
                               std::span<const Section> sections);

/// Whether a repeatable setting empties its list: "none".
bool clears_list(const Setting& setting);

/// File settings with those given as options put in their place. An option replaces the line of the file with the same
/// key (drive.frequency and spring-mass.omega count as one); of a repeatable key, the entry about the same quantity or
/// key, else it is added; "none" empties the list first.
std::vector<Setting> merge_settings(std::span<const Setting> file, std::span<const Setting> options,
                                    std::span<const Section> sections);

}  // namespace percuss::problem
