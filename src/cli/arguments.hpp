#pragma once
/// \file
/// The command line taken apart.

#include "verbs/verbs.hpp"

#include <optional>
#include <span>
#include <string>
#include <string_view>

namespace percuss::cli {

/// An option that every verb takes.
struct CommonOption {
    std::string_view name;
    std::string_view value;  ///< placeholder; empty for a flag
    std::string_view meaning;
};

std::span<const CommonOption> common_options();

/// What help is asked for.
enum class Topic : std::uint8_t { none, general, verb, keys, quantities };

struct Arguments {
    const verbs::Verb* verb = nullptr;  ///< null for --help and --version alone
    verbs::RunSettings run;
    std::optional<double> time_limit;  ///< s
    Topic help = Topic::none;
    bool version = false;
    bool json = false;
    bool quiet = false;
};

/// Arguments without the program's name. Throws problem::ProblemError with one sentence for a wrong usage.
Arguments parse_arguments(std::span<const std::string> arguments);

}  // namespace percuss::cli
