#pragma once
/// \file
/// The command line taken apart.

#include "verbs/settings.hpp"

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace percuss::cli {

struct VerbInfo {
    std::string_view name;
    std::string_view summary;
    bool available;  ///< in this version
};

/// Every verb, in the order of a typical session.
std::span<const VerbInfo> verbs();

/// What an option of the command line does; keys of problem files aside.
struct OptionInfo {
    std::string_view name;
    std::string_view value;  ///< placeholder; empty for a flag
    std::string_view meaning;
    std::string_view only_for;  ///< verbs that take it, separated by blanks; empty: all
};

std::span<const OptionInfo> run_options();

struct Arguments {
    std::string verb;     ///< canonical spelling; empty for --help and --version alone
    std::string problem;  ///< problem file
    std::vector<verbs::Setting> keys;
    std::optional<std::string> out;
    std::optional<int> jobs;
    std::optional<std::uint64_t> seed;
    std::optional<double> time_limit;  ///< s
    bool help = false;
    bool version = false;
    bool json = false;
    bool quiet = false;
    bool force = false;
    bool gradients = false;
};

/// Arguments without the program's name. Throws problem::ProblemError with one sentence for a wrong usage.
Arguments parse_arguments(std::span<const std::string> arguments);

}  // namespace percuss::cli
