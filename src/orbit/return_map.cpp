#include "orbit/return_map.hpp"

#include <algorithm>
#include <numbers>
#include <stdexcept>

namespace percuss::orbit {
namespace {

using std::numbers::pi;

/// Observables in the order of ObservableIndex, up to those of the system's own signals.
constexpr std::array<flow::Sensitive flow::Observables::*, first_peak> members = {
    &flow::Observables::x_max,        &flow::Observables::x_min,
    &flow::Observables::peak_force,   &flow::Observables::impact_velocity,
    &flow::Observables::contact_time, &flow::Observables::impulse,
    &flow::Observables::stop_work,    &flow::Observables::peak_acceleration,
    &flow::Observables::drive_work,   &flow::Observables::dissipation};

const flow::Sensitive& observable(const flow::Observables& all, std::size_t i) {
    if (i < first_peak) { return all.*members[i]; }
    return i < first_mean ? all.peak[i - first_peak] : all.mean[i - first_mean];
}

std::size_t index(int i) { return static_cast<std::size_t>(i); }

/// Copies the derivatives of one block of lanes into the columns they belong to.
void collect(const flow::Result& result, int states, int first, int lanes, std::uint32_t observe, Image& image) {
    for (int lane = 0; lane < lanes; ++lane) {
        for (int k = 0; k < states; ++k) { image.derivative(k, first + lane) = result.state_d[index(k)][index(lane)]; }
        if (observe == flow::observe_nothing) { continue; }
        for (std::size_t q = 0; q < observable_count; ++q) {
            image.observed[q].d[index(first + lane)] = observable(result.observables, q).d[index(lane)];
        }
    }
}

/// The image and everything with it replaced by its mirror image about the centre: x -> 2 centre - x, internal states
/// exchanged or with their sign changed, as the actuator's table says. The centre may move with the parameters.
void apply_mirror(const flow::System& system, std::span<const flow::ParameterVector> directions, Image& image) {
    const flow::SystemInfo& info = system.integrator->info();
    const flow::State y = image.state;
    const flow::State rate = image.rate;
    const auto d = image.derivative;
    const double centre = system.integrator->centre(system.parameters);
    for (int k = 0; k < info.states; ++k) {
        const int from = k < 2 ? k : info.mirror[index(k)];
        const double sign = info.mirror_sign[index(k)];
        image.state[index(k)] = sign * y[index(from)] + (k == 0 ? 2.0 * centre : 0.0);
        image.rate[index(k)] = sign * rate[index(from)];
        image.derivative.row(k) = sign * d.row(from);
    }
    for (std::size_t i = 0; i < directions.size() && info.states + static_cast<int>(i) < image.derivative.cols(); ++i) {
        image.derivative(0, info.states + static_cast<int>(i)) +=
            2.0 * system.integrator->centre_derivative(system.parameters, directions[i]);
    }
}

}  // namespace

double ReturnMap::duration() const { return mirrored ? pi : 2.0 * pi * period; }

Image apply(const flow::System& system, const ReturnMap& map, const flow::State& y, Differentiate differentiate,
            std::span<const flow::ParameterVector> directions, std::uint32_t observe) {
    if (directions.size() > max_directions) { throw std::invalid_argument("return map: more than 24 directions"); }
    if (map.mirrored && map.stop != flow::StopMode::off) {
        throw std::invalid_argument("return map: only the free system has the mirror symmetry");
    }
    const int states = system.states();
    const int columns = differentiate == Differentiate::nothing ? 0
                      : differentiate == Differentiate::state   ? states
                                                                : states + static_cast<int>(directions.size());
    Image image;
    image.derivative.setZero(states, columns);
    flow::Request request;
    request.state = y;
    request.theta = map.phase;
    request.duration = map.duration();
    request.stop = map.stop;
    request.observe = observe;
    request.full_derivatives = map.precise;
    // A cap, so that chatter ends with a status instead of without end.
    request.max_events = 256 * std::max(1, map.period);
    flow::Result result;
    // At most max_lanes columns in one run, so more take several; without columns there is still one run. Step control
    // sees the lanes, so the values of two blocks may differ in their last digits: those of the last one are kept.
    for (int first = 0; first == 0 || first < columns; first += flow::max_lanes) {
        std::array<flow::Direction, flow::max_lanes> block{};
        const int lanes = std::min(flow::max_lanes, columns - first);
        for (int lane = 0; lane < lanes; ++lane) {
            const int column = first + lane;
            if (column < states) {
                block[index(lane)].state[index(column)] = 1.0;
            } else {
                block[index(lane)].parameter = directions[index(column - states)];
            }
        }
        request.directions = std::span(block.data(), index(std::max(lanes, 0)));
        system.run(request, result);
        image.status = result.status;
        if (!image.ok()) { return image; }
        collect(result, states, first, lanes, observe, image);
    }
    image.state = result.state;
    image.rate = result.rate;
    for (std::size_t q = 0; q < observable_count; ++q) {
        image.observed[q].value = observable(result.observables, q).value;
    }
    image.theta_x_max = result.observables.theta_x_max;
    image.theta_x_min = result.observables.theta_x_min;
    image.runner_up_force = result.observables.runner_up_force;
    image.contacts = std::move(result.contacts);
    if (map.mirrored) { apply_mirror(system, directions, image); }
    return image;
}

flow::State mirror(const flow::System& system, const flow::State& y) {
    Image image;
    image.state = y;
    image.derivative.setZero(system.states(), 0);
    apply_mirror(system, {}, image);
    return image.state;
}

numerics::SmallVector to_vector(const flow::System& system, const flow::State& y) {
    numerics::SmallVector v(system.states());
    for (int k = 0; k < system.states(); ++k) { v[k] = y[index(k)]; }
    return v;
}

flow::State to_state(const numerics::SmallVector& v) {
    flow::State y{};
    for (int k = 0; k < v.size(); ++k) { y[index(k)] = v[k]; }
    return y;
}

flow::ParameterVector unit_direction(int i) {
    flow::ParameterVector direction{};
    direction[index(i)] = 1.0;
    return direction;
}

}  // namespace percuss::orbit
