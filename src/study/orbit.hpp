#pragma once
/// \file
/// Verb `orbit`.
#include "study/study.hpp"
#include <optional>

namespace percuss::study {

struct OrbitStudy {
    std::optional<std::vector<double>> start;  ///< state at theta = 0 in the problem's units
    int period = 1;                            ///< drive cycles
    bool gradients = false;
};
struct OrbitStudyResult {
    Ending ending = Ending::not_run;
    design::Evaluation evaluation;
    double seconds = 0.0;
};
/// Throws std::invalid_argument when no drive frequency is given.
OrbitStudyResult run_orbit(const StudyProblem& problem, const OrbitStudy& study);

}  // namespace percuss::study
