#pragma once
/// \file
/// Frequency sweeps in the time domain: steps with settling in between, the way Wu, Cai, Gao, Cao, Appl. Syst. Innov.
/// 2022, 5, 122 (section 3) and most test rigs do it, and a continuous chirp. They see one motion at a time, the one
/// they are on.

#include "orbit/settling.hpp"

#include <functional>
#include <span>
#include <vector>

namespace percuss::orbit {

struct SweptPoint {
    double omega = 0.0;
    Settling settling;
    Extremes extremes;  ///< over one period, or over longest_period cycles where the motion has not settled
};

/// Steps through the frequencies in the order given, the first from `start`, each further one from the strobed state
/// (phase 0) of the one before. Ends early when the flow is lost, whose point then carries the status, or when
/// `on_point` (may be empty) returns false. Throws std::invalid_argument for options out of range.
std::vector<SweptPoint> step_sweep(const flow::System& system, std::span<const double> omegas, const flow::State& start,
                                   const SettlingOptions& options,
                                   const std::function<bool(const SweptPoint&)>& on_point = {});

/// One drive cycle of a chirp.
struct ChirpCycle {
    double omega = 0.0;
    Extremes extremes;
};

/// A chirp of `cycles` drive cycles whose frequency goes from one value to another at a constant rate in time. The
/// drive phase is continuous and the frequency is constant over each cycle: it changes at theta = 2 pi k, to the value
/// that a chirp with d(omega)/d(tau) constant has in the middle of the cycle, omega^2 = from^2 + (to^2 - from^2)
/// (k + 1/2)/cycles. Starts at phase 0 from `start`; ends early like step_sweep.
std::vector<ChirpCycle> chirp(const flow::System& system, double from, double to, int cycles, const flow::State& start,
                              const std::function<bool(const ChirpCycle&)>& on_cycle = {});

}  // namespace percuss::orbit
