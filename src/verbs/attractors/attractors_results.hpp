#pragma once
/// \file
/// Results of verb `attractors`.

#include "problem/problem_file.hpp"
#include "results/presentation.hpp"
#include "verbs/attractors/attractors.hpp"

#include <string>
#include <string_view>

namespace percuss::verbs {

/// percuss/attractors/1: {"schema","units","status":"done|unclassified|stopped|no-impact|failed","reason",
/// "operating_point":{"drive_frequency","omega","edge_kind","edge_omega","margin"},"starts","seed","unclassified",
/// "failed","missed_share_bound","box":{"lower":[],"upper":[]},"attractors":[{"kind":"periodic|chaotic|quasi-periodic|
/// undecided","period" (0: aperiodic),"state":[],"peak_force","amplitude","x_max","x_min","contacts" (per period; null:
/// aperiodic),"contacts_per_cycle","multipliers":[[re,im]],"max_multiplier","lyapunov":{"value","error"} per drive
/// cycle,"lyapunov_per_time":{"value","error"} per second (nondimensional problems: per unit of
/// time),"starts","share","share_lower","share_upper"}], "cost":{"seconds","periods"}}
std::string attractors_document(const problem::ProblemFile& problem, const AttractorsResult& result);

/// One row per motion.
std::string attractors_csv(const problem::ProblemFile& problem, const AttractorsResult& result);

results::Presentation present_attractors(const problem::ProblemFile& problem, const AttractorsResult& result);

/// The word for how it ended: "status" of the document.
std::string_view status_of(const AttractorsResult& result);

}  // namespace percuss::verbs
