#pragma once
/// \file
/// Powers, fields and currents of the two actuator types, written as they are printed, for integrators that work point
/// by point. Everything is nondimensional; templates on the scalar.

#include "model/parameters.hpp"
#include "model/plain_rhs.hpp"

#include <cmath>

namespace percuss::model {

/// phi_I (side 0) or phi_II (side 1): phi_pp/2 (1 -+ cos theta).
template <class T>
T membrane_voltage(const T* p, const T& theta, int side) {
    using std::cos;
    const T c = cos(theta);
    return side == 0 ? 0.5 * p[membrane::voltage] * (1.0 - c) : 0.5 * p[membrane::voltage] * (1.0 + c);
}

/// Displacement of a membrane from its own plane: x for membrane I (side 0), x - l for membrane II (side 1).
template <class T>
T membrane_displacement(const T* p, const T* state, int side) {
    return side == 0 ? state[0] : state[0] - p[membrane::length];
}

/// Work per unit of tau: `drive`, n sum of u phi^2 x', done by the voltage; `loss`, n sum of
/// delta_A u^2 s^(-3/2) x'^2 + mu_ratio/lambda_p^2 (L - 1/L) xi'/xi with L = (lambda_1/xi)^alpha_B, turned into heat in
/// the membranes. Over a period of a periodic motion drive = loss + work done on the stop.
template <class T>
void membrane_powers(const T* p, const T& theta, const T* state, T& drive, T& loss) {
    using std::pow;
    using std::sqrt;
    const T& v = state[1];
    const T& lp = p[membrane::lambda_p];
    drive = T(0.0);
    loss = T(0.0);
    for (int side = 0; side < 2; ++side) {
        const T u = membrane_displacement(p, state, side);
        const T& xi = state[2 + side];
        const T phi = membrane_voltage(p, theta, side);
        const T s = 1.0 + u * u;
        const T ratio = pow(lp * sqrt(s) / xi, p[membrane::alpha_b]);
        drive += u * phi * phi * v;
        loss += p[membrane::delta_a] * u * u / (s * sqrt(s)) * v * v +
                p[membrane::mu_ratio] / (lp * lp) * (ratio - 1.0 / ratio) * dashpot_rate(p, u, xi) / xi;
    }
    drive = p[membrane::layers] * drive;
    loss = p[membrane::layers] * loss;
}

/// phi lambda_1 of one membrane, lambda_1 = lambda_p sqrt(1 + u^2): its true electric field in units of sqrt(mu_A/eps).
template <class T>
T membrane_field(const T* p, const T& theta, const T* state, int side) {
    using std::sqrt;
    const T u = membrane_displacement(p, state, side);
    return membrane_voltage(p, theta, side) * p[membrane::lambda_p] * sqrt(1.0 + u * u);
}

/// d(s phi)/dtau of one membrane, s = 1 + u^2: the current into it, since its capacitance goes as lambda_1^2.
template <class T>
T membrane_current(const T* p, const T& theta, const T* state, int side) {
    using std::sin;
    const T u = membrane_displacement(p, state, side);
    const T voltage_rate = 0.5 * p[membrane::voltage] * p[membrane::omega] * sin(theta);
    const T stretching = 2.0 * u * state[1] * membrane_voltage(p, theta, side);
    const T charging = (1.0 + u * u) * voltage_rate;
    return side == 0 ? stretching + charging : stretching - charging;
}

/// Work per unit of tau of the spring-mass actuator: `drive` = F cos(theta) x', `loss` = c x'^2.
template <class T>
void spring_powers(const T* p, const T& theta, const T* state, T& drive, T& loss) {
    using std::cos;
    drive = p[spring::force] * cos(theta) * state[1];
    loss = p[spring::damping] * state[1] * state[1];
}

}  // namespace percuss::model
