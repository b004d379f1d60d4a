#include "orbit/polish.hpp"

#include "orbit/contact_sequence.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace percuss::orbit {
namespace {

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

}  // namespace

Orbit polish_orbit(const flow::System& system, const flow::State& from, int period) {
    const Strobe strobe = choose_strobe(system, from, period);
    ReturnMap map;
    map.period = period;
    map.phase = strobe.phase;
    Orbit found;
    found.map = map;
    if (!strobe.ok) {
        found.status = OrbitStatus::flow_failed;
        return found;
    }
    found = find_orbit(system, map, strobe.state);
    const bool cut =
        found.ok() && !found.contacts.empty() && (found.contacts.front().open_in || found.contacts.back().open_out);
    if (cut) { found = away_from_contact(system, found); }  // else one contact would count as two
    if (found.ok() && (found.contacts.empty() || lowest_impact_speed(found) > slow_contact)) { return found; }
    // Contact-sequence shooting from what was met, or from the stroboscopic solution.
    Orbit seed = found;
    if (!found.ok()) { seed.contacts = strobe.contacts; }
    const auto sequence = sequence_of(system, seed);
    if (!sequence) { return found; }
    const SequenceSolution solution = solve_sequence(system, *sequence);
    if (!solution.ok || !(solution.sequence.contacts.front().speed > 0.0)) { return found; }
    const auto state = state_at(system, solution.sequence, map.phase);
    if (!state) { return found; }
    const Orbit again = find_orbit(system, map, *state);
    return again.ok() ? again : found;
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
    Orbit moved = find_orbit(system, orbit.map, result.state);
    return moved.ok() ? moved : orbit;
}

int minimal_period(const flow::System& system, const Orbit& orbit) {
    const int n = orbit.map.period;
    for (int divisor = 1; divisor < n; ++divisor) {
        if (n % divisor != 0) { continue; }
        ReturnMap map = orbit.map;
        map.period = divisor;
        const Image image = apply(system, map, orbit.state, Differentiate::nothing);
        if (!image.ok()) { continue; }
        const numerics::SmallVector y = to_vector(system, orbit.state);
        if ((to_vector(system, image.state) - y).norm() < 1e-7 * (1.0 + y.norm())) { return divisor; }
    }
    return n;
}

}  // namespace percuss::orbit
