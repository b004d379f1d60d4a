#include "flow/augmented_system.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>

namespace percuss::flow {
namespace {

constexpr std::size_t at(int i) { return static_cast<std::size_t>(i); }

/// Smallest natural size of the overlap in a held run: its rounding errors are of this order times those of one.
constexpr double smallest_overlap = 1e-6;

/// By how much a direction moves what it moves: states and the phase as they are (of order one by scaling), parameters
/// relative to their size, those below one absolutely because a parameter may be zero. One for a direction that moves
/// nothing, since tolerances are multiplied by it.
double size_of(const Direction& direction, const ParameterVector& parameters) {
    double size = std::abs(direction.phase);
    for (const double d : direction.state) { size = std::max(size, std::abs(d)); }
    for (std::size_t i = 0; i < parameters.size(); ++i) {
        size = std::max(size, std::abs(direction.parameter[i]) / std::max(std::abs(parameters[i]), 1.0));
    }
    return size > 0.0 ? size : 1.0;
}

}  // namespace

AugmentedSystem::AugmentedSystem(const RightHandSide& rhs, const ParameterVector& parameters, const Request& request)
    : rhs_(rhs),
      parameters_(parameters),
      start_(request.theta),
      states_(rhs.states()),
      lanes_(static_cast<int>(request.directions.size())) {
    int next = states_;
    if ((request.observe & observe_force) != 0U) {
        places_.impulse = next++;
        places_.stop_work = next++;
    }
    if ((request.observe & observe_energy) != 0U) {
        places_.drive_work = next++;
        places_.dissipation = next++;
    }
    for (int k = 0; k < rhs.info().means; ++k) {
        if ((request.observe & observe_mean(k)) != 0U) { places_.mean[at(k)] = next++; }
    }
    places_.count = next - states_;

    if (request.stop == StopMode::held) {
        // (x - x_stop)/duration is what a held run is asked for, so the overlap must be as accurate relative to the
        // duration as all else is relative to one.
        overlap_size_ = std::clamp(std::abs(request.duration), smallest_overlap, 1.0);
    }
    const bool has_stop = model::has_stop(rhs.contact_law());
    const std::size_t gap = at(rhs.info().gap);
    origin_ = rhs.centre(parameters) + (has_stop ? parameters[gap] : 0.0);
    for (int lane = 0; lane < lanes_; ++lane) {
        const Direction& direction = request.directions[at(lane)];
        directions_[at(lane)] = direction;
        start_lanes_[at(lane)] = direction.state;
        lane_size_[at(lane)] = size_of(direction, parameters);
        origin_d_[at(lane)] =
            rhs.centre_derivative(parameters, direction.parameter) + (has_stop ? direction.parameter[gap] : 0.0);
    }
}

bool AugmentedSystem::watches_means() const {
    return std::any_of(places_.mean.begin(), places_.mean.end(), [](int place) { return place >= 0; });
}

double AugmentedSystem::natural_size(int column, int i) const {
    return (column == 0 ? 1.0 : lane_size_[at(column - 1)]) * (i == 0 ? overlap_size_ : 1.0);
}

Extended AugmentedSystem::initial(const State& start) const {
    Extended y{};
    for (int i = 0; i < states_; ++i) {
        entry(y, 0, i) = start[at(i)];
        for (int lane = 0; lane < lanes_; ++lane) { entry(y, 1 + lane, i) = start_lanes_[at(lane)][at(i)]; }
    }
    // The surface moves with the parameters too, hence its derivatives in the lanes.
    entry(y, 0, 0) -= origin_;
    for (int lane = 0; lane < lanes_; ++lane) { entry(y, 1 + lane, 0) -= origin_d_[at(lane)]; }
    return y;
}

State AugmentedSystem::lift(const double* values) const {
    State result{};
    std::copy_n(values, states_, result.begin());
    result[0] += origin_;
    return result;
}

State AugmentedSystem::state(const State& values) const { return lift(values.data()); }

State AugmentedSystem::values(const Extended& y) const {
    State result{};
    std::copy_n(y.begin(), states_, result.begin());
    return result;
}

std::span<const Direction> AugmentedSystem::directions(const Columns& states) const {
    for (int lane = 0; lane < lanes_; ++lane) {
        Direction& direction = directions_[at(lane)];
        std::copy_n(states[at(1 + lane)], states_, direction.state.begin());
        direction.state[0] += origin_d_[at(lane)];
    }
    return {directions_.data(), at(lanes_)};
}

void AugmentedSystem::state_rate(double t, const double* values, bool touching, double* out) const {
    ++evaluations_;
    State rate{};
    rhs_.rate(parameters_, phase(t), lift(values), touching, rate);
    std::copy_n(rate.begin(), states_, out);
}

void AugmentedSystem::state_rates(double t, const Columns& states, bool touching, const MutableColumns& out) const {
    ++evaluations_;
    State rate{};
    std::array<State, at(max_lanes)> rate_d{};
    rhs_.rates(parameters_, phase(t), lift(states[0]), touching, directions(states), rate, rate_d.data());
    std::copy_n(rate.begin(), states_, out[0]);
    for (int lane = 0; lane < lanes_; ++lane) { std::copy_n(rate_d[at(lane)].begin(), states_, out[at(1 + lane)]); }
}

void AugmentedSystem::integral_rate(double t, const double* values, bool touching, double* out) const {
    // Integrals are over tau, the independent variable is theta: d(tau) = d(theta)/omega.
    const double per_phase = 1.0 / omega();
    if (places_.impulse >= 0) {
        const double force = touching ? stiffness() * values[0] + damping() * values[1] : 0.0;
        out[places_.impulse - states_] = force * per_phase;
        out[places_.stop_work - states_] = force * values[1] * per_phase;
    }
    if (places_.drive_work >= 0) {
        Powers power;
        rhs_.powers(parameters_, phase(t), lift(values), {}, power, nullptr);
        out[places_.drive_work - states_] = power.drive * per_phase;
        out[places_.dissipation - states_] = power.loss * per_phase;
    }
    if (watches_means()) {
        Means mean{};
        rhs_.means(parameters_, phase(t), lift(values), {}, mean, nullptr);
        for (std::size_t k = 0; k < mean.size(); ++k) {
            if (places_.mean[k] >= 0) { out[places_.mean[k] - states_] = mean[k] * per_phase; }
        }
    }
}

void AugmentedSystem::integral_rates(double t, const Columns& states, bool touching, const MutableColumns& out) const {
    // d(rate/omega) = d(rate)/omega - (rate/omega) d(omega)/omega, whose last factor is `slowing` below.
    const double per_phase = 1.0 / omega();
    const double* y = states[0];
    if (places_.impulse >= 0) {
        const int impulse = places_.impulse - states_;
        const int work = places_.stop_work - states_;
        const double force = touching ? stiffness() * y[0] + damping() * y[1] : 0.0;
        out[0][impulse] = force * per_phase;
        out[0][work] = force * y[1] * per_phase;
        for (int lane = 0; lane < lanes_; ++lane) {
            const double* d = states[at(1 + lane)];
            double* rate = out[at(1 + lane)];
            const double force_d =
                touching ? stiffness_d(lane) * y[0] + stiffness() * d[0] + damping_d(lane) * y[1] + damping() * d[1]
                         : 0.0;
            const double slowing = omega_d(lane) * per_phase;
            rate[impulse] = force_d * per_phase - out[0][impulse] * slowing;
            rate[work] = (force_d * y[1] + force * d[1]) * per_phase - out[0][work] * slowing;
        }
    }
    if (places_.drive_work >= 0) {
        const int drive = places_.drive_work - states_;
        const int loss = places_.dissipation - states_;
        Powers power;
        std::array<Powers, at(max_lanes)> power_d{};
        rhs_.powers(parameters_, phase(t), lift(y), directions(states), power, power_d.data());
        out[0][drive] = power.drive * per_phase;
        out[0][loss] = power.loss * per_phase;
        for (int lane = 0; lane < lanes_; ++lane) {
            double* rate = out[at(1 + lane)];
            const double slowing = omega_d(lane) * per_phase;
            rate[drive] = power_d[at(lane)].drive * per_phase - out[0][drive] * slowing;
            rate[loss] = power_d[at(lane)].loss * per_phase - out[0][loss] * slowing;
        }
    }
    if (watches_means()) {
        Means mean{};
        std::array<Means, at(max_lanes)> mean_d{};
        rhs_.means(parameters_, phase(t), lift(y), directions(states), mean, mean_d.data());
        for (std::size_t k = 0; k < mean.size(); ++k) {
            if (places_.mean[k] < 0) { continue; }
            const int place = places_.mean[k] - states_;
            out[0][place] = mean[k] * per_phase;
            for (int lane = 0; lane < lanes_; ++lane) {
                const double slowing = omega_d(lane) * per_phase;
                out[at(1 + lane)][place] = mean_d[at(lane)][k] * per_phase - out[0][place] * slowing;
            }
        }
    }
}

void AugmentedSystem::rates(double t, const double* y, bool touching, double* out) const {
    Columns states{};
    MutableColumns state_out{};
    MutableColumns integral_out{};
    for (int c = 0; c < columns(); ++c) {
        states[at(c)] = y + c * block();
        state_out[at(c)] = out + c * block();
        integral_out[at(c)] = out + c * block() + states_;
    }
    if (lanes_ == 0) {
        state_rate(t, y, touching, out);
        integral_rate(t, y, touching, out + states_);
        return;
    }
    state_rates(t, states, touching, state_out);
    if (places_.count > 0) { integral_rates(t, states, touching, integral_out); }
}

void AugmentedSystem::jacobian(double t, const double* values, bool touching, double* out) const {
    ++evaluations_;
    // One direction per state: the exact derivative, for the corrector of an implicit method.
    std::array<Direction, at(max_states)> unit{};
    for (int i = 0; i < states_; ++i) { unit[at(i)].state[at(i)] = 1.0; }
    State rate{};
    std::array<State, at(max_states)> rate_d{};
    rhs_.rates(parameters_, phase(t), lift(values), touching, {unit.data(), at(states_)}, rate, rate_d.data());
    for (int column = 0; column < states_; ++column) {
        std::copy_n(rate_d[at(column)].begin(), states_, out + column * states_);
    }
}

}  // namespace percuss::flow
