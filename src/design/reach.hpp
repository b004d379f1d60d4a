#pragma once
/// \file
/// The periodic motion that a state leads to, nondimensional.

#include "flow/flow.hpp"
#include "orbit/orbit.hpp"

#include <cstdint>
#include <optional>
#include <string>

namespace percuss::design {

/// The motion reached from a state, polished to a periodic orbit.
struct Reached {
    enum class Kind : std::uint8_t {
        not_run,
        stable,
        unstable,   ///< only an unstable orbit of this period was found
        unsettled,  ///< no orbit of this period
        failed,     ///< the flow failed
    };
    Kind kind = Kind::not_run;
    orbit::Orbit orbit;
    bool settled_clear = false;  ///< a stable orbit that never touches the stop was met on the way
    std::string reason;
};

/// Follows the motion from `from` (phase 0) for up to a few hundred cycles, with Newton's method tried in between,
/// until a stable orbit of `period` cycles is captured. `must_strike`: an orbit that never touches the stop does not
/// count.
Reached reach_orbit(const flow::System& system, const flow::State& from, int period, bool must_strike);

/// The motion reached from rest; when that is not of the period asked for, the first of a fixed sequence of 200 random
/// starts about the centre that leads to a stable orbit of that minimal period.
Reached reach_from_rest(const flow::System& system, int period);

/// Newton's method from a state at phase 0, stable or not. unsettled when it does not converge.
Reached reach_by_newton(const flow::System& system, const flow::State& from, int period);

/// The stable orbit of one cycle that a start leads to, or nothing.
std::optional<orbit::Orbit> stable_orbit_from(const flow::System& system, const flow::State& from);

/// The orbit continued from one frequency to another by Newton, steps halved on failure. Nothing when it is lost.
std::optional<orbit::Orbit> continue_orbit(const flow::System& system, const orbit::Orbit& start, double to_omega);

}  // namespace percuss::design
