#pragma once
/// \file
/// What the plain equations of a scene must offer: functions of one point of the motion, written as they are printed,
/// for the integrators that work point by point and as an independent check of the Taylor recurrences. Derivatives are
/// with respect to the drive phase theta = omega tau; everything is nondimensional.

#include "model/scene.hpp"

#include <concepts>

namespace percuss::model {

/// Force of the stop at (x, x'), nondimensional, whatever its sign.
template <class T>
T stop_force(const T& x, const T& v, const T& x_stop, const T& k, const T& delta) {
    return k * (x - x_stop) + delta * v;
}

/// P: a class of static functions. p: the parameters (scene().parameters in number), state: scene().states numbers; T
/// is a double or a number with derivatives. Members:
///   scene             the description, a `const Scene&` known at compile time
///   rate<T>           d(state)/d(theta); `touching`: the force of the stop acts
///   powers<T>         work per unit of tau: done by the drive; turned into heat in the actuator, stop excluded. Over a
///                     period of a periodic motion drive = loss + work done on the stop
///   peak<T>           value (signed) of peak signal `which` in part 0 .. parts - 1 (only where the scene has peaks)
///   mean<T>           value of mean signal `which` (only where the scene has means)
///   meaningful        whether the equations mean anything at this state; false for NaN
///   centre            position of the mass at rest, linear in the parameters
///   rest_state        everything at rest, undriven
///   internal_range    where the states beyond x and x' stay while |x - centre| <= reach (x and x': zero)
///   linear_resonance  natural frequency of small motions about rest at the mean drive, other states frozen
///   symmetric         whether the free system has the half-cycle mirror symmetry that Scene::mirror describes
template <class P>
concept PlainModel = requires(const double* p, const double& theta, const double* state, double* out, double& drive,
                              double& loss, const Parameters& parameters, const StateVector& y, double reach) {
    { P::scene } -> std::convertible_to<const Scene&>;
    P::rate(p, theta, state, true, out);
    P::powers(p, theta, state, drive, loss);
    { P::meaningful(y) } -> std::same_as<bool>;
    { P::centre(parameters) } -> std::same_as<double>;
    { P::rest_state(parameters) } -> std::same_as<StateVector>;
    { P::internal_range(parameters, reach) } -> std::same_as<StateRange>;
    { P::linear_resonance(parameters) } -> std::same_as<double>;
    { P::symmetric(parameters) } -> std::same_as<bool>;
}
&&(P::scene.peaks.empty() ||
   requires(const double* p, const double& theta, const double* state, int which) {
       { P::peak(which, 0, p, theta, state) } -> std::same_as<double>;
   }) &&
    (P::scene.means.empty() || requires(const double* p, const double& theta, const double* state, int which) {
        { P::mean(which, p, theta, state) } -> std::same_as<double>;
    });

}  // namespace percuss::model
