#pragma once
/// \file
/// Results of verb `optimise`.

#include "problem/problem_file.hpp"
#include "results/presentation.hpp"
#include "verbs/optimise/optimise.hpp"

#include <string>

namespace percuss::verbs {

/// percuss/optimise/1
std::string optimise_document(const problem::ProblemFile& problem, const OptimiseStudyResult& result);

results::Presentation present_optimum(const problem::ProblemFile& problem, const OptimiseStudyResult& result);

/// One row per value of the enumerated variable.
std::string layers_csv(const problem::ProblemFile& problem, const OptimiseStudyResult& result);

/// One row per limit, with value and multiplier; SI or nondimensional.
std::string limits_csv(const problem::ProblemFile& problem, const OptimiseStudyResult& result);

}  // namespace percuss::verbs
