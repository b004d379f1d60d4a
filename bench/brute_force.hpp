#pragma once
/// \file
/// Where random starts lead, found the plain way: draw them, follow each for many drive cycles, look whether it has
/// arrived at the orbit. Shares no code with src/attractor: its own box, its own generator, no traps, no Newton.

#include "flow/flow.hpp"
#include "model/membrane/membrane.hpp"
#include "model/spring/spring.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <numbers>
#include <random>
#include <span>
#include <vector>

namespace percuss::bench {

struct BruteForceOptions {
    long starts = 128;
    std::uint64_t seed = 1;
    int cycles = 320;         ///< of every start, looked at every 16;
    int more_cycles = 20000;  ///< of those that have not arrived by then, looked at every 160
    double arrived = 1e-5;    ///< largest difference of a state to the orbit's, in units of half the box
};

struct BruteForce {
    long starts = 0;
    long elsewhere = 0;     ///< did not arrive within all cycles,
    long approaching = 0;   ///< of these: on their way still, nearer at the end than half way and within 1 % of the box
    long lost = 0;          ///< could not be followed: chatter, divergence
    long late = 0;          ///< arrived after the first `cycles` only
    flow::State example{};  ///< end of the first one elsewhere
    flow::State from{};     ///< and where it was started
    double seconds = 0.0;
    [[nodiscard]] double share() const {
        return starts > 0 ? static_cast<double>(elsewhere + lost) / static_cast<double>(starts) : 0.0;
    }
};

struct StartBox {
    flow::State lower{};
    flow::State upper{};
};

/// Of the dielectric elastomer actuator: with A the larger of gap and half the stroke, x from l/2 - 2 A to the stop, x'
/// within 2 omega A, xi_I and xi_II from lambda_p to lambda_p sqrt(1 + (l/2 + 2 A)^2).
inline StartBox start_box(const flow::ParameterVector& p, double half_stroke) {
    const double centre = 0.5 * p[model::membrane::length];
    const double gap = p[model::membrane::gap];
    const double reach = 2.0 * std::max(gap, half_stroke);
    const double speed = reach * p[model::membrane::omega];
    const double flat = p[model::membrane::lambda_p];
    const double farthest = flat * std::hypot(1.0, centre + reach);
    return {{centre - reach, -speed, flat, flat}, {centre + gap, speed, farthest, farthest}};
}

namespace brute_force {

struct Follower {
    flow::State from{};
    flow::State state{};
    double half_way = 0.0;  ///< distance
    double distance = 0.0;
};

inline double distance(const flow::State& a, const flow::State& b, const StartBox& box) {
    double largest = 0.0;
    for (std::size_t k = 0; k < a.size(); ++k) {
        const double d = std::abs(a[k] - b[k]) / (0.5 * (box.upper[k] - box.lower[k]));
        if (!(d <= largest)) { largest = d; }
    }
    return largest;
}

inline std::vector<Follower> draw(const StartBox& box, const BruteForceOptions& options) {
    std::mt19937_64 generator(options.seed);
    std::uniform_real_distribution<double> share(0.0, 1.0);
    std::vector<Follower> list(static_cast<std::size_t>(options.starts));
    for (Follower& follower : list) {
        for (std::size_t k = 0; k < follower.from.size(); ++k) {
            follower.from[k] = box.lower[k] + share(generator) * (box.upper[k] - box.lower[k]);
        }
        follower.state = follower.from;
    }
    return list;
}

/// All of them over some cycles; those that cannot be followed leave, those that have arrived too.
inline void advance(const flow::System& system, const flow::State& orbit, const StartBox& box, double arrived,
                    int cycles, std::vector<Follower>& live, BruteForce& found) {
    std::vector<flow::State> states;
    for (const Follower& follower : live) { states.push_back(follower.state); }
    std::vector<flow::EnsembleMember> members(states.size());
    flow::EnsembleRequest request;
    request.states = states;
    request.duration = 2.0 * std::numbers::pi * cycles;
    request.max_events = 256 * cycles;
    request.max_steps = 200000L * cycles;
    system.integrator->run_ensemble(system.parameters, request, members);
    std::vector<Follower> kept;
    for (std::size_t i = 0; i < live.size(); ++i) {
        if (members[i].status != flow::Status::ok) {
            if (found.lost + found.elsewhere == 0) { found.from = live[i].from; }
            ++found.lost;
            continue;
        }
        live[i].state = members[i].state;
        live[i].distance = distance(live[i].state, orbit, box);
        if (!(live[i].distance < arrived)) { kept.push_back(live[i]); }
    }
    live = std::move(kept);
}

}  // namespace brute_force

/// `orbit`: state at theta = 0 of a motion of one drive cycle.
inline BruteForce follow_by_brute_force(const flow::System& system, const flow::State& orbit, const StartBox& box,
                                        const BruteForceOptions& options) {
    using namespace brute_force;
    constexpr int often = 16;
    constexpr int seldom = 160;
    constexpr double near = 1e-2;
    BruteForce found;
    found.starts = options.starts;
    std::vector<Follower> live = draw(box, options);
    int cycle = 0;
    for (; cycle < options.cycles && !live.empty(); cycle += often) {
        advance(system, orbit, box, options.arrived, often, live, found);
    }
    const std::size_t slow = live.size();
    const long lost = found.lost;
    const int half_way = cycle + options.more_cycles / 2;
    for (const int end = cycle + options.more_cycles; cycle < end && !live.empty(); cycle += seldom) {
        advance(system, orbit, box, options.arrived, seldom, live, found);
        if (cycle < half_way) {
            for (Follower& follower : live) { follower.half_way = follower.distance; }
        }
    }
    for (const Follower& follower : live) {
        if (follower.distance < near && follower.distance < 0.9 * follower.half_way) { ++found.approaching; }
    }
    found.elsewhere = static_cast<long>(live.size());
    found.late = static_cast<long>(slow - live.size()) - (found.lost - lost);
    if (!live.empty()) {
        found.example = live.front().state;
        found.from = live.front().from;
    }
    return found;
}

}  // namespace percuss::bench
