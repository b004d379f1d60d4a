#pragma once
/// \file

#include "problem/problem_file.hpp"

#include <string>
#include <vector>

namespace percuss::verbs {

struct DerivedParameter {
    std::string name;  ///< "Gamma", "k"
    double value = 0.0;
    std::string unit;  ///< empty for pure numbers
    std::string meaning;
};

/// What the solver makes of the problem: units of length, time and force, and the nondimensional parameters. Empty
/// while the problem has troubles.
std::vector<DerivedParameter> derived_parameters(const problem::ProblemFile& problem);

}  // namespace percuss::verbs
