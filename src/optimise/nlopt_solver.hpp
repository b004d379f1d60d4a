#pragma once
/// \file
/// Adapter to NLopt.

#include "optimise/guard.hpp"
#include "optimise/result.hpp"
#include "optimise/solver_answer.hpp"

#include <string>
#include <vector>

namespace percuss::optimise {

struct NloptMethod {
    std::string name;
    int algorithm;              ///< nlopt_algorithm when there are no constraints
    int constrained_algorithm;  ///< and with constraints, or -1: none of its own, augmented Lagrangian around it
    bool global;
    bool gradient;  ///< asks for gradients
};

/// The methods of NLopt that are offered, local ones first.
[[nodiscard]] const std::vector<NloptMethod>& nlopt_methods();

/// One run of NLopt (Johnson, version 2.7) from a start within the bounds, without polish. A failed evaluation is seen
/// by NLopt as `failure_penalty` with zero gradient and every constraint violated by 1. Stops by its own tolerance,
/// after the guard's evaluations, or when the guard halts. The random numbers are seeded here, in this thread.
///
/// Throws std::invalid_argument when `method` needs finite bounds or has a limit on sizes; std::runtime_error when the
/// linked NLopt was built without it. Errors of the evaluator wait in the guard.
[[nodiscard]] SolverAnswer run_nlopt(Guard& guard, const Vector& start, const NloptMethod& method,
                                     const Options& options);

}  // namespace percuss::optimise
