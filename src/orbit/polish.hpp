#pragma once
/// \file
/// From a state near a periodic motion to the orbit itself, in a form that does not depend on where it was met.

#include "orbit/orbit.hpp"

namespace percuss::orbit {

/// Newton from a state; the strobe phase is chosen away from contact. Low-speed contacts, where stroboscopic shooting
/// has a corner, go through contact-sequence shooting.
Orbit polish_orbit(const flow::System& system, const flow::State& from, int period);

/// State of the orbit at phase 0.
flow::State state_at_zero(const flow::System& system, const Orbit& orbit);

/// The same orbit of several drive cycles, starting with the cycle that is followed by the longest flight: one of its
/// strobe points, chosen the same way every time. Unchanged without contacts or for one cycle.
Orbit start_with_longest_flight(const flow::System& system, const Orbit& orbit);

/// Number of drive cycles after which the orbit really repeats: a divisor of its map's period.
int minimal_period(const flow::System& system, const Orbit& orbit);

}  // namespace percuss::orbit
