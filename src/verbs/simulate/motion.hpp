#pragma once
/// \file
/// The motion that a state leads to, followed until it settles and then solved for.

#include "flow/flow.hpp"
#include "model/specification.hpp"
#include "orbit/settling.hpp"
#include "verbs/study.hpp"

#include <vector>

namespace percuss::verbs {

/// A motion in the problem's units.
struct Motion {
    bool settled = false;
    int period = 0;                           ///< drive cycles; 0 unless settled
    int contacts = 0;                         ///< per period; in 12 cycles unless settled
    int cycles = 0;                           ///< drive cycles followed, beyond the series, until it settled
    double strobed_change = design::absent;   ///< relative, when it settled
    double remaining_error = design::absent;  ///< relative, of the state; of the polished one: its Newton step
    bool polished = false;                    ///< solved for by Newton's method; what follows is of that orbit
    double max_multiplier = design::absent;   ///< of the orbit
    double amplitude = design::absent;
    double x_max = design::absent;
    double x_min = design::absent;
    double peak_force = design::absent;
    std::vector<double> state;                    ///< at theta = 0
    flow::State own_state{};                      ///< the same, nondimensional
    flow::Status status = flow::Status::not_run;  ///< of the flow
};

/// Follows the motion from `start` at phase 0 until it repeats, and polishes it where that converges to an orbit that
/// stands where the motion settled.
Motion identify_motion(const flow::System& system, const flow::State& start, const model::Scales& scales);

/// Whether two settled motions are the same one, one perhaps some cycles later.
bool same_motion(const flow::System& system, const Motion& a, const Motion& b);

}  // namespace percuss::verbs
