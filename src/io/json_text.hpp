#pragma once
/// \file
/// What all JSON documents have in common. The JSON library comes with it: for .cpp files of this folder only.

#include "io/problem_file.hpp"

#include <string>
#include <string_view>

#include <nlohmann/json.hpp>

namespace percuss::io {

using Json = nlohmann::ordered_json;  // prints NaN as null and numbers so that they read back exactly

/// {"schema","units"}
inline Json beginning(const ProblemFile& problem, std::string_view schema) {
    return {{"schema", schema}, {"units", units_of(problem)}};
}

inline std::string printed(const Json& document) {
    constexpr int indentation = 2;
    return document.dump(indentation, ' ', false, Json::error_handler_t::replace) + "\n";
}

}  // namespace percuss::io
