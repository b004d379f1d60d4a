#include "orbit/settling.hpp"

#include "orbit/return_map.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>
#include <stdexcept>
#include <string>

namespace percuss::orbit {
namespace {

using std::numbers::pi;

/// Drive cycles; the ring of strobed states holds so many and the present one.
constexpr int longest_recognised = 12;
constexpr double absent = std::numeric_limits<double>::quiet_NaN();

/// The last strobed states, and what their changes tell.
class Strobes {
public:
    Strobes(const flow::System& system, const flow::State& start) : system_(system) { push(start); }

    void push(const flow::State& state) { ring_[(count_++) % ring_.size()] = state; }
    [[nodiscard]] const flow::State& last() const { return back(0); }
    [[nodiscard]] bool reaches_back(std::size_t cycles) const { return count_ > cycles; }

    /// Change over p cycles as it was `ago` cycles ago.
    [[nodiscard]] double change(int p, int ago = 0) const {
        return relative_distance(system_, back(ago + p), back(ago));
    }

private:
    [[nodiscard]] const flow::State& back(int ago) const {
        return ring_[(count_ - 1 - static_cast<std::size_t>(ago)) % ring_.size()];
    }

    const flow::System& system_;
    std::array<flow::State, longest_recognised + 1> ring_{};
    std::size_t count_ = 0;
};

/// How far a state is from the orbit of p cycles next to it, by one Newton step, and the largest multiplier there.
struct Distance {
    double error = absent;
    double contraction = absent;
};

/// error: |(I - M)^-1 (P(y) - y)| relative to 1 + |y|, nondimensional, with P the map of p cycles and M its derivative
/// at y; contraction: the spectral radius of M. Both absent when the flow failed.
Distance distance_from_orbit(const flow::System& system, const flow::State& state, int p) {
    ReturnMap map;
    map.period = p;
    const Image image = apply(system, map, state, Differentiate::state);
    if (!image.ok()) { return {}; }
    const int n = system.states();
    const numerics::SmallMatrix monodromy = image.derivative.leftCols(n);
    const numerics::SmallVector y = to_vector(system, state);
    const numerics::SmallMatrix jacobian = numerics::SmallMatrix::Identity(n, n) - monodromy;
    const numerics::SmallVector step = jacobian.partialPivLu().solve(to_vector(system, image.state) - y);
    return {step.norm() / (1.0 + y.norm()), monodromy.eigenvalues().cwiseAbs().maxCoeff()};
}

/// A motion of period d that rotates about its orbit (multipliers near a root of unity) comes back after some p > d
/// cycles sooner than after d. It is as near to the orbit after each of its cycles, so that its changes over d cycles
/// are a few times the tolerance.
int shortest_period(const Strobes& strobes, int p, double tolerance) {
    constexpr double few = 10.0;
    for (int d = 1; d < p; ++d) {
        if (p % d == 0 && strobes.change(d) <= few * tolerance) { return d; }
    }
    return p;
}

/// Judges a motion after every cycle.
class Judge {
public:
    Judge(const flow::System& system, const SettlingOptions& options) : system_(system), options_(options) {}

    /// Whether the motion has settled, which fills in what is known of it.
    bool has_settled(const Strobes& strobes, Settling& settling) {
        for (int p = 1; p <= options_.longest_period && strobes.reaches_back(static_cast<std::size_t>(p)); ++p) {
            settling.change = strobes.change(p);
            if (settling.change <= options_.tolerance && is_near(strobes, p, settling)) {
                settling.period = shortest_period(strobes, p, options_.tolerance);
                if (settling.period < p && options_.rule == SettlingRule::remaining_error) {
                    const Distance distance = distance_from_orbit(system_, strobes.last(), settling.period);
                    settling.contraction = distance.contraction;
                }
                return true;
            }
        }
        return false;
    }

private:
    /// By the rule of the options; looks at the remaining error only when it may have become small enough.
    bool is_near(const Strobes& strobes, int p, Settling& settling) {
        if (options_.rule == SettlingRule::strobed_change) { return true; }
        int& next = next_look_[static_cast<std::size_t>(p)];
        if (settling.cycles < next) { return false; }
        const Distance distance = distance_from_orbit(system_, strobes.last(), p);
        settling.contraction = distance.contraction;
        settling.remaining_error = distance.error;
        const bool stable = distance.contraction < 1.0;
        if (stable && distance.error <= options_.tolerance) { return true; }
        // Beside an unstable orbit the motion only passes: nothing tells for how long, so it is looked at again after
        // one period.
        next = settling.cycles + p * (stable ? periods_to_go(distance) : 1);
        return false;
    }

    /// Looking costs several cycles; it is worth while again when the error may have shrunk enough.
    [[nodiscard]] int periods_to_go(const Distance& distance) const {
        // The error shrinks by the largest multiplier each period. 0.9: rather a little early. At most 50: far from the
        // orbit neither number holds for longer, and without a bound a multiplier beside 1 would put the next look off
        // for ever.
        const double periods = std::log(options_.tolerance / distance.error) / std::log(distance.contraction);
        return static_cast<int>(std::clamp(std::ceil(0.9 * periods), 1.0, 50.0));
    }

    const flow::System& system_;
    const SettlingOptions& options_;
    std::array<int, longest_recognised + 1> next_look_{};
};

void check(const SettlingOptions& options) {
    // Strobed states carry the rounding of a whole cycle: changes below this are never reached reliably.
    if (!(options.tolerance > 1e-12)) { throw std::invalid_argument("settling tolerance: allowed is above 1e-12"); }
    if (options.longest_period < 1 || options.longest_period > longest_recognised) {
        throw std::invalid_argument("settling longest_period = " + std::to_string(options.longest_period) +
                                    ": allowed is 1 to " + std::to_string(longest_recognised));
    }
    if (options.max_cycles < 1) { throw std::invalid_argument("settling max_cycles: allowed is at least 1"); }
}

/// So many drive cycles from phase 0, with the limits of the options for each.
flow::Request cycles_from(const flow::State& state, int cycles, const SettlingOptions& options) {
    flow::Request request;
    request.state = state;
    request.duration = 2.0 * pi * cycles;
    request.max_events = options.max_events * cycles;
    request.max_steps = options.max_steps_per_cycle * cycles;
    return request;
}

}  // namespace

double relative_distance(const flow::System& system, const flow::State& a, const flow::State& b) {
    double difference = 0.0;
    double norm = 0.0;
    for (std::size_t k = 0; k < static_cast<std::size_t>(system.states()); ++k) {
        difference += (a[k] - b[k]) * (a[k] - b[k]);
        norm += b[k] * b[k];
    }
    return std::sqrt(difference) / (1.0 + std::sqrt(norm));
}

Settling settle_until_repeating(const flow::System& system, const flow::State& start, const SettlingOptions& options) {
    check(options);
    Settling settling;
    settling.status = flow::Status::ok;
    settling.contraction = settling.remaining_error = absent;
    Strobes strobes(system, start);
    Judge judge(system, options);
    flow::Request request = cycles_from(start, 1, options);
    flow::Result result;
    while (!settling.settled && settling.cycles < options.max_cycles) {
        request.state = strobes.last();
        system.run(request, result);
        if (result.status != flow::Status::ok) {
            settling.status = result.status;
            break;
        }
        strobes.push(result.state);
        ++settling.cycles;
        settling.settled = judge.has_settled(strobes, settling);
    }
    settling.state = strobes.last();
    if (!settling.settled) {
        settling.contraction = settling.remaining_error = absent;
        settling.change = settling.cycles > 0 ? strobes.change(1) : absent;
    }
    return settling;
}

Extremes observe_cycles(const flow::System& system, const flow::State& start, int cycles,
                        const SettlingOptions& options) {
    flow::Request request = cycles_from(start, cycles, options);
    request.observe = flow::observe_extrema | flow::observe_force;
    flow::Result result;
    system.run(request, result);
    Extremes extremes;
    extremes.status = result.status;
    extremes.state = result.state;
    extremes.x_max = result.observables.x_max.value;
    extremes.x_min = result.observables.x_min.value;
    extremes.peak_force = result.observables.peak_force.value;
    // A contact that was open at the beginning was counted in the cycle before.
    extremes.contacts = static_cast<int>(std::count_if(result.contacts.begin(), result.contacts.end(),
                                                       [](const flow::Contact& c) { return !c.open_in; }));
    return extremes;
}

}  // namespace percuss::orbit
