#pragma once
/// \file
/// The equations of the spring-mass actuator written as they are printed, with its powers; see model/plain.hpp.

#include "model/plain.hpp"
#include "model/spring/spring.hpp"
#include "model/suspension.hpp"

#include <cmath>

namespace percuss::model {

/// d(state)/d(theta) of the spring-mass actuator. state and out: 2 entries; p: spring::count entries.
template <class T>
void spring_rhs(const T* p, const T& theta, const T* state, bool touching, T* out) {
    using std::cos;
    const T& x = state[0];
    T acceleration = p[spring::force] * cos(theta) - p[spring::damping] * state[1] - p[spring::stiffness] * x -
                     p[spring::cubic] * x * x * x + p[spring::bias];
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
    static double fastest_decay(const Parameters& p) { return p[spring::damping]; }
    /// `held_force`: of the drive, were it held still.
    static Suspension suspension(const Parameters& p) {
        return {p[spring::stiffness], p[spring::cubic],          p[spring::bias],
                p[spring::gap],       p[spring::stop_stiffness], p[spring::force]};
    }
    static bool symmetric(const Parameters& p) { return is_symmetric(suspension(p)); }
    static double centre(const Parameters&) { return 0.0; }
    static StateVector rest_state(const Parameters& p) { return {rest_position(suspension(p)), 0.0, 0.0, 0.0}; }
    static StateRange internal_range(const Parameters& p, double) {
        const Wells at = wells(suspension(p));
        return {{at.lower, 0.0, 0.0, 0.0}, {at.upper, 0.0, 0.0, 0.0}};
    }
    static double linear_resonance(const Parameters& p) { return natural_frequency(suspension(p)); }
};

}  // namespace percuss::model
