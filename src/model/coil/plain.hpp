#pragma once
/// \file
/// The equations of the voice-coil actuator written as they are printed, with its powers; see model/plain.hpp.

#include "model/coil/coil.hpp"
#include "model/plain.hpp"
#include "model/suspension.hpp"

#include <algorithm>
#include <cmath>

namespace percuss::model {

struct PlainCoil {
    static constexpr const Scene& scene = coil::scene;

    template <class T>
    static void rate(const T* p, const T& theta, const T* state, bool touching, T* out) {
        using std::cos;
        const T& x = state[0];
        const T& v = state[1];
        const T& i = state[2];
        T acceleration = i - p[coil::damping] * v - p[coil::stiffness] * x - p[coil::cubic] * x * x * x + p[coil::bias];
        if (touching) {
            acceleration -= stop_force(x, v, p[coil::gap], p[coil::stop_stiffness], p[coil::stop_damping]);
        }
        out[0] = v / p[coil::omega];
        out[1] = acceleration / p[coil::omega];
        out[2] = (p[coil::voltage] * cos(theta) - p[coil::resistance] * i - p[coil::coupling] * v) / p[coil::omega];
    }

    /// `drive` = V cos(theta) i, `loss` = R i^2 + c x'^2.
    template <class T>
    static void powers(const T* p, const T& theta, const T* state, T& drive, T& loss) {
        drive = mean(coil::power, p, theta, state);
        loss = mean(coil::heat, p, theta, state) + p[coil::damping] * state[1] * state[1];
    }

    template <class T>
    static T peak(int /*signal*/, int /*part*/, const T* /*p*/, const T& /*theta*/, const T* state) {
        return state[2];
    }

    template <class T>
    static T mean(int signal, const T* p, const T& theta, const T* state) {
        using std::cos;
        const T& i = state[2];
        if (signal == coil::heat) { return p[coil::resistance] / p[coil::coupling] * i * i; }
        return p[coil::voltage] / p[coil::coupling] * cos(theta) * i;
    }

    static bool meaningful(const StateVector& y) {
        return std::abs(y[0]) < 1e12 && std::abs(y[1]) < 1e12 && std::abs(y[2]) < 1e12;
    }
    /// The current settles at the rate R/Le, the mass at c/m.
    static double fastest_decay(const Parameters& p) { return std::max(p[coil::damping], p[coil::resistance]); }
    /// `held_force`: of the drive, were it held still.
    static Suspension suspension(const Parameters& p) {
        return {p[coil::stiffness], p[coil::cubic],          p[coil::bias],
                p[coil::gap],       p[coil::stop_stiffness], p[coil::voltage] / p[coil::resistance]};
    }
    static bool symmetric(const Parameters& p) { return is_symmetric(suspension(p)); }
    static double centre(const Parameters&) { return 0.0; }
    static StateVector rest_state(const Parameters& p) { return {rest_position(suspension(p)), 0.0, 0.0, 0.0}; }
    /// The voltage alone drives no more than V/R. The motion adds beta times the integral of exp(-rho t) x', which is
    /// below 2 beta reach (by parts) and below beta/rho times the speed; a speed as at the faster of drive and
    /// resonance, doubled.
    static StateRange internal_range(const Parameters& p, double reach) {
        const double rho = p[coil::resistance];
        const double speed = 2.0 * std::max(p[coil::omega], linear_resonance(p)) * reach;
        const double bound = std::abs(p[coil::voltage]) / rho + p[coil::coupling] * std::min(2.0 * reach, speed / rho);
        const Wells at = wells(suspension(p));
        return {{at.lower, 0.0, -bound, 0.0}, {at.upper, 0.0, bound, 0.0}};
    }
    /// With the current frozen; the voltage held would press with V/R.
    static double linear_resonance(const Parameters& p) { return natural_frequency(suspension(p)); }
};

}  // namespace percuss::model
