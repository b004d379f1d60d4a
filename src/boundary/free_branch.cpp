#include "boundary/free_branch.hpp"

#include "orbit/orbit.hpp"

#include <cmath>
#include <complex>

namespace percuss::boundary {

using numerics::SmallMatrix;
using numerics::SmallVector;

orbit::ReturnMap FreeBranch::half_cycle() {
    orbit::ReturnMap map;
    map.stop = flow::StopMode::off;
    map.mirrored = true;
    return map;
}

FreeBranch::FreeBranch(const flow::System& system)
    : system_(system),
      scale_(system.integrator->linear_resonance(system.parameters)),
      walker_([this](const SmallVector& u, SmallVector& f, SmallMatrix& j) { return evaluate(u, f, j); }, {}) {}

bool FreeBranch::evaluate(const SmallVector& u, SmallVector& f, SmallMatrix& jacobian) {
    const int n = system_.states();
    image_omega_ = u[n] * scale_;
    if (!(image_omega_ > 0.0)) { return false; }
    const flow::ParameterVector by_omega = orbit::unit_direction(system_.integrator->info().omega);
    image_ = orbit::apply(system_.at_omega(image_omega_), half_cycle(), orbit::to_state(u.head(n)),
                          orbit::Differentiate::all, {&by_omega, 1}, flow::observe_extrema);
    if (!image_.ok()) { return false; }
    f = orbit::to_vector(system_, image_.state) - u.head(n);
    jacobian = image_.derivative;
    jacobian.leftCols(n) -= SmallMatrix::Identity(n, n);
    jacobian.col(n) *= scale_;
    return f.allFinite() && jacobian.allFinite();
}

FreePoint FreeBranch::describe() const {
    const int n = system_.states();
    FreePoint point;
    const SmallVector& u = walker_.point();
    const SmallVector& t = walker_.tangent();
    point.state = orbit::to_state(u.head(n));
    point.omega = u[n] * scale_;
    point.omega_slope = t[n];
    const orbit::Observed c = clearance(system_.at_omega(image_omega_), half_cycle(), image_, {});
    point.clearance = c.value;
    for (int k = 0; k < n; ++k) { point.clearance_slope += c.d[static_cast<std::size_t>(k)] * t[k]; }
    point.clearance_slope += c.d[static_cast<std::size_t>(n)] * scale_ * t[n];
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
    const int n = system_.states();
    SmallVector u(n + 1);
    u.head(n) = orbit::to_vector(system_, guess);
    u[n] = omega / scale_;
    if (!walker_.start(u, -1.0)) { return false; }
    current_ = describe();
    previous_ = current_;
    return true;
}

bool FreeBranch::advance() {
    if (!walker_.advance()) { return false; }
    previous_ = current_;
    current_ = describe();
    return true;
}

bool FreeBranch::retreat() {
    if (!walker_.retreat()) { return false; }
    current_ = previous_;
    return true;
}

}  // namespace percuss::boundary
