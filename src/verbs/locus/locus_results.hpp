#pragma once
/// \file
/// Results of verb `locus`.

#include "problem/problem_file.hpp"
#include "results/presentation.hpp"
#include "verbs/locus/locus.hpp"

#include <string>

namespace percuss::verbs {

/// percuss/locus/1. Points of all curves in order, each with its "curve"; "cusps", and "turns" where the value turns
/// back without a cusp; "curves": how each ends.
std::string locus_document(const problem::ProblemFile& problem, const LocusResult& result);
results::Presentation present_locus(const problem::ProblemFile& problem, const LocusResult& result);
std::string locus_csv(const problem::ProblemFile& problem, const LocusResult& result);

}  // namespace percuss::verbs
