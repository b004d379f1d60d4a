#pragma once
/// \file
/// Key-value pairs as they are written in problem files and on the command line, not yet interpreted. One description
/// of the keys serves both.

#include "problem/problem_error.hpp"

#include <string>
#include <vector>

namespace percuss::problem {

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

/// The message of a value that cannot be used: "stop.gap = 5 kg: why".
inline ProblemError bad_value(const Setting& setting, const std::string& why) {
    return ProblemError(as_written(setting) + ": " + why);
}

}  // namespace percuss::problem
