#include "attractor/box.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <stdexcept>
#include <string>

namespace percuss::attractor {
namespace {

using std::numbers::pi;

/// 2^64 divided by the golden ratio, odd: the increment of splitmix64.
constexpr std::uint64_t golden_gamma = 0x9e3779b97f4a7c15U;

std::size_t index(int i) { return static_cast<std::size_t>(i); }

/// The finaliser of splitmix64.
std::uint64_t mix(std::uint64_t z) {
    z = (z ^ (z >> 30U)) * 0xbf58476d1ce4e5b9U;
    z = (z ^ (z >> 27U)) * 0x94d049bb133111ebU;
    return z ^ (z >> 31U);
}

/// Output number `counter` of splitmix64, as a number in [0, 1).
double uniform(std::uint64_t seed, std::uint64_t counter) {
    // The seed goes through the finaliser first: else neighbouring seeds count through the same numbers, shifted.
    const std::uint64_t bits = mix(mix(seed + golden_gamma) + (counter + 1) * golden_gamma);
    // As many bits as a double has: 53.
    return static_cast<double>(bits >> 11U) * 0x1.0p-53;
}

/// Half the stroke over the last cycles of a motion, zero when it cannot be followed.
double settled_amplitude(const flow::System& system, const flow::State& from) {
    // An amplitude for the size of a box is all that is asked for: what has not quite settled after 240 cycles is near
    // enough. The last 16 show every side of a subharmonic motion of up to 16 cycles.
    constexpr int cycles = 256;
    constexpr int last = 16;
    flow::Request request;
    request.state = from;
    request.duration = 2.0 * pi * (cycles - last);
    // 64 a cycle on average: a motion that bounces more counts as not followed, and the gap gives the box its size.
    request.max_events = 64 * cycles;
    flow::Result result;
    system.run(request, result);
    if (result.status != flow::Status::ok) { return 0.0; }
    request.state = result.state;
    request.duration = 2.0 * pi * last;
    request.observe = flow::observe_extrema;
    system.run(request, result);
    if (result.status != flow::Status::ok) { return 0.0; }
    return 0.5 * (result.observables.x_max.value - result.observables.x_min.value);
}

flow::State middle(const Box& box) {
    flow::State y{};
    for (std::size_t k = 0; k < y.size(); ++k) { y[k] = box.lower[k] + 0.5 * (box.upper[k] - box.lower[k]); }
    return y;
}

/// What one cycle from a state moves; zero when it cannot be followed. Not counted as work.
flow::State size_of_motion(const flow::System& system, const flow::State& from) {
    flow::System uncounted = system;
    uncounted.cost = nullptr;
    flow::Request request;
    request.state = from;
    request.duration = 2.0 * pi;
    request.max_events = most_contact_events;
    request.observe = flow::observe_extrema;
    flow::Result result;
    uncounted.run(request, result);
    if (result.status != flow::Status::ok) { return {}; }
    const double reach = 0.5 * (result.observables.x_max.value - result.observables.x_min.value);
    const flow::StateRange internal = system.integrator->internal_range(system.parameters, reach);
    flow::State size{};
    for (std::size_t k = 0; k < size.size(); ++k) { size[k] = 0.5 * (internal.upper[k] - internal.lower[k]); }
    size[0] = reach;
    size[1] = reach * system.omega();
    return size;
}

}  // namespace

Box ensemble_box(const flow::System& system, double amplitude) {
    if (!(amplitude >= 0.0 && std::isfinite(amplitude))) {
        throw std::invalid_argument("ensemble box: amplitude = " + std::to_string(amplitude) +
                                    ": allowed is at least 0");
    }
    if (!(system.omega() > 0.0)) {
        throw std::invalid_argument("ensemble box: omega = " + std::to_string(system.omega()) + ": allowed is above 0");
    }
    const bool has_stop = system.integrator->info().has_stop;
    const double centre = system.integrator->centre(system.parameters);
    const double rest = system.integrator->rest_state(system.parameters)[0];
    const double gap = system.stop_position() - rest;
    // Where the mass can rest: more than one place where there are two wells, and both belong to the box.
    const flow::StateRange places = system.integrator->internal_range(system.parameters, 0.0);
    const double apart = 0.5 * (places.upper[0] - places.lower[0]);
    const double size = std::max(has_stop ? std::max(gap, amplitude) : amplitude, apart);
    if (!(size > 0.0 && std::isfinite(size))) {
        throw std::invalid_argument("ensemble box: neither the gap nor the amplitude is above 0");
    }
    // Twice the motion that is known reaches the stronger ones beside it as a rule, not always: against hardening
    // springs at a given frequency motions 15 to 50 times stronger have been met.
    const double reach = 2.0 * size;
    const flow::StateRange internal = system.integrator->internal_range(system.parameters, reach);
    Box box{internal.lower, internal.upper};
    box.lower[0] = std::min(rest, centre + internal.lower[0]) - reach;
    box.upper[0] = has_stop ? rest + gap : std::max(rest, centre + internal.upper[0]) + reach;
    box.lower[1] = -reach * system.omega();
    box.upper[1] = reach * system.omega();
    return box;
}

double amplitude_to_expect(const flow::System& system) {
    const flow::State rest = system.integrator->rest_state(system.parameters);
    const double from_rest = settled_amplitude(system, rest);
    double largest = from_rest;
    if (system.integrator->info().has_stop) { return largest; }
    // Doublings cover a strong side up to 32 times the weak one, at the price of four runs.
    for (const double times : {4.0, 8.0, 16.0, 32.0}) {
        flow::State away = rest;
        away[0] -= times * from_rest;
        largest = std::max(largest, settled_amplitude(system, away));
    }
    return largest;
}

void validate(const Box& box, int states) {
    bool has_room = false;
    for (int k = 0; k < states; ++k) {
        const double lower = box.lower[index(k)];
        const double upper = box.upper[index(k)];
        if (!(std::isfinite(lower) && std::isfinite(upper) && lower <= upper)) {
            throw std::invalid_argument("ensemble box: state " + std::to_string(k + 1) + " from " +
                                        std::to_string(lower) + " to " + std::to_string(upper) +
                                        ": allowed are finite numbers in this order");
        }
        has_room = has_room || lower < upper;
    }
    if (!has_room) { throw std::invalid_argument("ensemble box: every interval has length 0"); }
}

flow::State half_widths(const Box& box, int states) {
    flow::State widths{};
    for (int k = 0; k < states; ++k) {
        const double half = 0.5 * (box.upper[index(k)] - box.lower[index(k)]);
        widths[index(k)] = half > 0.0 ? half : 1.0;
    }
    return widths;
}

flow::State distance_scale(const flow::System& system, const Box& box) {
    // Traps, recurrences and the comparison of orbits have thresholds down to 1e-8 of this scale. Where it was that of
    // a box narrower than 1e-8 they lay below what a state at order one resolves: no motion was ever captured, and one
    // orbit counted as several. With a tenth of the motion they stay above 1e-10 of it; boxes as wide as ensemble_box
    // makes them exceed it by far, so that the share does not enter there.
    constexpr double least_share = 0.1;
    flow::State scale = half_widths(box, system.states());
    const flow::State size = size_of_motion(system, middle(box));
    for (int k = 0; k < system.states(); ++k) {
        scale[index(k)] = std::max(scale[index(k)], least_share * size[index(k)]);
    }
    return scale;
}

flow::State start_state(const Box& box, int states, std::uint64_t seed, long i) {
    flow::State y{};
    const auto first = static_cast<std::uint64_t>(i) * flow::max_states;
    for (int k = 0; k < states; ++k) {
        const double share = uniform(seed, first + static_cast<std::uint64_t>(k));
        y[index(k)] = box.lower[index(k)] + share * (box.upper[index(k)] - box.lower[index(k)]);
    }
    return y;
}

}  // namespace percuss::attractor
