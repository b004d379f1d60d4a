#pragma once
/// \file
/// Letting a motion settle by following it, cycle by cycle, until its strobed state repeats.

#include "flow/flow.hpp"

#include <cstdint>
#include <optional>

namespace percuss::orbit {

/// What must fall below the tolerance before a motion counts as settled.
enum class SettlingRule : std::uint8_t {
    strobed_change,  ///< the change itself, the rule usual in practice: with a multiplier rho it stops change
                     ///< rho/(1-rho) short of the orbit, and a slow passage passes for an orbit
    remaining_error,  ///< the change, and the error that remains, change rho/(1-rho) with the contraction rho observed
};

struct SettlingOptions {
    double tolerance = 1e-8;  ///< relative to 1 + |y|, above 1e-12
    SettlingRule rule = SettlingRule::remaining_error;
    int max_cycles = 500;
    int longest_period = 12;            ///< repeats after up to so many drive cycles are recognised, at most 12
    int max_events = 1024;              ///< contact events in one drive cycle
    long max_steps_per_cycle = 200000;  ///< of the integrator
};

/// What became of a motion that was followed. y_n is the state at theta = 2 pi n, |.| the Euclidean norm of the
/// nondimensional state.
struct Settling {
    flow::Status status = flow::Status::not_run;  ///< of the flow; anything but ok: the motion was lost
    bool settled = false;
    int period = 0;       ///< drive cycles after which it repeats; 0 unless settled
    int cycles = 0;       ///< drive cycles followed
    flow::State state{};  ///< y_n at the end
    double change = 0.0;  ///< |y_n - y_(n-p)| / (1 + |y_n|), p the period, or one cycle unless settled
    /// Factor per period by which the changes shrink, from the largest of the last max(8, p) changes and of as many
    /// before them; absent (NaN) when too few cycles were followed. At most 0.9999 in remaining_error: changes that
    /// are down to 1e-4 of the tolerance and no longer shrink count as rounding.
    double contraction = 0.0;
    double remaining_error = 0.0;  ///< change rho/(1-rho), relative as `change`; absent likewise
};

/// Follows the motion from `start` at phase 0. Throws std::invalid_argument for options out of range.
Settling settle_until_repeating(const flow::System& system, const flow::State& start, const SettlingOptions& options);

/// Extremes of the motion over whole drive cycles from a state at phase 0.
struct Extremes {
    flow::Status status = flow::Status::not_run;
    flow::State state{};  ///< at the end
    double x_max = 0.0;
    double x_min = 0.0;
    double peak_force = 0.0;
    int contacts = 0;  ///< entries
    [[nodiscard]] double amplitude() const { return 0.5 * (x_max - x_min); }
};
Extremes observe_cycles(const flow::System& system, const flow::State& start, int cycles,
                        const SettlingOptions& options = {});

/// |a - b| / (1 + |b|) over the states of the system.
double relative_distance(const flow::System& system, const flow::State& a, const flow::State& b);

}  // namespace percuss::orbit
