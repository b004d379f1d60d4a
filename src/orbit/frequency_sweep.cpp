#include "orbit/frequency_sweep.hpp"

#include <cmath>
#include <stdexcept>

namespace percuss::orbit {

std::vector<SweptPoint> step_sweep(const flow::System& system, std::span<const double> omegas, const flow::State& start,
                                   const SettlingOptions& options,
                                   const std::function<bool(const SweptPoint&)>& on_point) {
    std::vector<SweptPoint> points;
    flow::State state = start;
    for (const double omega : omegas) {
        const flow::System here = system.at_omega(omega);
        SweptPoint point;
        point.omega = omega;
        point.settling = settle_until_repeating(here, state, options);
        state = point.settling.state;
        // Unsettled motions are watched for as long as any period that could have been recognised.
        const int watched = point.settling.settled ? point.settling.period : options.longest_period;
        if (point.settling.status == flow::Status::ok) {
            point.extremes = observe_cycles(here, state, watched, options);
        }
        points.push_back(point);
        const bool lost = point.settling.status != flow::Status::ok || point.extremes.status != flow::Status::ok;
        if ((on_point && !on_point(point)) || lost) { break; }
    }
    return points;
}

std::vector<ChirpCycle> chirp(const flow::System& system, double from, double to, int cycles, const flow::State& start,
                              const std::function<bool(const ChirpCycle&)>& on_cycle) {
    if (cycles < 1) { throw std::invalid_argument("chirp cycles: allowed is at least 1"); }
    std::vector<ChirpCycle> passed;
    flow::State state = start;
    for (int k = 0; k < cycles; ++k) {
        ChirpCycle cycle;
        cycle.omega = std::sqrt(from * from + (to * to - from * from) * (k + 0.5) / cycles);
        cycle.extremes = observe_cycles(system.at_omega(cycle.omega), state, 1);
        state = cycle.extremes.state;
        passed.push_back(cycle);
        if ((on_cycle && !on_cycle(cycle)) || cycle.extremes.status != flow::Status::ok) { break; }
    }
    return passed;
}

}  // namespace percuss::orbit
