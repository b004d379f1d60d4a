#include "design/reach.hpp"

#include "orbit/polish.hpp"

#include <algorithm>
#include <cmath>
#include <random>

namespace percuss::design {
namespace {

using orbit::Orbit;

std::size_t index(int i) { return static_cast<std::size_t>(i); }

bool counts(const Orbit& orbit, bool must_strike) { return orbit.ok() && !(must_strike && orbit.contacts.empty()); }

/// Random starts tried for an orbit of a longer period than the motion from rest has.
constexpr int most_starts = 200;
/// Cycles that such a start is followed for before Newton's method is tried.
constexpr int cycles_per_start = 150;
/// Half the size of the box of starts where the stop leaves less room, nondimensional.
constexpr double smallest_size = 0.05;

/// A state about the centre: from two gaps behind it up to the stop, at speeds up to twice that of a motion of the size
/// of the gap, internal states near rest.
flow::State random_start(const flow::System& system, double gap, std::mt19937_64& generator) {
    const auto uniform = [&](double low, double high) {
        return low + (high - low) * static_cast<double>(generator() >> 11U) * 0x1.0p-53;
    };
    const double size = std::max(gap, smallest_size);
    flow::State y = system.integrator->rest_state(system.parameters);
    y[0] = system.integrator->centre(system.parameters) + uniform(-2.0 * size, gap);
    y[1] = uniform(-2.0, 2.0) * system.omega() * size;
    for (int k = 2; k < system.states(); ++k) { y[index(k)] *= uniform(0.97, 1.03); }
    return y;
}

}  // namespace

Reached reach_orbit(const flow::System& system, const flow::State& from, int period, bool must_strike) {
    Reached reached;
    reached.kind = Reached::Kind::unsettled;
    reached.reason = "no orbit of period " + std::to_string(period) + " was reached";
    flow::State state = from;
    // Doubling: a try of Newton's method costs a few cycles, so it never costs more than the following does, and a
    // motion that settles early is caught early. Newton's method may land on an orbit that the motion only passes by:
    // that is kept as an answer only if it is stable, else the motion is followed on. 256 twice at the end: what has
    // not settled after some 760 periods is called unsettled.
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

Reached reach_from_rest(const flow::System& system, int period) {
    Reached reached = reach_orbit(system, system.integrator->rest_state(system.parameters), period, false);
    const auto fits = [&](const Reached& r) {
        return r.kind == Reached::Kind::stable && orbit::minimal_period(system, r.orbit) == period;
    };
    if (period == 1 || fits(reached)) { return reached; }
    std::mt19937_64 generator(1);
    const double gap = std::abs(system.stop_position() - system.integrator->centre(system.parameters));
    for (int attempt = 0; attempt < most_starts; ++attempt) {
        const auto settled = orbit::settle(system, random_start(system, gap, generator), cycles_per_start);
        if (!settled) { continue; }
        Reached candidate = reach_by_newton(system, *settled, period);
        if (fits(candidate)) { return candidate; }
    }
    reached = Reached{};  // what was reached instead is not an answer
    reached.kind = Reached::Kind::unsettled;
    reached.reason = "no stable orbit of period " + std::to_string(period) + " was found from " +
                     std::to_string(most_starts) + " starts";
    return reached;
}

Reached reach_by_newton(const flow::System& system, const flow::State& from, int period) {
    Reached reached;
    reached.orbit = orbit::polish_orbit(system, from, period);
    if (!reached.orbit.ok()) {
        reached.kind = Reached::Kind::unsettled;
        reached.reason = "Newton's method from orbit.start did not converge";
        return reached;
    }
    reached.kind = orbit::max_multiplier(reached.orbit) < 1.0 ? Reached::Kind::stable : Reached::Kind::unstable;
    if (reached.kind == Reached::Kind::unstable) { reached.reason = "the orbit is unstable"; }
    return reached;
}

std::optional<Orbit> stable_orbit_from(const flow::System& system, const flow::State& from) {
    // This many cycles bring the motion within the reach of Newton's method, whose orbit must be stable but need not be
    // the one the start would have led to in the end: any other stable orbit refutes as well.
    constexpr int cycles = 48;
    const auto settled = orbit::settle(system, from, cycles);
    if (!settled) { return std::nullopt; }
    const Orbit found = orbit::polish_orbit(system, *settled, 1);
    if (!found.ok() || !(orbit::max_multiplier(found) < 1.0)) { return std::nullopt; }
    return found;
}

std::optional<Orbit> continue_orbit(const flow::System& system, const Orbit& start, double to_omega) {
    // Steps this small next to the whole frequency mean a fold or grazing point in between: the orbit ends there.
    constexpr double smallest_step = 1e-7;
    Orbit current = start;
    double omega = system.omega();
    double step = to_omega - omega;
    const double smallest = smallest_step * std::abs(to_omega);
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

}  // namespace percuss::design
