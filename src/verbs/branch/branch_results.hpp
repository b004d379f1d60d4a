#pragma once
/// \file
/// Results of verb `branch`.

#include "problem/problem_file.hpp"
#include "results/presentation.hpp"
#include "verbs/branch/branch.hpp"

#include <string>

namespace percuss::verbs {

/// percuss/branch/1. Beyond the contract: "along", "from", "to", per branch "from_branch", "begin" and "end" (how it
/// ends on either side: range | joined | closed | lost | budget) with reasons, per point "value" when along a key; per
/// boundary "uncertainty" (of omega or the value), "max_multiplier", "contacts", "jump" (number of the physical jump it
/// belongs to with its neighbour), "symmetry" (a flip of the half-cycle map: the mirror symmetry is lost), "gradients";
/// "jumps":
/// [{"boundaries":[i, j],"distance"}]; "cost".
std::string branch_document(const problem::ProblemFile& problem, const BranchResult& result);
results::Presentation present_branch(const problem::ProblemFile& problem, const BranchResult& result);
/// One row per point; one row per boundary.
std::string branch_csv(const problem::ProblemFile& problem, const BranchResult& result);
std::string boundaries_csv(const problem::ProblemFile& problem, const BranchResult& result);

}  // namespace percuss::verbs
