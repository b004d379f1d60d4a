#pragma once
/// \file
/// The problem files that come with the program.

#include "verbs/verbs.hpp"

#include <cstdlib>
#include <filesystem>
#include <string>

namespace percuss::test {

inline verbs::StudyProblem shipped_problem(const std::string& name) {
    const char* source = std::getenv("PERCUSS_SOURCE_DIR");
    const std::filesystem::path root = source == nullptr ? "." : source;
    return verbs::study_problem(verbs::read_problem(root / "problems" / (name + ".ini"), {}));
}

}  // namespace percuss::test
