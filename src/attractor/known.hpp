#pragma once
/// \file
/// Stable periodic orbits that are known, and how one becomes known.

#include "attractor/trap.hpp"
#include "flow/flow.hpp"
#include "orbit/orbit.hpp"

#include <memory>
#include <optional>
#include <span>
#include <vector>

namespace percuss::attractor {

/// The two integrators of one system: motions are followed with the loose one, orbits polished with the exact one.
struct Systems {
    const flow::System& exact;
    const flow::System& scout;
};

struct KnownOrbit {
    orbit::Orbit orbit;  ///< of its minimal period, strobed at the cycle that the longest flight follows
    Trap trap;
};
using KnownOrbits = std::vector<std::shared_ptr<const KnownOrbit>>;

/// A stable orbit in its standard form, with its trap. Distances are measured in `scale`.
std::shared_ptr<const KnownOrbit> make_known(const Systems& systems, const orbit::Orbit& orbit,
                                             const flow::State& scale);

/// Newton from a strobed state for an orbit of `period` cycles; the orbit of its minimal period if all multipliers are
/// below 1 in modulus, else nothing.
std::optional<orbit::Orbit> stable_orbit(const flow::System& system, const flow::State& from, int period);

/// Whether both are the same motion, wherever their strobe starts.
bool same_orbit(const KnownOrbit& a, const KnownOrbit& b);

/// Number of the known orbit that is the same motion, or nothing.
std::optional<int> find_known(const KnownOrbits& known, const KnownOrbit& orbit);

/// Adds the orbits that are not known yet; returns the number of each in the list.
std::vector<int> merge_into(KnownOrbits& known, const KnownOrbits& more);

/// How nearly a motion recurs: the last strobed states of a history compared with those n cycles before.
struct Recurrence {
    int period = 0;         ///< 0: the history is too short
    double distance = 0.0;  ///< in units of the scale
};

/// Whether a motion that recurs like this, now at z, is on its way to something else than the known orbits: on the way
/// to one of them it would recur no closer than about (1 - multiplier) times its distance from it.
bool is_news(const KnownOrbits& known, const Recurrence& recurrence, const flow::State& z);

/// The shortest of the recurrences after `shortest` to `longest` cycles that come close to the nearest of them. The
/// history is in the order of time, its last entry now.
Recurrence recurrence(std::span<const flow::State> history, int states, const flow::State& scale, int shortest,
                      int longest);

/// Whether a motion is on its way to a known orbit, ever closer, but too slow to have been captured yet: it nearly
/// recurs as such a motion does, and each quarter of its history stays nearer to the orbit than the one before.
bool is_creeping(const KnownOrbits& known, std::span<const flow::State> history, int states, const flow::State& scale);

}  // namespace percuss::attractor
