#pragma once
/// \file
/// A mass on the suspension k1 x + k3 x^3: the units that its motion is of order one in, and its natural frequency.
/// Shared by the actuators that have one; T is a double or a number with derivatives.

#include "model/scaling.hpp"

#include <cmath>

namespace percuss::model {

/// Length that displacements are measured in [m]: the gap if there is one, else the deflection under the force that the
/// drive would hold it with, else 1.
template <class T>
T unit_of_length(const Values<T>& v, const T& held_force, const T& k1, const T& k3) {
    using std::cbrt;
    if (has_stop(v.law) && number(v[Key::stop_gap]) > 0.0) { return v[Key::stop_gap]; }
    if (!(number(held_force) > 0.0)) { return 1.0; }
    if (number(k1) > 0.0) { return held_force / k1; }
    return cbrt(held_force / k3);
}

/// Time that goes with a unit of length [s]: sqrt(m / k1), or what the cubic term makes of it.
template <class T>
T unit_of_time(const T& mass, const T& k1, const T& k3, const T& length) {
    using std::sqrt;
    return sqrt(mass / (number(k1) > 0.0 ? k1 : k3 * length * length));
}

/// Natural frequency per unit mass: sqrt(k1); for a double well the frequency in a well, for a purely cubic spring the
/// one (describing function, 3/4 k3 A^2) at the static amplitude A = (F/k3)^(1/3); 1 when nothing restores the mass.
inline double natural_frequency(double k1, double k3, double held_force) {
    if (k1 > 0.0) { return std::sqrt(k1); }
    if (!(k3 > 0.0)) { return 1.0; }
    const double amplitude = std::cbrt(std::abs(held_force) / k3);
    const double squared = k1 < 0.0 ? -2.0 * k1 : 0.75 * k3 * amplitude * amplitude;
    return squared > 0.0 ? std::sqrt(squared) : 1.0;
}

}  // namespace percuss::model
