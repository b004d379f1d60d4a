#pragma once
/// \file
/// Results of verb `simulate`.

#include "problem/problem_file.hpp"
#include "results/presentation.hpp"
#include "verbs/simulate/simulate.hpp"

#include <string>
#include <string_view>

namespace percuss::verbs {

/// percuss/simulate/1: {"schema","units","status":"done|no-impact|failed|stopped","reason","operating_point":
/// {"drive_frequency","omega","edge_kind","edge_omega","margin"},"start":{"from":"rest|orbit|state","state"},"cycles",
/// "samples","end_state","contacts","peak_force" (of the series),"kick":{"text","kind":"velocity|drive","at","velocity"
/// or "share" and "cycles"} or null,"before":MOTION or null,"after":MOTION or null,"outcome":"none|recovered|fell|rose|
/// undecided","cost"}; MOTION: {"settled","period","contacts","cycles","strobed_change","remaining_error","polished",
/// "max_multiplier","amplitude","x_max","x_min","peak_force","state"}, before also "change_at_kick".
std::string simulate_document(const problem::ProblemFile& problem, const SimulateResult& result);

results::Presentation present_simulation(const problem::ProblemFile& problem, const SimulateResult& result);

/// The word for how it ended: "status" of the document.
std::string_view status_of(const SimulateResult& result);

}  // namespace percuss::verbs
