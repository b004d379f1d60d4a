#pragma once
/// \file
/// The equations of the spring-mass actuator written as they are printed, with its powers; see model/plain.hpp.

#include "model/plain.hpp"
#include "model/spring/spring.hpp"

#include <cmath>

namespace percuss::model {

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

/// Work per unit of tau of the spring-mass actuator: `drive` = F cos(theta) x', `loss` = c x'^2.
template <class T>
void spring_powers(const T* p, const T& theta, const T* state, T& drive, T& loss) {
    using std::cos;
    drive = p[spring::force] * cos(theta) * state[1];
    loss = p[spring::damping] * state[1] * state[1];
}

struct PlainSpring {
    static constexpr const Scene& scene = spring::scene;

    template <class T>
    static void rate(const T* p, const T& theta, const T* state, bool touching, T* out) {
        spring_rhs(p, theta, state, touching, out);
    }
    template <class T>
    static void powers(const T* p, const T& theta, const T* state, T& drive, T& loss) {
        spring_powers(p, theta, state, drive, loss);
    }
    static bool meaningful(const StateVector& y) { return std::abs(y[0]) < 1e12 && std::abs(y[1]) < 1e12; }
    static bool symmetric(const Parameters&) { return true; }
    static double centre(const Parameters&) { return 0.0; }
    static StateVector rest_state(const Parameters&) { return {}; }
    static StateRange internal_range(const Parameters&, double) { return {}; }
    /// sqrt(k1); for a double well the frequency in a well, for a purely cubic spring the one (describing function,
    /// 3/4 k3 A^2) at the static amplitude A = (F/k3)^(1/3); 1 when nothing restores the mass.
    static double linear_resonance(const Parameters& p) {
        const double k1 = p[spring::stiffness];
        const double k3 = p[spring::cubic];
        if (k1 > 0.0) { return std::sqrt(k1); }
        if (!(k3 > 0.0)) { return 1.0; }
        const double amplitude = std::cbrt(std::abs(p[spring::force]) / k3);
        const double squared = k1 < 0.0 ? -2.0 * k1 : 0.75 * k3 * amplitude * amplitude;
        return squared > 0.0 ? std::sqrt(squared) : 1.0;
    }
};

}  // namespace percuss::model
