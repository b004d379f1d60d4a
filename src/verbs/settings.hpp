#pragma once
/// \file
/// Key-value pairs as they are written in problem files and on the command line, not yet interpreted. One description
/// of the keys serves both.

#include "problem/problem_error.hpp"

#include <filesystem>
#include <span>
#include <string>
#include <vector>

namespace percuss::verbs {

using problem::ProblemError;

/// One "key = value" of a file or "--key value" of the command line.
struct Setting {
    std::string key;
    std::string value;
    bool from_option = false;
};

/// How the setting was written, for messages: "stop.gap = 5 kg" or "--stop.gap '5 kg'".
std::string as_written(const Setting& setting);

/// An option of the command line that is not a key of problem files.
struct RunOption {
    std::string name;
    bool takes_value = false;
};

struct CommandLine {
    std::vector<Setting> keys;         ///< options that are keys of problem files, in the order given
    std::vector<Setting> run_options;  ///< the others; flags have an empty value
    std::vector<std::string> positional;
};

/// The settings of an INI file in the order of the file. Throws ProblemError for a file that cannot be read, a line
/// that is neither section, assignment nor comment, an unknown key (the nearest known one is named) and a key that is
/// given twice without being repeatable.
std::vector<Setting> read_settings(const std::filesystem::path& file);

/// Splits command-line arguments (without the program's name and the verb). Throws ProblemError for unknown options
/// (the nearest known one is named), missing values and options given twice without being repeatable.
CommandLine parse_command_line(std::span<const std::string> arguments, std::span<const RunOption> run_options);

/// File settings with those given as options put in their place: an option replaces every line of the file with the
/// same key. drive.frequency and spring-mass.omega count as the same key here.
std::vector<Setting> merge_settings(std::span<const Setting> file, std::span<const Setting> options);

}  // namespace percuss::verbs
