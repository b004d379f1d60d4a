#include "design/operating_point.hpp"

#include "orbit/contact_sequence.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace percuss::design {
namespace {

using orbit::Orbit;
using std::numbers::pi;

bool counts(const Orbit& orbit, bool must_strike) { return orbit.ok() && !(must_strike && orbit.contacts.empty()); }

/// The impacting orbit at `omega`, which the free motion falls to below the edge; from a little further down where the
/// free orbit itself still stands at `omega`.
Reached reach_below_edge(const flow::System& system, const flow::State& free_state, double edge_omega, double omega) {
    constexpr double clear_of_edge = 2e-3;
    const double start = std::min(omega, edge_omega * (1.0 - clear_of_edge));
    Reached reached = reach_orbit(system.at_omega(start), free_state, 1, true);
    if (start == omega || !reached.orbit.ok()) { return reached; }
    auto moved = continue_orbit(system.at_omega(start), reached.orbit, omega);
    if (!moved) {
        reached.kind = Reached::Kind::unsettled;
        reached.reason = "the impacting orbit does not reach up to the operating frequency";
        return reached;
    }
    reached.orbit = std::move(*moved);
    reached.kind = orbit::max_multiplier(reached.orbit) < 1.0 ? Reached::Kind::stable : Reached::Kind::unstable;
    return reached;
}

}  // namespace

EdgeKind to_edge_kind(boundary::Kind kind) {
    switch (kind) {
        case boundary::Kind::none: return EdgeKind::none;
        case boundary::Kind::grazing: return EdgeKind::grazing;
        case boundary::Kind::fold: return EdgeKind::fold;
        case boundary::Kind::flip: return EdgeKind::flip;
        case boundary::Kind::torus: return EdgeKind::torus;
    }
    return EdgeKind::none;
}

Reached reach_orbit(const flow::System& system, const flow::State& from, int period, bool must_strike) {
    Reached reached;
    reached.kind = Reached::Kind::unsettled;
    reached.reason = "no orbit of period " + std::to_string(period) + " was reached";
    flow::State state = from;
    for (int cycles : {8, 16, 32, 64, 128, 256, 256}) {
        const auto settled = orbit::settle(system, state, cycles * period);
        if (!settled) {
            reached.kind = Reached::Kind::failed;
            reached.reason = "the motion could not be followed (too many contacts or divergence)";
            return reached;
        }
        state = *settled;
        const Orbit found = orbit::polish_orbit(system, state, period);
        if (found.ok() && found.contacts.empty() && orbit::max_multiplier(found) < 1.0) {
            reached.settled_clear = true;
        }
        if (!counts(found, must_strike)) { continue; }
        const bool stable = orbit::max_multiplier(found) < 1.0;
        if (stable || reached.kind != Reached::Kind::unstable) { reached.orbit = found; }
        reached.kind = stable ? Reached::Kind::stable : Reached::Kind::unstable;
        if (stable) {
            reached.reason.clear();
            return reached;
        }
        reached.reason = "the orbit of period " + std::to_string(period) + " is unstable";
    }
    return reached;
}

std::optional<Orbit> stable_orbit_from(const flow::System& system, const flow::State& from) {
    const auto settled = orbit::settle(system, from, 48);
    if (!settled) { return std::nullopt; }
    const Orbit found = orbit::polish_orbit(system, *settled, 1);
    if (!found.ok() || !(orbit::max_multiplier(found) < 1.0)) { return std::nullopt; }
    return found;
}

std::optional<Orbit> continue_orbit(const flow::System& system, const Orbit& start, double to_omega) {
    Orbit current = start;
    double omega = system.omega();
    double step = to_omega - omega;
    const double smallest = 1e-7 * std::abs(to_omega);
    while (omega != to_omega) {
        const double target = std::abs(to_omega - omega) <= std::abs(step) ? to_omega : omega + step;
        const Orbit next = orbit::find_orbit(system.at_omega(target), current.map, current.state);
        const bool same = next.ok() && next.contacts.size() == current.contacts.size();
        if (same) {
            current = next;
            omega = target;
        } else {
            step *= 0.5;
            if (std::abs(step) < smallest) { return std::nullopt; }
        }
    }
    return current;
}

EdgeOperation operate_at_edge(const flow::System& system, const OperationOptions& options) {
    EdgeOperation operation;
    boundary::FreeBranch branch(options.scout != nullptr ? *options.scout : system);
    operation.edge = boundary::find_edge(branch, system, {}, options.directions);
    if (operation.edge.status != boundary::EdgeStatus::found) { return operation; }
    const boundary::Boundary& edge = operation.edge.boundary;
    operation.omega = (1.0 - options.margin) * edge.omega;
    flow::State below = edge.state;
    if (options.check_neighbours) {
        if (edge.kind == boundary::Kind::grazing) {
            operation.fold = boundary::find_fold_beside(system, edge, std::max(2.0 * options.margin, 0.02));
        }
        operation.free_orbits = boundary::free_orbits_at(branch, system, operation.omega, 0.93 * operation.omega);
    }
    operation.reached = reach_below_edge(system, below, edge.omega, operation.omega);
    return operation;
}

boundary::FreeOrbitsAt free_orbits_from_above(const flow::System& system, const flow::System& scout, double omega) {
    boundary::FreeBranch branch(scout);
    const double resonance = system.integrator->linear_resonance(system.parameters);
    for (double ratio = std::max(3.0, 1.5 * omega / resonance); ratio < 100.0; ratio *= 1.7) {
        if (branch.start(ratio * resonance)) { return boundary::free_orbits_at(branch, system, omega, 0.93 * omega); }
    }
    return {};
}

}  // namespace percuss::design
