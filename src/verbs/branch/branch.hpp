#pragma once
/// \file
/// Verb `branch`: the hysteresis map. The motion at one end of the range followed to the other, all boundaries, and on
/// request subharmonic branches.
#include "branch/branch.hpp"
#include "verbs/study.hpp"

#include <optional>

namespace percuss::verbs {

struct BranchOptions {
    std::optional<model::Key> along;  ///< a key; absent: the drive frequency
    std::optional<double> from;       ///< in the key's unit (Hz, or the nondimensional omega)
    std::optional<double> to;
    int period = 1;         ///< also motions of up to this many drive cycles
    int starts = 64;        ///< of the search for them, per frequency looked at
    int max_points = 2000;  ///< per branch
    bool gradients = false;
};

/// What a boundary depends on: d(parameter)/d(key) for the keys of the result.
struct BoundaryGradient {
    std::vector<double> d_parameter;
};

struct BranchResult {
    Ending ending = Ending::not_run;
    std::string reason;  ///< one sentence unless verified
    bool along_frequency = true;
    model::Key along{};  ///< the key that was varied
    double from = 0.0;   ///< in its unit
    double to = 0.0;
    std::vector<branch::Branch> branches;  ///< nondimensional; the parameter is omega or the key's value
    std::vector<model::Key> gradient_keys;
    std::vector<std::vector<BoundaryGradient>> gradients;  ///< per branch and boundary
    long solves = 0;                                       ///< orbits and boundaries solved for
    double periods = 0.0;
    double seconds = 0.0;
};

/// Columns of the rows: branch, period, omega, drive_frequency, value, amplitude, x_max, x_min, peak_force, contacts,
/// max_multiplier, stable.
BranchResult run_branch(const StudyProblem& problem, const BranchOptions& study, const Observer& observer,
                        const StopRequest& stop);

/// Scales at a point of the result, which depend on the key that is varied.
model::Scales scales_at(const design::Problem& problem, const BranchResult& result, double parameter);

}  // namespace percuss::verbs
