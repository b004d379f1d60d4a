#pragma once
/// \file

#include <span>
#include <string>

namespace percuss::cli {

/// The whole program: arguments (without its name) to exit code. Prints; what goes wrong becomes one line on stderr.
int run(std::span<const std::string> arguments);

}  // namespace percuss::cli
