#pragma once
/// \file
/// Where a design is driven and the motion it makes there, nondimensional.

#include "boundary/edge.hpp"
#include "design/evaluation.hpp"
#include "flow/flow.hpp"
#include "orbit/orbit.hpp"
#include "orbit/polish.hpp"

#include <optional>
#include <span>
#include <string>
#include <vector>

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

/// The stable orbit of one cycle that a start leads to, or nothing.
std::optional<orbit::Orbit> stable_orbit_from(const flow::System& system, const flow::State& from);

/// The orbit continued from one frequency to another by Newton, steps halved on failure. Nothing when it is lost.
std::optional<orbit::Orbit> continue_orbit(const flow::System& system, const orbit::Orbit& start, double to_omega);

/// The kind of an edge as it is reported.
EdgeKind to_edge_kind(boundary::Kind kind);

/// The edge of a design, the frequency (1 - margin) below it, and what stands there.
struct EdgeOperation {
    boundary::Edge edge;
    double omega = 0.0;
    /// Free orbits at the operating frequency (found by following the free branch below it), with their clearance.
    boundary::FreeOrbitsAt free_orbits;
    std::optional<boundary::GrazingFold> fold;  ///< when asked for and the edge is a grazing
    Reached reached;
};

struct OperationOptions {
    double margin = 0.01;
    const flow::System* scout = nullptr;  ///< same system with a looser integrator, to follow the free branch with
    bool check_neighbours = true;         ///< fold beside the edge, free orbits at the operating frequency
    std::span<const flow::ParameterVector> directions{};
};

EdgeOperation operate_at_edge(const flow::System& system, const OperationOptions& options);

/// Free orbits that stay clear of the stop at a given frequency (all amplitudes met on the branch from above).
/// `scout` as above.
boundary::FreeOrbitsAt free_orbits_from_above(const flow::System& system, const flow::System& scout, double omega);

}  // namespace percuss::design
