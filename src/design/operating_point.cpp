#include "design/operating_point.hpp"

#include "orbit/contact_sequence.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace percuss::design {
namespace {

using orbit::Orbit;
using std::numbers::pi;

/// A strobe phase in flight: 0 unless the motion is in or near contact there.
struct Strobe {
    double phase = 0.0;
    flow::State state{};
    std::vector<flow::Contact> contacts;  ///< of one period from phase 0
    bool ok = false;
};

Strobe choose_strobe(const flow::System& system, const flow::State& from, int period) {
    Strobe strobe;
    flow::Request request;
    request.state = from;
    request.duration = 2.0 * pi * period;
    request.max_events = 256 * period;
    flow::Result result;
    system.run(request, result);
    if (result.status != flow::Status::ok) { return strobe; }
    strobe.ok = true;
    strobe.state = from;
    strobe.contacts = result.contacts;
    constexpr double near = 0.1;
    const auto& met = result.contacts;
    const bool clear = met.empty() || (met.front().theta_in > near && met.back().theta_out < request.duration - near &&
                                       !met.front().open_in && !met.back().open_out);
    if (clear) { return strobe; }
    double longest = 0.0;
    double middle = 0.0;
    for (std::size_t i = 0; i + 1 < met.size() + 1; ++i) {
        const double begin = met[i].theta_out;
        const double end = i + 1 < met.size() ? met[i + 1].theta_in : request.duration;
        if (end - begin > longest) {
            longest = end - begin;
            middle = 0.5 * (begin + end);
        }
    }
    if (longest <= 0.0) { return strobe; }
    request.duration = middle;
    system.run(request, result);
    if (result.status != flow::Status::ok) { return strobe; }
    strobe.phase = std::fmod(middle, 2.0 * pi);
    strobe.state = result.state;
    return strobe;
}

double lowest_impact_speed(const Orbit& orbit) {
    double lowest = 1e300;
    for (const flow::Contact& contact : orbit.contacts) { lowest = std::min(lowest, contact.state_in[1]); }
    return lowest;
}

/// Below this entry speed the corner of grazing spoils stroboscopic Newton.
constexpr double slow_contact = 1e-3;

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

Orbit polish_orbit(const flow::System& system, const flow::State& from, int period) {
    const Strobe strobe = choose_strobe(system, from, period);
    orbit::ReturnMap map;
    map.period = period;
    map.phase = strobe.phase;
    Orbit found;
    found.map = map;
    if (!strobe.ok) {
        found.status = orbit::OrbitStatus::flow_failed;
        return found;
    }
    found = orbit::find_orbit(system, map, strobe.state);
    const bool cut =
        found.ok() && !found.contacts.empty() && (found.contacts.front().open_in || found.contacts.back().open_out);
    if (cut) { found = orbit::away_from_contact(system, found); }  // else one contact would count as two
    if (found.ok() && (found.contacts.empty() || lowest_impact_speed(found) > slow_contact)) { return found; }
    // Contact-sequence shooting from what was met, or from the stroboscopic solution.
    Orbit seed = found;
    if (!found.ok()) { seed.contacts = strobe.contacts; }
    const auto sequence = orbit::sequence_of(system, seed);
    if (!sequence) { return found; }
    const orbit::SequenceSolution solution = orbit::solve_sequence(system, *sequence);
    if (!solution.ok || !(solution.sequence.contacts.front().speed > 0.0)) { return found; }
    const auto state = orbit::state_at(system, solution.sequence, map.phase);
    if (!state) { return found; }
    const Orbit again = orbit::find_orbit(system, map, *state);
    return again.ok() ? again : found;
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
        const Orbit found = polish_orbit(system, state, period);
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
    const Orbit found = polish_orbit(system, *settled, 1);
    if (!found.ok() || !(orbit::max_multiplier(found) < 1.0)) { return std::nullopt; }
    return found;
}

flow::State state_at_zero(const flow::System& system, const Orbit& orbit) {
    if (orbit.map.phase == 0.0) { return orbit.state; }
    flow::Request request;
    request.state = orbit.state;
    request.theta = orbit.map.phase;
    request.duration = 2.0 * pi * orbit.map.period - orbit.map.phase;
    request.stop = orbit.map.stop;
    flow::Result result;
    system.run(request, result);
    return result.state;
}

Orbit start_with_longest_flight(const flow::System& system, const Orbit& orbit) {
    const int n = orbit.map.period;
    if (n == 1 || orbit.contacts.empty()) { return orbit; }
    const double whole = 2.0 * pi * n;
    int best = 0;
    double longest = -1.0;
    for (int cycle = 0; cycle < n; ++cycle) {
        double first = whole;
        for (const flow::Contact& contact : orbit.contacts) {
            const double after = std::fmod(contact.theta_in - orbit.map.phase - 2.0 * pi * cycle + whole, whole);
            first = std::min(first, after);
        }
        if (first > longest + 1e-9) {
            longest = first;
            best = cycle;
        }
    }
    if (best == 0) { return orbit; }
    flow::Request request;
    request.state = orbit.state;
    request.theta = orbit.map.phase;
    request.duration = 2.0 * pi * best;
    flow::Result result;
    system.run(request, result);
    if (result.status != flow::Status::ok) { return orbit; }
    Orbit moved = orbit::find_orbit(system, orbit.map, result.state);
    return moved.ok() ? moved : orbit;
}

int minimal_period(const flow::System& system, const Orbit& orbit) {
    const int n = orbit.map.period;
    for (int divisor = 1; divisor < n; ++divisor) {
        if (n % divisor != 0) { continue; }
        orbit::ReturnMap map = orbit.map;
        map.period = divisor;
        const orbit::Image image = orbit::apply(system, map, orbit.state, orbit::Differentiate::nothing);
        if (!image.ok()) { continue; }
        const numerics::SmallVector y = orbit::to_vector(system, orbit.state);
        if ((orbit::to_vector(system, image.state) - y).norm() < 1e-7 * (1.0 + y.norm())) { return divisor; }
    }
    return n;
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
