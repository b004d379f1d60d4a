#pragma once
/// \file
/// Verb `orbit`.
#include "verbs/study.hpp"
#include <optional>

namespace percuss::verbs {

struct OrbitOptions {
    std::optional<std::vector<double>> start;  ///< state at theta = 0 in the problem's units
    int period = 1;                            ///< drive cycles
    bool gradients = false;
};
struct OrbitResult {
    Ending ending = Ending::not_run;
    design::Evaluation evaluation;
    double seconds = 0.0;
};
/// Throws std::invalid_argument when no drive frequency is given.
OrbitResult run_orbit(const StudyProblem& problem, const OrbitOptions& study,
                      const numerics::CancelRequest& cancelled = {});

}  // namespace percuss::verbs
