#pragma once
/// \file
/// The equations of the dielectric elastomer actuator written as they are printed (with the signs corrected), with its
/// powers, fields and currents; see model/plain.hpp.

#include "model/membrane/membrane.hpp"
#include "model/plain.hpp"
#include "numerics/forward_lanes.hpp"

#include <algorithm>
#include <array>
#include <cmath>

namespace percuss::model {

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

/// Half peak to peak raised to the square and averaged over a cycle: mean of (1 - cos)^2/4 is 3/8.
inline constexpr double mean_square_of_drive = 3.0 / 8.0;

struct ViscousMembranes {
    static constexpr const Scene& scene = membrane::viscous;

    template <class T>
    static void rate(const T* p, const T& theta, const T* state, bool touching, T* out) {
        membrane_rhs(p, theta, state, touching, out);
    }
    template <class T>
    static void powers(const T* p, const T& theta, const T* state, T& drive, T& loss) {
        membrane_powers(p, theta, state, drive, loss);
    }
    template <class T>
    static T peak(int which, int side, const T* p, const T& theta, const T* state) {
        return which == membrane::field ? membrane_field(p, theta, state, side)
                                        : membrane_current(p, theta, state, side);
    }
    /// The stretches stay positive while the membranes are whole; a stroke of 1000 frame widths is no motion.
    static bool meaningful(const StateVector& y) {
        return std::abs(y[0]) < 1e3 && std::abs(y[1]) < 1e6 && y[2] > 0.0 && y[2] < 1e3 && y[3] > 0.0 && y[3] < 1e3;
    }
    /// Both sides are alike.
    static bool symmetric(const Parameters&) { return true; }
    static double centre(const Parameters& p) { return 0.5 * p[membrane::length]; }
    static StateVector rest_state(const Parameters& p) {
        const double l = p[membrane::length];
        const double stretch = p[membrane::lambda_p] * std::sqrt(1.0 + 0.25 * l * l);
        return {0.5 * l, 0.0, stretch, stretch};
    }
    /// The stretch xi relaxes towards lambda_1 = lambda_p sqrt(1 + u^2) of its membrane, u = x or x - l.
    static StateRange internal_range(const Parameters& p, double reach) {
        const double furthest = 0.5 * p[membrane::length] + reach;
        const double lower = p[membrane::lambda_p];
        const double upper = lower * std::sqrt(1.0 + furthest * furthest);
        return {{0.0, 0.0, lower, lower}, {0.0, 0.0, upper, upper}};
    }
    /// Stiffness of both membranes about rest for a given phi^2, dashpots of the Maxwell branches locked.
    static double stiffness(const Parameters& values, double phi_squared) {
        using T = numerics::ForwardLanes<1>;
        std::array<T, membrane::count> p;
        std::transform(values.begin(), values.begin() + membrane::count, p.begin(), [](double v) { return T(v); });
        const StateVector rest = rest_state(values);
        const T phi(std::sqrt(phi_squared));
        double sum = 0.0;
        for (const double u : {rest[0], -rest[0]}) {
            T displacement(u);
            displacement.d[0] = 1.0;
            sum += membrane_force(p.data(), displacement, T(0.0), T(rest[2]), phi).d[0];
        }
        return sum * values[membrane::layers];
    }
    /// Above the voltage that makes the rest position unstable: the undriven frequency.
    static double linear_resonance(const Parameters& p) {
        const double voltage = p[membrane::voltage];
        const double driven = stiffness(p, mean_square_of_drive * voltage * voltage);
        return std::sqrt(driven > 0.0 ? driven : stiffness(p, 0.0));
    }
};

/// Without the Maxwell branches (mu_ratio = 0, which switches their force off): x and x' are all there is.
struct ElasticMembranes : ViscousMembranes {
    static constexpr const Scene& scene = membrane::elastic;

    /// The idle stretches are given the value one, which keeps every power finite.
    template <class T>
    static std::array<T, membrane::states> filled(const T* state) {
        return {state[0], state[1], T(1.0), T(1.0)};
    }
    template <class T>
    static void rate(const T* p, const T& theta, const T* state, bool touching, T* out) {
        std::array<T, membrane::states> full;
        ViscousMembranes::rate(p, theta, filled(state).data(), touching, full.data());
        std::copy_n(full.begin(), scene.states, out);
    }
    template <class T>
    static void powers(const T* p, const T& theta, const T* state, T& drive, T& loss) {
        ViscousMembranes::powers(p, theta, filled(state).data(), drive, loss);
    }
    static bool meaningful(const StateVector& y) { return ViscousMembranes::meaningful(filled(y.data())); }
    static StateVector rest_state(const Parameters& p) { return {ViscousMembranes::centre(p), 0.0, 0.0, 0.0}; }
    static StateRange internal_range(const Parameters&, double) { return {}; }
};

}  // namespace percuss::model
