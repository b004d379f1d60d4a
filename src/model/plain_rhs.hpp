#pragma once
/// \file
/// The equations of motion written as they are printed (with the signs corrected), for the integrators that work
/// point by point and as an independent check of the Taylor recurrences. Derivatives are with respect to the drive
/// phase theta = omega tau; everything is nondimensional.

#include "model/parameters.hpp"

#include <cmath>

namespace percuss::model {

/// Force of the stop law at (x, x'), nondimensional. `touching` says that the stop acts, which the caller knows from
/// the events; inside, no_tension still cuts at zero unless `held`.
template <class T>
T stop_force(const T& x, const T& v, const T& x_stop, const T& k, const T& delta) {
    return k * (x - x_stop) + delta * v;
}

/// Force of one membrane, f(u, u', xi, phi) (paper eq. (10) with the exponents of eq. (5b)).
/// u: displacement from the membrane's own plane, v: its rate, xi: stretch of the Maxwell spring's dashpot.
template <class T>
T membrane_force(const T* p, const T& u, const T& v, const T& xi, const T& phi) {
    using std::pow;
    using std::sqrt;
    const T& lp = p[membrane::lambda_p];
    const T& aa = p[membrane::alpha_a];
    const T& ab = p[membrane::alpha_b];
    const T s = 1.0 + u * u;
    const T elastic =
        u / pow(lp, 2.0 * aa + 2.0) * (pow(lp, 3.0 * aa) * pow(s, 0.5 * aa - 1.0) - pow(s, -0.5 * aa - 1.0));
    const T viscous =
        p[membrane::mu_ratio] * u / pow(lp, ab + 2.0) *
        (pow(lp, 2.0 * ab) * pow(s, 0.5 * ab - 1.0) * pow(xi, -ab) - pow(s, -0.5 * ab - 1.0) * pow(xi, ab));
    const T damping = p[membrane::delta_a] * u * u / (s * sqrt(s)) * v;
    return elastic + viscous + damping - u * phi * phi;
}

/// d xi / d tau (paper eq. (11) with general alpha_B).
template <class T>
T dashpot_rate(const T* p, const T& u, const T& xi) {
    using std::pow;
    using std::sqrt;
    const T& ab = p[membrane::alpha_b];
    const T ratio = pow(p[membrane::lambda_p] * sqrt(1.0 + u * u) / xi, ab);
    return xi / p[membrane::delta_b] * (ratio - 0.5 / ratio - 0.5);
}

/// d(state)/d(theta) of the dielectric elastomer actuator. state and out: 4 entries; p: membrane::count entries.
template <class T>
void membrane_rhs(const T* p, const T& theta, const T* state, bool touching, T* out) {
    using std::cos;
    const T& l = p[membrane::length];
    const T c = cos(theta);
    const T phi_1 = 0.5 * p[membrane::voltage] * (1.0 - c);
    const T phi_2 = 0.5 * p[membrane::voltage] * (1.0 + c);
    const T u_2 = state[0] - l;
    T acceleration = -p[membrane::layers] * (membrane_force(p, state[0], state[1], state[2], phi_1) +
                                             membrane_force(p, u_2, state[1], state[3], phi_2));
    if (touching) {
        const T x_stop = 0.5 * l + p[membrane::gap];
        acceleration -= stop_force(state[0], state[1], x_stop, p[membrane::stiffness], p[membrane::damping]);
    }
    const T& w = p[membrane::omega];
    out[0] = state[1] / w;
    out[1] = acceleration / w;
    out[2] = dashpot_rate(p, state[0], state[2]) / w;
    out[3] = dashpot_rate(p, u_2, state[3]) / w;
}

/// d(state)/d(theta) of the spring-mass actuator. state and out: 2 entries; p: spring::count entries.
template <class T>
void spring_rhs(const T* p, const T& theta, const T* state, bool touching, T* out) {
    using std::cos;
    const T& x = state[0];
    T acceleration = p[spring::force] * cos(theta) - p[spring::damping] * state[1] - p[spring::stiffness] * x -
                     p[spring::cubic] * x * x * x;
    if (touching) {
        acceleration -= stop_force(x, state[1], p[spring::gap], p[spring::stop_stiffness], p[spring::stop_damping]);
    }
    out[0] = state[1] / p[spring::omega];
    out[1] = acceleration / p[spring::omega];
}

}  // namespace percuss::model
