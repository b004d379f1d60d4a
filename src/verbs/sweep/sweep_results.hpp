#pragma once
/// \file
/// Results of verb `sweep`.

#include "problem/problem_file.hpp"
#include "results/presentation.hpp"
#include "verbs/sweep/sweep.hpp"

#include <string>
#include <string_view>

namespace percuss::verbs {

/// percuss/sweep/1: {"schema","units","status":"done|failed|stopped","reason","mode":"steps|chirp","from":{"omega",
/// "drive_frequency"},"to","settled":{rule in words, "tolerance","max_cycles","longest_period"},"directions":
/// [{"direction":"forward|backward","points":[{"omega","drive_frequency","cycles","settled","period","strobed_change",
/// "remaining_error","amplitude","x_max","x_min","peak_force","contacts","state"}],"jumps":[{"between":[omega, omega],
/// "drive_frequencies":[f, f],"changes":["period","contacts","amplitude","peak_force"],"discontinuous"}]}],
/// "comparison":{"coincide","compared","different","unsettled","tolerance","largest_difference","ranges":[[omega,
/// omega]]} (steps),"cost"}. Frequencies in the order in which they were passed.
std::string sweep_document(const problem::ProblemFile& problem, const SweepResult& result);

results::Presentation present_sweep(const problem::ProblemFile& problem, const SweepResult& result);

/// The word for how it ended: "status" of the document.
std::string_view status_of(const SweepResult& result);

}  // namespace percuss::verbs
