#pragma once
/// \file
/// Letting a motion settle by following it, cycle by cycle, until its strobed state repeats.

#include "flow/flow.hpp"

#include <cstdint>
#include <optional>

namespace percuss::orbit {

/// What must fall below the tolerance before a motion counts as settled.
enum class SettlingRule : std::uint8_t {
    /// The change itself, the rule usual in practice. With a multiplier rho it stops change rho/(1 - rho) short of the
    /// orbit, a slow passage passes for an orbit, and a slow spiral may pass for a subharmonic.
    strobed_change,
    /// The change, and the error that remains: the Newton step from the strobed state to the orbit, with the exact
    /// monodromy matrix M. With one multiplier rho it is change rho/(1 - rho). The orbit must be stable.
    remaining_error,
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
    /// |y_n - y_(n-p)| / (1 + |y_n|). p is the period, or for a motion that spirals in perhaps a multiple of it; one
    /// cycle unless settled.
    double change = 0.0;
    double contraction = 0.0;      ///< largest multiplier of the period; absent (NaN) unless settled by remaining_error
    double remaining_error = 0.0;  ///< |(I - M)^-1 (P(y_n) - y_n)| / (1 + |y_n|); absent likewise
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
