#pragma once
/// \file
/// Tiers 2 and 3 of the uniqueness check in an optimisation: the best design looked at by starts, and counterexamples
/// made constraints until no start refutes it.

#include "numerics/cancel.hpp"
#include "verbs/optimise/case_solver.hpp"
#include "verbs/optimise/integer_case.hpp"
#include "verbs/optimise/optimise.hpp"

#include <vector>

namespace percuss::verbs {

struct Refutation {
    std::vector<Counterexample> counterexamples;
    double objective_unrefuted = design::absent;  ///< of the best design before the first counterexample
};

/// Looks at the best of the certified cases by starts. A counterexample, at tier 3, becomes a constraint of that case:
/// stay out of the window in which the other motion exists, below it or above it, whichever is better; the case is
/// solved again, and the then best case looked at, up to 12 times. A case that is refuted for good, or whose uniqueness
/// could not be decided, is left not_certified with its reason. Ends early when cancelled.
Refutation refute(std::vector<IntegerCase>& cases, CaseSolver& solver, const StudyProblem& problem,
                  const Observer& observer, const numerics::CancelRequest& cancelled);

}  // namespace percuss::verbs
