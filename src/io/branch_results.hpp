#pragma once
/// \file
/// Results of verbs `branch` and `locus`.

#include "io/presentation.hpp"
#include "io/problem_file.hpp"
#include "study/branch.hpp"
#include "study/locus.hpp"

#include <string>

namespace percuss::io {

/// percuss/branch/1. Beyond the contract: "along", "from", "to", per branch "from_branch", "begin" and "end" (how it
/// ends on either side: range | joined | closed | lost | budget) with reasons, per point "value" when along a key; per
/// boundary "uncertainty" (of omega or the value), "max_multiplier", "contacts", "jump" (number of the physical jump it
/// belongs to with its neighbour), "symmetry" (a flip of the half-cycle map: the mirror symmetry is lost), "gradients";
/// "jumps":
/// [{"boundaries":[i, j],"distance"}]; "cost".
std::string branch_document(const ProblemFile& problem, const study::BranchStudyResult& result);
Presentation present_branch(const ProblemFile& problem, const study::BranchStudyResult& result);
/// One row per point; one row per boundary.
std::string branch_csv(const ProblemFile& problem, const study::BranchStudyResult& result);
std::string boundaries_csv(const ProblemFile& problem, const study::BranchStudyResult& result);

/// percuss/locus/1. Points of all curves in order, each with its "curve"; "cusps", and "turns" where the value turns
/// back without a cusp; "curves": how each ends.
std::string locus_document(const ProblemFile& problem, const study::LocusStudyResult& result);
Presentation present_locus(const ProblemFile& problem, const study::LocusStudyResult& result);
std::string locus_csv(const ProblemFile& problem, const study::LocusStudyResult& result);

}  // namespace percuss::io
