#include "boundary/free_branch.hpp"

#include "orbit/orbit.hpp"

#include <algorithm>
#include <cmath>
#include <complex>

namespace percuss::boundary {

using numerics::Matrix;
using numerics::SmallMatrix;
using numerics::Vector;

orbit::ReturnMap FreeBranch::map_of(const flow::System& system) {
    orbit::ReturnMap map;
    map.stop = flow::StopMode::off;
    map.mirrored = system.symmetric();
    return map;
}

/// What counts as one unit of displacement; speeds follow at resonance. Without this a resonance peak is a ripple in
/// the norm that steps are measured in, and a step can leap over it.
void FreeBranch::set_measure(double size) {
    measure_.fill(size);
    measure_[1] = size * scale_;
}

FreeBranch::FreeBranch(const flow::System& system)
    : system_(system),
      scale_(system.integrator->linear_resonance(system.parameters)),
      origin_(system.integrator->rest_state(system.parameters)),
      walker_([this](const Vector& u, Vector& f, Matrix& j) { return evaluate(u, f, j); },
              // A resonance peak is many times the static response that is one unit: steps may be 20 long, held by the
              // angle and by half a resonance of frequency. The branch is a scout's: what it meets is refined by
              // equations of its own, and 1e-5 is enough to meet it.
              {.first_step = 0.2,
               .largest_step = 20.0,
               .largest_parameter_step = 0.5,
               .target_angle = 0.2,
               .largest_angle = 0.5,
               .tolerance = 1e-5,
               .step_tolerance = 1e-5}) {
    set_measure(1.0);
}

Vector FreeBranch::to_scaled(const flow::State& y, double omega) const {
    const int n = system_.states();
    Vector u(n + 1);
    for (std::size_t k = 0; k < static_cast<std::size_t>(n); ++k) {
        u[static_cast<int>(k)] = (y[k] - origin_[k]) / measure_[k];
    }
    u[n] = omega / scale_;
    return u;
}

flow::State FreeBranch::to_state(const Vector& u) const {
    flow::State y{};
    for (std::size_t k = 0; k < static_cast<std::size_t>(system_.states()); ++k) {
        y[k] = origin_[k] + u[static_cast<int>(k)] * measure_[k];
    }
    return y;
}

bool FreeBranch::evaluate(const Vector& u, Vector& f, Matrix& jacobian) {
    const int n = system_.states();
    image_omega_ = u[n] * scale_;
    if (!(image_omega_ > 0.0)) { return false; }
    const flow::ParameterVector by_omega = orbit::unit_direction(system_.integrator->info().omega);
    image_ = orbit::apply(system_.at_omega(image_omega_), map_of(system_), to_state(u), orbit::Differentiate::all,
                          {&by_omega, 1}, flow::observe_extrema);
    if (!image_.ok()) { return false; }
    f = to_scaled(image_.state, 0.0).head(n) - u.head(n);
    jacobian = image_.derivative;
    for (int k = 0; k < n; ++k) {
        // From derivatives of states by states and frequency to scaled ones: rows are states reached, columns states
        // set out from.
        jacobian.row(k) /= measure_[static_cast<std::size_t>(k)];
        jacobian.col(k) *= measure_[static_cast<std::size_t>(k)];
    }
    jacobian.leftCols(n) -= Matrix::Identity(n, n);
    jacobian.col(n) *= scale_;
    return f.allFinite() && jacobian.allFinite();
}

FreePoint FreeBranch::describe() const {
    const int n = system_.states();
    FreePoint point;
    const Vector& u = walker_.point();
    const Vector& t = walker_.tangent();
    point.state = to_state(u);
    point.omega = u[n] * scale_;
    point.omega_slope = t[n];
    const orbit::Observed c = clearance(system_.at_omega(image_omega_), map_of(system_), image_, {});
    point.clearance = c.value;
    for (int k = 0; k < n; ++k) {
        point.clearance_slope += c.d[static_cast<std::size_t>(k)] * t[k] * measure_[static_cast<std::size_t>(k)];
    }
    point.clearance_slope += c.d[static_cast<std::size_t>(n)] * scale_ * t[n];
    // The leading multiplier tells which boundary lies where it leaves the circle: a complex one a torus, a real one a
    // fold or a flip by its sign.
    const auto values = SmallMatrix(image_.derivative.leftCols(n)).eigenvalues().eval();
    std::complex<double> leading = 0.0;
    for (int k = 0; k < values.size(); ++k) {
        if (std::abs(values[k]) > std::abs(leading)) { leading = values[k]; }
    }
    point.radius = std::abs(leading);
    point.nearest = std::abs(leading.imag()) > 1e-9 * point.radius ? Kind::torus
                  : leading.real() > 0.0                           ? Kind::fold
                                                                   : Kind::flip;
    return point;
}

bool FreeBranch::start(double omega) {
    const flow::System there = system_.at_omega(omega);
    // A few cycles from rest bring the state near enough for Newton; high above resonance the motion is small.
    flow::State guess = system_.integrator->rest_state(system_.parameters);
    const auto settled = orbit::settle(there, guess, 4, flow::StopMode::off);
    if (settled) { guess = *settled; }
    const orbit::Orbit orbit = orbit::find_orbit(there, map_of(system_), guess);
    if (!orbit.ok()) { return false; }
    // The response well above resonance, times the ratio of stiffness forces, is about the static one: peaks are told
    // by that, or by the gap where it is smaller.
    const orbit::Image image =
        orbit::apply(there, map_of(system_), orbit.state, orbit::Differentiate::nothing, {}, flow::observe_extrema);
    if (!image.ok()) { return false; }
    const double room = there.stop_position() - origin_[0];
    const double amplitude = clearance(there, map_of(system_), image, {}).value + room;
    const double ratio = omega / scale_;
    // The floor keeps the unit from vanishing where the mass rests beside the stop or hardly moves.
    set_measure(std::max(std::min(room, amplitude * std::max(1.0, ratio * ratio - 1.0)), 1e-4));
    if (!walker_.start(to_scaled(orbit.state, omega), -1.0)) { return false; }
    current_ = describe();
    previous_ = current_;
    return true;
}

bool FreeBranch::advance() {
    // A step longer than the motion is large could pass through rest, where the branches on either side of the
    // resonance meet at small losses, and go on on the wrong one.
    // High above resonance the motion is small: 0.2, the first step, is always allowed.
    walker_.limit_step(std::max(0.5 * walker_.point().head(system_.states()).norm(), 0.2));
    if (!walker_.advance()) { return false; }
    const Vector from = to_scaled(current_.state, current_.omega);
    previous_ = current_;
    current_ = describe();
    current_.arclength = previous_.arclength + (walker_.point() - from).norm();
    return true;
}

bool FreeBranch::retreat() {
    if (!walker_.retreat()) { return false; }
    current_ = previous_;
    return true;
}

}  // namespace percuss::boundary
