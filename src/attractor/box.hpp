#pragma once
/// \file
/// Where the starts of an ensemble are drawn from, and how. Nondimensional; every start is a state at theta = 0.

#include "flow/flow.hpp"

#include <cstdint>

namespace percuss::attractor {

/// Contact events in one drive cycle up to which motions are followed: on their way, those that come to rest on a stiff
/// stop for a part of the cycle bounce some hundred times in it.
/// 128, as it once was, gave such starts up in a stress test of random designs.
inline constexpr int most_contact_events = 1024;

/// An interval for every state; entries beyond the system's states are not looked at.
struct Box {
    flow::State lower{};
    flow::State upper{};
};

/// With A = max(gap, amplitude): x - centre in [-2 A, gap] (to +2 A without a stop), x' within 2 omega A, the remaining
/// states where they stay while |x - centre| <= 2 A. `amplitude` is half the stroke of a motion known; throws
/// std::invalid_argument unless it is finite, not negative, and A is positive.
Box ensemble_box(const flow::System& system, double amplitude);

/// Half the stroke of the motion reached from rest, seen over the last 16 of 256 cycles; zero when it cannot be
/// followed. Without a stop, which would bound the motions of interest, the largest of this and of the motions reached
/// when the mass is let go at 4, 8, 16 and 32 times that distance from the centre: a resonance has two sides.
double amplitude_to_expect(const flow::System& system);

/// Throws std::invalid_argument unless every interval is finite and not reversed, and at least one has a length.
void validate(const Box& box, int states);

/// Half the length of each interval, one where it has none.
flow::State half_widths(const Box& box, int states);

/// What distances between states are measured in, one length per state: half the length of each interval of the box
/// that starts come from, but no less than a tenth of the size of the motions themselves, which need not stay in it.
/// That size is what the drive makes of one cycle from the middle of the box: half the range of x, that times omega,
/// and the range of the other states meanwhile.
flow::State distance_scale(const flow::System& system, const Box& box);

/// Start number i >= 0 of a seed, uniform in the box and independent of the others: entry k is made of output number
/// max_states i + k of splitmix64 (G. Steele, D. Lea, C. Flood, Fast splittable pseudorandom number generators, OOPSLA
/// 2014) started from mix(seed), so it is a function of (seed, i, k) alone.
flow::State start_state(const Box& box, int states, std::uint64_t seed, long i);

}  // namespace percuss::attractor
