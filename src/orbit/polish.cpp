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

/// Follows one period to see the contacts; where phase 0 is not clear of them, strobes in the middle of the longest
/// flight that follows one. ok unless the flow fails.
Strobe choose_strobe(const flow::System& system, const flow::State& from, int period) {
    Strobe strobe;
    flow::Request request;
    request.state = from;
    request.duration = 2.0 * pi * period;
    // A cap, so that chatter ends with a status instead of without end.
    request.max_events = 256 * period;
    flow::Result result;
    system.run(request, result);
    if (result.status != flow::Status::ok) { return strobe; }
    strobe.ok = true;
    strobe.state = from;
    strobe.contacts = result.contacts;
    // In theta. Newton's method moves the contacts: one that came to lie across the strobe phase would be cut in two,
    // and the map would have a corner there.
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
    // No flight follows a contact within the period: no phase is known to be better than 0.
    if (longest <= 0.0) { return strobe; }
    request.duration = middle;
    system.run(request, result);
    if (result.status != flow::Status::ok) { return strobe; }
    strobe.phase = std::fmod(middle, 2.0 * pi);
    strobe.state = result.state;
    return strobe;
}

/// Of all contacts, nondimensional; without any contact larger than any speed.
double lowest_impact_speed(const Orbit& orbit) {
    double lowest = 1e300;
    for (const flow::Contact& contact : orbit.contacts) { lowest = std::min(lowest, contact.state_in[1]); }
    return lowest;
}

/// Below this entry speed the corner of grazing spoils stroboscopic Newton.
/// At the defaults of Wu et al. 2022 the leading multiplier goes from 0.885 at grazing to 1 at v = 8.4e-5 (the fold,
/// 6e-9 below in omega) and to 12 at v = 1e-2.
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
    // The unconverged iterate may have other contacts than the motion: those that were met are the better guess.
    Orbit seed = found;
    if (!found.ok()) { seed.contacts = strobe.contacts; }
    const auto sequence = sequence_of(system, seed);
    if (!sequence) { return found; }
    const SequenceSolution solution = solve_sequence(system, *sequence);
    // A solution with a negative entry speed lies on the far side of grazing and is no motion.
    if (!solution.ok || !(solution.sequence.contacts.front().speed > 0.0)) { return found; }
    const auto state = state_at(system, solution.sequence, map.phase);
    if (!state) { return found; }
    // The answer of either way is a fixed point of the hybrid map, with its contacts and monodromy matrix.
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
            // Phase from the beginning of this cycle to the contact; one whole period more keeps fmod's argument
            // positive.
            const double after = std::fmod(contact.theta_in - orbit.map.phase - 2.0 * pi * cycle + whole, whole);
            first = std::min(first, after);
        }
        // Flights equal but for rounding: the earlier cycle, so that the choice is the same every time.
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
        // Far above what Newton's method leaves (residual 1e-11), far below the distance of the strobe points of a
        // subharmonic, which vanishes at its flip only.
        if ((to_vector(system, image.state) - y).norm() < 1e-7 * (1.0 + y.norm())) { return divisor; }
    }
    return n;
}

}  // namespace percuss::orbit
