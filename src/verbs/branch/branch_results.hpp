#pragma once
/// \file
/// Results of verbs `branch` and `locus`.

#include "verbs/branch/branch.hpp"
#include "verbs/locus/locus.hpp"
#include "verbs/presentation.hpp"
#include "verbs/problem_file.hpp"

#include <string>

namespace percuss::verbs {

/// percuss/branch/1. Beyond the contract: "along", "from", "to", per branch "from_branch", "begin" and "end" (how it
/// ends on either side: range | joined | closed | lost | budget) with reasons, per point "value" when along a key; per
/// boundary "uncertainty" (of omega or the value), "max_multiplier", "contacts", "jump" (number of the physical jump it
/// belongs to with its neighbour), "symmetry" (a flip of the half-cycle map: the mirror symmetry is lost), "gradients";
/// "jumps":
/// [{"boundaries":[i, j],"distance"}]; "cost".
std::string branch_document(const ProblemFile& problem, const verbs::BranchResult& result);
Presentation present_branch(const ProblemFile& problem, const verbs::BranchResult& result);
/// One row per point; one row per boundary.
std::string branch_csv(const ProblemFile& problem, const verbs::BranchResult& result);
std::string boundaries_csv(const ProblemFile& problem, const verbs::BranchResult& result);

/// percuss/locus/1. Points of all curves in order, each with its "curve"; "cusps", and "turns" where the value turns
/// back without a cusp; "curves": how each ends.
std::string locus_document(const ProblemFile& problem, const verbs::LocusResult& result);
Presentation present_locus(const ProblemFile& problem, const verbs::LocusResult& result);
std::string locus_csv(const ProblemFile& problem, const verbs::LocusResult& result);

}  // namespace percuss::verbs
