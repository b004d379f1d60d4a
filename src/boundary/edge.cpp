#include "boundary/edge.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace percuss::boundary {
namespace {

/// What the last step of the branch passed over.
struct Passed {
    bool grazing = false;
    bool stability = false;
    bool fold = false;
    bool hump = false;  ///< the largest displacement had a maximum inside the step
    // A fold is a loss of stability as well: one event.
    [[nodiscard]] int events() const { return (grazing ? 1 : 0) + ((stability || fold) ? 1 : 0); }
};

/// Upper estimate of the clearance inside a step whose ends have slopes of opposite sign.
double hump_height(const FreePoint& a, const FreePoint& b, double length) {
    // The clearance near its maximum is concave: it stays below either tangent, carried across the whole step.
    const double from_a = a.clearance + a.clearance_slope * length;
    const double from_b = b.clearance - b.clearance_slope * length;
    return std::max({a.clearance, b.clearance, std::min(from_a, from_b)});
}

Passed compare(const FreePoint& a, const FreePoint& b) {
    Passed passed;
    passed.grazing = a.clearance < 0.0 && b.clearance >= 0.0;
    passed.fold = a.omega_slope < 0.0 && b.omega_slope >= 0.0;
    passed.stability = a.stable() && !b.stable();
    passed.hump = a.clearance_slope > 0.0 && b.clearance_slope < 0.0 && a.clearance < 0.0 && b.clearance < 0.0;
    return passed;
}

/// Linear interpolation of frequency and state, a guess for Newton's method.
FreePoint between(const FreePoint& a, const FreePoint& b, double share) {
    FreePoint p = a;
    p.omega = a.omega + share * (b.omega - a.omega);
    for (std::size_t k = 0; k < p.state.size(); ++k) { p.state[k] = a.state[k] + share * (b.state[k] - a.state[k]); }
    return p;
}

/// Whether the motion that starts at `from` strikes the stop after it has settled.
bool strikes(const flow::System& system, const flow::State& from, int cycles, bool& failed) {
    const auto settled = orbit::settle(system, from, cycles);
    failed = !settled.has_value();
    if (failed) { return false; }
    flow::Request request;
    request.state = *settled;
    // 24 cycles show the contact of a motion that strikes once in 2, 3, 4, 6, 8 or 12 of them.
    request.duration = 2.0 * std::numbers::pi * 24;
    // 83 contact events a cycle: a motion that bounces more is told as one that could not be followed.
    request.max_events = 2000;
    flow::Result result;
    system.run(request, result);
    failed = result.status != flow::Status::ok;
    return !result.contacts.empty();
}

/// Sets the branch out above everything: at start_ratio times the resonance, higher where the stop is still in reach.
bool start_above(FreeBranch& branch, double resonance, const EdgeOptions& options) {
    // Above resonance the motion falls with the square of the frequency: each attempt leaves a third of it (1.7^2 =
    // 2.9). The last is at 1000 times the resonance.
    double ratio = options.start_ratio;
    for (int attempt = 0; attempt < 12; ++attempt, ratio *= 1.7) {
        if (branch.start(ratio * resonance) && branch.current().stable() && branch.current().clearance < 0.0) {
            return true;
        }
    }
    return false;
}

std::string_view loss_name(Kind kind, bool mirrored) {
    switch (kind) {
        case Kind::fold: return "a fold";
        case Kind::flip: return mirrored ? "a loss of symmetry" : "a period doubling";
        case Kind::torus: return "a torus point";
        default: return "a boundary";
    }
}

/// Grazing or loss of stability in the last step: refine it and apply the rule.
void settle_edge(Edge& edge, const FreeBranch& branch, const flow::System& system, const Passed& passed,
                 const EdgeOptions& options, std::span<const flow::ParameterVector> directions) {
    const FreePoint& a = branch.previous();
    const FreePoint& b = branch.current();
    const orbit::ReturnMap map = FreeBranch::map_of(system);
    edge.status = EdgeStatus::failed;
    if (passed.grazing) {
        const double share = a.clearance / (a.clearance - b.clearance);
        const FreePoint guess = between(a, b, share);
        edge.boundary = solve_boundary(system, map, Kind::grazing, guess.state, guess.omega, directions);
        if (!edge.boundary.ok()) {
            edge.reason = "the grazing point of the free motion could not be refined";
            return;
        }
        edge.status = EdgeStatus::found;
        return;
    }
    // By the leading multiplier beyond; at a fold the frequency has turned, which is the surer sign.
    const Kind kind = passed.fold ? Kind::fold : b.nearest;
    FreePoint guess = between(a, b, 0.5);
    if (passed.fold) {
        guess = between(a, b, a.omega_slope / (a.omega_slope - b.omega_slope));
    } else if (b.radius > a.radius) {
        // Where the leading multiplier passes through 1, linearly; the middle where its modulus does not grow.
        guess = between(a, b, (1.0 - a.radius) / (b.radius - a.radius));
    }
    edge.boundary = solve_boundary(system, map, kind, guess.state, guess.omega, directions);
    if (!edge.boundary.ok()) {
        edge.reason = "the free motion loses stability but the boundary could not be refined";
        return;
    }
    bool failed = false;
    const flow::System below = system.at_omega(edge.boundary.omega * (1.0 - options.below));
    // Beyond a loss of symmetry or a torus point the orbit goes on, unstable: a small push makes it leave.
    flow::State pushed = edge.boundary.state;
    const double gap = system.parameters[static_cast<std::size_t>(system.integrator->info().gap)];
    const double room = system.stop_position() - system.integrator->rest_state(system.parameters)[0];
    pushed[0] += 1e-4 * (map.mirrored ? gap : room);
    const bool hits = strikes(below, pushed, options.settle_cycles, failed);
    if (failed) {
        edge.reason = "the motion just below the boundary of the free motion could not be followed";
    } else if (hits) {
        edge.status = EdgeStatus::found;
    } else {
        edge.status = EdgeStatus::no_impact;
        edge.reason = "coming down in frequency the free motion meets " + std::string(loss_name(kind, map.mirrored)) +
                      " and settles on a motion that does not reach the stop";
    }
}

}  // namespace

Edge find_edge(FreeBranch& branch, const flow::System& system, const EdgeOptions& options,
               std::span<const flow::ParameterVector> directions) {
    Edge edge;
    const double resonance = system.integrator->linear_resonance(system.parameters);
    edge.status = EdgeStatus::failed;
    if (!start_above(branch, resonance, options)) {
        edge.reason = "no stable motion clear of the stop was found at high frequency";
        return edge;
    }
    edge.searched_from = branch.current().omega;
    for (edge.steps = 0; edge.steps < options.max_steps; ++edge.steps) {
        if (!branch.advance()) {
            edge.reason = "the free motion could not be followed down in frequency";
            break;
        }
        const FreePoint& a = branch.previous();
        const FreePoint& b = branch.current();
        const Passed passed = compare(a, b);
        const double length = b.arclength - a.arclength;
        // Events are told from the ends of a step. Two in one step have no order; a hump may have touched inside; and
        // from further than 0.3 the guess for Newton's method, interpolated, is poor. Below 1e-4 two events are taken
        // as one, grazing first.
        const bool too_coarse =
            length > 1e-4 && (passed.events() > 1 || (passed.hump && hump_height(a, b, length) >= 0.0) ||
                              (passed.events() == 1 && length > 0.3));
        if (too_coarse && branch.retreat()) { continue; }
        edge.searched_to = b.omega;
        if (passed.events() > 0) {
            settle_edge(edge, branch, system, passed, options, directions);
            break;
        }
        if (b.omega < options.lowest_ratio * resonance) {
            edge.status = EdgeStatus::no_impact;
            edge.reason = "the free motion stays clear of the stop at every drive frequency";
            break;
        }
    }
    if (edge.status == EdgeStatus::failed && edge.reason.empty()) {
        edge.reason = "the free motion needed too many continuation steps";
    }
    return edge;
}

FreeOrbitsAt free_orbits_at(FreeBranch& branch, const flow::System& system, double omega, double lowest) {
    FreeOrbitsAt found;
    const orbit::ReturnMap map = FreeBranch::map_of(system);
    for (int step = 0; step < 200; ++step) {
        const FreePoint& a = branch.previous();
        const FreePoint& b = branch.current();
        // The branch turns back at folds: every passage of the frequency, either way, is a motion there.
        if ((a.omega > omega) != (b.omega > omega)) {
            const FreePoint guess = between(a, b, (omega - a.omega) / (b.omega - a.omega));
            const orbit::Orbit free = orbit::find_orbit(system.at_omega(omega), map, guess.state);
            if (free.ok()) {
                const orbit::Image image = orbit::apply(system.at_omega(omega), map, free.state,
                                                        orbit::Differentiate::state, {}, flow::observe_extrema);
                FreePoint point = b;
                point.state = free.state;
                point.omega = omega;
                point.clearance = clearance(system.at_omega(omega), map, image, {}).value;
                point.radius = orbit::max_multiplier(free);
                // Of the half-cycle map, as on the branch: its multipliers squared are those of the cycle.
                if (map.mirrored) { point.radius = std::sqrt(point.radius); }
                found.points.push_back(point);
            }
        }
        // Below `lowest` but on the way up the branch may come back across the frequency.
        if (b.omega < lowest && b.omega_slope < 0.0) {
            found.complete = true;
            return found;
        }
        if (!branch.advance()) { return found; }
    }
    return found;
}

}  // namespace percuss::boundary
