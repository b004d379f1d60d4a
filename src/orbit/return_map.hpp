#pragma once
/// \file
/// The map whose fixed points are periodic orbits: n drive cycles of the flow, or half a cycle followed by the mirror
/// symmetry of the free system. With exact derivatives with respect to the state and to parameter directions.

#include "flow/flow.hpp"
#include "numerics/linear.hpp"

#include <array>
#include <span>
#include <vector>

namespace percuss::orbit {

/// At most this many parameter directions in one call: all keys of an actuator, and the frequency.
inline constexpr int max_directions = 24;
inline constexpr int max_columns = flow::max_states + max_directions;

struct ReturnMap {
    flow::StopMode stop = flow::StopMode::hybrid;
    double phase = 0.0;     ///< strobe phase theta
    int period = 1;         ///< drive cycles; ignored when mirrored
    bool precise = false;   ///< derivatives to full accuracy rather than what Newton's method needs
    bool mirrored = false;  ///< half a drive cycle, then the mirror image (free system only)
    [[nodiscard]] double duration() const;
};

/// An observable with derivatives: columns 0..states-1 with respect to the initial state, then one per direction.
struct Observed {
    double value = 0.0;
    std::array<double, max_columns> d{};
};

enum ObservableIndex : std::uint8_t {
    x_max,
    x_min,
    peak_force,
    impact_velocity,
    contact_time,
    impulse,
    stop_work,
    peak_acceleration,
    drive_work,
    dissipation,
    first_peak,  ///< the system's peak signals, then its mean signals
    first_mean = first_peak + model::max_peaks,
    observable_count = first_mean + model::max_means
};

/// Image of a point with derivatives; columns as for Observed.
struct Image {
    flow::Status status = flow::Status::not_run;
    flow::State state{};
    Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::ColMajor, flow::max_states, max_columns> derivative;
    flow::State rate{};  ///< d(image)/d(theta) at the end (mirrored like the state)
    std::array<Observed, observable_count> observed{};
    std::vector<flow::Contact> contacts;
    double theta_x_max = 0.0;
    double theta_x_min = 0.0;
    double runner_up_force = 0.0;
    [[nodiscard]] bool ok() const { return status == flow::Status::ok; }
};

/// What is differentiated: nothing, the state, or the state and the given parameter directions.
enum class Differentiate : std::uint8_t { nothing, state, all };

Image apply(const flow::System& system, const ReturnMap& map, const flow::State& y, Differentiate differentiate,
            std::span<const flow::ParameterVector> directions = {}, std::uint32_t observe = flow::observe_nothing);

/// Mirror image of a state under the symmetry of the free system.
flow::State mirror(const flow::System& system, const flow::State& y);

/// State as a vector of the system's dimension and back.
numerics::SmallVector to_vector(const flow::System& system, const flow::State& y);
flow::State to_state(const numerics::SmallVector& v);

/// Unit direction of one parameter.
flow::ParameterVector unit_direction(int index);

}  // namespace percuss::orbit
