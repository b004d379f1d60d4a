#pragma once
/// \file
/// The problem files that come with the program.

#include "verbs/problem_file.hpp"

#include <cstdlib>
#include <filesystem>
#include <string>

namespace percuss::test {

inline verbs::StudyProblem shipped_problem(const std::string& name) {
    const char* source = std::getenv("PERCUSS_SOURCE_DIR");
    const std::filesystem::path root = source == nullptr ? "." : source;
    return verbs::read_problem(root / "problems" / (name + ".ini"), {}).study;
}

}  // namespace percuss::test
