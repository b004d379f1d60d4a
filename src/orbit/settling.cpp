#include "orbit/settling.hpp"

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

constexpr int longest_recognised = 12;
constexpr int shortest_window = 8;
constexpr double slowest_contraction = 0.9999;
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

    /// Contraction per p cycles; absent while there is too little to tell it from.
    [[nodiscard]] double contraction(int p) const {
        const int window = std::max(shortest_window, p);
        if (!reaches_back(static_cast<std::size_t>(2 * window + p - 1))) { return absent; }
        const double now = largest_change(p, 0, window);
        const double before = largest_change(p, window, window);
        return now == 0.0 ? 0.0 : std::pow(now / before, static_cast<double>(p) / window);
    }

private:
    [[nodiscard]] const flow::State& back(int ago) const {
        return ring_[(count_ - 1 - static_cast<std::size_t>(ago)) % ring_.size()];
    }
    [[nodiscard]] double largest_change(int p, int ago, int window) const {
        double largest = 0.0;
        for (int k = 0; k < window; ++k) { largest = std::max(largest, change(p, ago + k)); }
        return largest;
    }

    const flow::System& system_;
    std::array<flow::State, 64> ring_{};
    std::size_t count_ = 0;
};

void judge(const Strobes& strobes, int p, Settling& settling) {
    settling.change = strobes.change(p);
    settling.contraction = strobes.contraction(p);
    const double rho = std::min(settling.contraction, slowest_contraction);
    settling.remaining_error = std::isnan(settling.contraction) ? absent : settling.change * rho / (1.0 - rho);
}

bool is_settled(const Settling& settling, const SettlingOptions& options) {
    if (!(settling.change <= options.tolerance)) { return false; }
    return options.rule == SettlingRule::strobed_change || settling.remaining_error <= options.tolerance;
}

/// A motion of period d close to a multiplier -1 settles as one of period 2 d first. Both states are within the
/// tolerance of the orbit then, so that a change of a few times the tolerance over d cycles means period d.
int shortest_period(const Strobes& strobes, int p, double tolerance) {
    for (int d = 1; d < p; ++d) {
        if (p % d == 0 && strobes.change(d) <= 4.0 * tolerance) { return d; }
    }
    return p;
}

bool has_settled(const Strobes& strobes, const SettlingOptions& options, Settling& settling) {
    for (int p = 1; p <= options.longest_period && strobes.reaches_back(static_cast<std::size_t>(p)); ++p) {
        if (strobes.change(p) > options.tolerance) { continue; }
        judge(strobes, p, settling);
        if (is_settled(settling, options)) {
            settling.period = shortest_period(strobes, p, options.tolerance);
            return true;
        }
    }
    return false;
}

void check(const SettlingOptions& options) {
    if (!(options.tolerance > 1e-12)) { throw std::invalid_argument("settling tolerance: allowed is above 1e-12"); }
    if (options.longest_period < 1 || options.longest_period > longest_recognised) {
        throw std::invalid_argument("settling longest_period = " + std::to_string(options.longest_period) +
                                    ": allowed is 1 to " + std::to_string(longest_recognised));
    }
    if (options.max_cycles < 1) { throw std::invalid_argument("settling max_cycles: allowed is at least 1"); }
}

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
    Strobes strobes(system, start);
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
        settling.settled = has_settled(strobes, options, settling);
    }
    settling.state = strobes.last();
    if (!settling.settled) {
        settling.change = settling.contraction = settling.remaining_error = absent;
        if (settling.cycles > 0) { judge(strobes, 1, settling); }
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
    extremes.contacts = static_cast<int>(std::count_if(result.contacts.begin(), result.contacts.end(),
                                                       [](const flow::Contact& c) { return !c.open_in; }));
    return extremes;
}

}  // namespace percuss::orbit
