#pragma once
/// \file

#include <string>
#include <string_view>

namespace percuss::cli {

/// What `percuss --help` prints.
std::string general_help();

/// What `percuss VERB --help` prints: options, then every key with unit, range, default and meaning.
std::string verb_help(std::string_view verb);

}  // namespace percuss::cli
