#pragma once
/// \file
/// The largest Lyapunov exponent of a motion, with its uncertainty.

#include "flow/flow.hpp"

#include <functional>
#include <limits>
#include <vector>

namespace percuss::attractor {

struct ExponentOptions {
    int transient = 64;  ///< cycles for the tangent vector to find its direction, not counted
    int cycles = 4096;
    int batches = 32;
};

/// Mean growth of the logarithm of a tangent vector that is carried along and renormalised each cycle (G. Benettin and
/// others, Meccanica 15 (1980) 9), per drive cycle; multiply by omega/(2 pi) for the rate per nondimensional time.
struct Exponent {
    double value = std::numeric_limits<double>::quiet_NaN();
    double error = std::numeric_limits<double>::quiet_NaN();  ///< half the width of the 95 % interval of batch means
    [[nodiscard]] bool positive() const { return value - error > 0.0; }
    [[nodiscard]] bool negative() const { return value + error < 0.0; }
};

enum class WanderStatus : std::uint8_t {
    not_run,
    ok,
    left,         ///< `leave` said so
    flow_failed,  ///< chatter, divergence, a tangent vector that vanished
};

/// A motion followed for many cycles, and what was seen of it after the transient.
struct Wander {
    WanderStatus status = WanderStatus::not_run;
    Exponent exponent;
    double swing = 0.0;   ///< largest modulus of the running sum of logarithms, bounded for a quasi-periodic motion
    flow::State state{};  ///< the strobed state that is followed by the longest flight met
    double x_max = 0.0;
    double x_min = 0.0;
    double peak_force = 0.0;
    double contacts_per_cycle = 0.0;
    int cycles = 0;
    std::vector<flow::State> strobes;  ///< one per cycle
};

/// Follows the motion from a state at theta = 0. `leave`, asked at every strobe, ends the run early. Throws
/// std::invalid_argument unless transient >= 0, batches >= 2 and cycles is at least that.
Wander wander(const flow::System& system, const flow::State& from, const ExponentOptions& options = {},
              const std::function<bool(const flow::State&)>& leave = {});

}  // namespace percuss::attractor
