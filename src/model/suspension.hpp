#pragma once
/// \file
/// A mass on the suspension k1 x + k3 x^3 under a constant bias F0, beside a stop at x = gap that may press on it:
/// where it rests, the units that its motion is of order one in, its natural frequency. Shared by the actuators that
/// have one; T is a double or a number with derivatives.

#include "model/scaling.hpp"
#include "model/scene.hpp"

#include <cmath>

namespace percuss::model {

/// Nondimensional, per unit mass; a system without a stop has gap and stop_stiffness zero.
struct Suspension {
    double stiffness = 0.0;  ///< k1, negative for two wells
    double cubic = 0.0;      ///< k3
    double bias = 0.0;       ///< F0
    double gap = 0.0;        ///< where the stop is, negative where it presses on the mass at x = 0
    double stop_stiffness = 0.0;
    double held_force = 0.0;  ///< amplitude of the driving force, held still
};

/// Where the mass rests: a stable equilibrium clear of the stop, the nearest to it where there are two (without a stop:
/// the one at larger x); else the equilibrium against the stop; 0 where nothing restores the mass.
double rest_position(const Suspension& suspension);

/// Outermost stable equilibria without the stop, `lower` <= `upper`: entry 0 of what PlainModel::internal_range
/// returns.
struct Wells {
    double lower = 0.0;
    double upper = 0.0;
};
Wells wells(const Suspension& suspension);

/// Whether the motion clear of the stop has the half-cycle mirror symmetry about x = 0: no bias, one well, and a stop
/// that does not press at rest.
bool is_symmetric(const Suspension& suspension);

/// Natural frequency of small motions about rest: sqrt(k1 + 3 k3 x^2), with the stop where it is pressed; for a purely
/// cubic spring at x = 0 the one (describing function, 3/4 k3 A^2) at the static amplitude A = (F/k3)^(1/3); 1 when
/// nothing restores the mass.
double natural_frequency(const Suspension& suspension);

/// Length that displacements are measured in [m]: the gap's modulus if it is not zero, else the distance of two wells
/// from the middle, else the deflection under the force that the drive would hold the mass with, else 1.
template <class T>
T unit_of_length(const Values<T>& v, const T& held_force, const T& k1, const T& k3) {
    using std::cbrt;
    using std::sqrt;
    const T& gap = v[Key::stop_gap];
    if (has_stop(v.law) && number(gap) > 0.0) { return gap; }
    if (has_stop(v.law) && number(gap) < 0.0) { return 0.0 - gap; }
    if (number(k1) < 0.0 && number(k3) > 0.0) { return sqrt((0.0 - k1) / k3); }
    if (!(number(held_force) > 0.0)) { return 1.0; }
    if (number(k1) > 0.0) { return held_force / k1; }
    return cbrt(held_force / k3);
}

/// Time that goes with a unit of length [s]: sqrt(m / |k1|), or what the cubic term makes of it.
template <class T>
T unit_of_time(const T& mass, const T& k1, const T& k3, const T& length) {
    using std::sqrt;
    if (number(k1) < 0.0) { return sqrt(mass / (0.0 - k1)); }
    return sqrt(mass / (number(k1) > 0.0 ? k1 : k3 * length * length));
}

/// Appends what is wrong with a suspension: nothing that restores the mass.
void check_suspension(const Specification& spec, Key stiffness, Key cubic, std::vector<std::string>& found);

}  // namespace percuss::model
