#include "boundary/boundary.hpp"

#include "boundary/critical.hpp"

#include <cmath>
#include <complex>

namespace percuss::boundary {
namespace {

using orbit::Observed;

/// Whether the largest displacement counts, or the smallest, which in the other half cycle is a largest.
bool reaches_furthest_above(const flow::System& system, const orbit::ReturnMap& map, const orbit::Image& image) {
    const double centre = system.integrator->centre(system.parameters);
    const double above = image.observed[orbit::x_max].value - centre;
    const double below = centre - image.observed[orbit::x_min].value;
    return !map.mirrored || above >= below;
}

/// Argument of the complex multiplier of the map nearest the unit circle; 0 where all are real.
double angle_nearest_circle(const flow::System& system, const orbit::ReturnMap& map, const flow::State& y) {
    const orbit::Image image = orbit::apply(system, map, y, orbit::Differentiate::state);
    if (!image.ok()) { return 0.0; }
    double angle = 0.0;
    double nearest = numerics::unlimited;
    const auto values = numerics::SmallMatrix(image.derivative).eigenvalues().eval();
    for (const std::complex<double>& mu : values) {
        const double distance = std::abs(std::abs(mu) - 1.0);
        // One of each complex pair, none of the real ones.
        if (mu.imag() > 1e-12 && distance < nearest) {
            nearest = distance;
            angle = std::arg(mu);
        }
    }
    return angle;
}

/// How the boundaries of a map are solved for: in its own units, a state and a frequency of order one.
CriticalOptions options_near(const flow::System& system, double omega) {
    CriticalOptions options;
    options.scaled = false;
    options.newton.max_iterations = 20;
    options.newton.max_step_is_relative = true;
    options.newton.unknowns_in_scale = system.states();
    // After a step of 1e-9 the next would be of rounding size; a fold's differences leave 1e-8 in the Jacobian.
    options.newton.step_tolerance = 1e-9;
    options.newton.residual_tolerance = 1e-8;
    // The first evaluation is without the directions: a solution is not taken from it.
    options.newton.min_iterations = 2;
    // An edge is solved for at every design: its directions ride along with the last iteration instead of one more.
    options.directions_join_below = 1e-3;
    // The guess lies within a step of the branch: Newton's method that has gone five times as far in frequency will not
    // come back to this boundary.
    options.lowest = 0.2 * omega;
    options.highest = 5.0 * omega;
    return options;
}

}  // namespace

std::string_view to_string(Kind kind) {
    switch (kind) {
        case Kind::none: return "none";
        case Kind::grazing: return "grazing";
        case Kind::fold: return "fold";
        case Kind::flip: return "flip";
        case Kind::torus: return "torus";
    }
    return "none";
}

orbit::Observed clearance(const flow::System& system, const orbit::ReturnMap& map, const orbit::Image& image,
                          std::span<const flow::ParameterVector> directions) {
    const double centre = system.integrator->centre(system.parameters);
    const bool use_maximum = reaches_furthest_above(system, map, image);
    const double sign = use_maximum ? 1.0 : -1.0;
    const Observed& extreme = image.observed[use_maximum ? orbit::x_max : orbit::x_min];
    Observed result;
    result.value = sign * (extreme.value - centre) - (system.stop_position() - centre);
    for (std::size_t c = 0; c < extreme.d.size(); ++c) { result.d[c] = sign * extreme.d[c]; }
    for (std::size_t i = 0; i < directions.size(); ++i) {
        // d [sign (x - centre) - (stop - centre)]: what the centre and the stop move by, beside x.
        const double dc = system.integrator->centre_derivative(system.parameters, directions[i]);
        const double ds = system.integrator->stop_position_derivative(system.parameters, directions[i]);
        result.d[static_cast<std::size_t>(system.states()) + i] += -sign * dc - (ds - dc);
    }
    return result;
}

double phase_of_clearance(const flow::System& system, const orbit::ReturnMap& map, const orbit::Image& image) {
    return reaches_furthest_above(system, map, image) ? image.theta_x_max : image.theta_x_min + map.duration();
}

Boundary solve_boundary(const flow::System& system, const orbit::ReturnMap& map, Kind kind, const flow::State& guess,
                        double omega, std::span<const flow::ParameterVector> directions) {
    const flow::ParameterFamily family = flow::along_frequency(system, 1.0);
    const orbit::Motion motion = orbit::motion_of_map(map, guess);
    // The angle is an unknown of the torus: its guess is that of the pair at the guessed orbit.
    const double angle = kind == Kind::torus ? angle_nearest_circle(system.at_omega(omega), map, guess) : 0.0;
    const CriticalPoint point =
        solve_critical(family, kind, motion, omega, 0, angle, 1.0, directions, options_near(system, omega));
    Boundary boundary;
    boundary.status = point.status;
    boundary.kind = kind;
    boundary.omega = point.parameter;
    boundary.state = point.motion.state;
    boundary.theta_contact = point.theta_contact;
    boundary.residual = point.residual;
    boundary.iterations = point.iterations;
    boundary.d_omega = point.d_parameter;
    for (Eigen::Index i = 0; i < point.d_unknowns.cols(); ++i) {
        boundary.d_state.push_back(orbit::to_state(point.d_unknowns.col(i)));
    }
    return boundary;
}

}  // namespace percuss::boundary
