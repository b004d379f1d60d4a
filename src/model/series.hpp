#pragma once
/// \file
/// What the Taylor coefficients of a scene must offer: to the integrator of single motions (Series), and to the one
/// that follows as many motions as a vector has lanes (LaneSeries). And the way from the former to the latter for
/// series that are written over any scalar, vectors of lanes included.

#include "model/scene.hpp"
#include "numerics/dual.hpp"
#include "numerics/lane_math.hpp"

#include <array>
#include <cmath>
#include <concepts>
#include <cstddef>

namespace percuss::model {
inline namespace PERCUSS_ISA {

/// S: the Taylor series of one motion in the drive phase theta about a point that moves along (the expansion point),
/// for the scalar S::Scalar: a real number, or a numerics::Dual with derivatives. Time unit tau, theta = omega tau.
/// Constructed from the parameters, `const Scalar*`, as the scene numbers them. Members:
///   Scalar, Base            the scalar, and what is left of it without derivatives
///   State                   array of Scalar: the state as the scene numbers it
///   Coefficients            array of Scalar, max_order + 1 long
///   states, max_order       numbers
///   peaks, means            how many peak and mean signals there are; peak_signal(k): the description (peaks > 0)
///   load(y), unload()       state into and out of the expansion point
///   position(), velocity()  x and x' at the expansion point, to be changed
///   set_position(x)         value of x there, derivatives kept
///   expand(theta, touching, order[, derivative_order])
///                           coefficients 0 .. order of x and x'; those of derivatives may be left zero beyond
///                           derivative_order. touching: the force of the stop acts
///   advance(h, order)       moves the expansion point by h
///   x(), v()                coefficients of x and x'
///   norm(j)                 largest modulus of the j-th coefficients over what is integrated: rules the step
///   rate()                  d(state)/d(theta) at the expansion point, after expand()
///   stop_position(), stop_stiffness(), stop_damping(), omega(), inverse_omega()
///   power(n)                coefficient n < order of the powers of the drive and of the losses, per unit of tau
///   peak_series(k, part, order, c)  (where peaks > 0) coefficients of a function of one part that is largest where
///                           peak signal k is; returns their degree
///   peak_value(k, m)        (where peaks > 0) the signal where that function is m
///   mean(k, n)              (where means > 0) coefficient n < order of mean signal k
template <class S>
concept Series = requires(S s, const S& c, const typename S::State& y, const typename S::Scalar& theta,
                          const typename S::Base& h) {
    requires std::tuple_size_v<typename S::State>
    == S::states;
    requires std::tuple_size_v<typename S::Coefficients>
    == S::max_order + 1;
    requires S::peaks >= 0 && S::peaks <= max_peaks&& S::means >= 0 && S::means <= max_means;
    s.load(y);
    { c.unload() } -> std::same_as<typename S::State>;
    { s.position() } -> std::same_as<typename S::Scalar&>;
    { s.velocity() } -> std::same_as<typename S::Scalar&>;
    s.set_position(h);
    s.expand(theta, true, 1);
    s.expand(theta, true, 1, 1);
    s.advance(h, 1);
    { c.x() } -> std::same_as<const typename S::Coefficients&>;
    { c.v() } -> std::same_as<const typename S::Coefficients&>;
    { c.norm(0) } -> std::same_as<typename S::Base>;
    { c.rate() } -> std::same_as<std::array<typename S::Base, static_cast<std::size_t>(S::states)>>;
    { c.stop_position() } -> std::same_as<const typename S::Scalar&>;
    { c.stop_stiffness() } -> std::same_as<const typename S::Scalar&>;
    { c.stop_damping() } -> std::same_as<const typename S::Scalar&>;
    { c.omega() } -> std::same_as<const typename S::Scalar&>;
    { c.inverse_omega() } -> std::same_as<const typename S::Scalar&>;
    { c.power(0) } -> std::same_as<std::array<typename S::Scalar, 2>>;
}
&&(S::peaks == 0 ||
   requires(const S& c, typename S::Coefficients& out, const typename S::Scalar& m) {
       { S::peak_signal(0) } -> std::same_as<PeakSignal>;
       { c.peak_series(0, 0, 1, out) } -> std::same_as<int>;
       { c.peak_value(0, m) } -> std::same_as<typename S::Scalar>;
   }) &&
    (S::means == 0 || requires(const S& c) {
        { c.mean(0, 0) } -> std::same_as<typename S::Scalar>;
    });

/// L: the same for `lanes` motions of one actuator, without derivatives or signals. Constructed from the parameters,
/// `const double*`. Lanes differ in state, phase and contact, not in parameters; nothing passes between them. Members:
///   lanes, states, max_order, V (a vector with a double per lane)
///   stop_position(), stop_stiffness(), stop_damping()
///   load(lane, y), unload(lane), set_position(lane, x)
///   clear(lane)               puts a lane that nobody uses at rest
///   expand(theta, stiffness, damping, order)  the stop's, zero in lanes that do not touch it
///   advance(h, order), norm(j)
///   x(n), v(n)                coefficients
template <class L>
concept LaneSeries = requires(L s, const L& c, std::size_t lane, const std::array<double, L::states>& y,
                              const typename L::V& theta, const typename L::V& k, double x) {
    requires L::lanes >
    0 && L::max_order > 0;
    { c.stop_position() } -> std::same_as<double>;
    { c.stop_stiffness() } -> std::same_as<double>;
    { c.stop_damping() } -> std::same_as<double>;
    s.load(lane, y);
    { s.unload(lane) } -> std::same_as<std::array<double, L::states>>;
    s.set_position(lane, x);
    s.clear(lane);
    s.expand(theta, k, k, 1);
    s.advance(k, 1);
    { c.norm(0) } -> std::same_as<typename L::V>;
    { c.x(0) } -> std::same_as<const typename L::V&>;
    { c.v(0) } -> std::same_as<const typename L::V&>;
};

// Arithmetic that a series over any scalar may use.

/// Base: what step lengths and coefficients are compared by. Real: what constants of the series are made of.
template <class T>
struct SeriesTraits {
    using Base = typename numerics::ScalarTraits<T>::Base;
    using Real = Base;
    static constexpr bool has_derivatives = numerics::ScalarTraits<T>::lanes > 0;
};
template <int N>
struct SeriesTraits<numerics::LaneVector<N>> {
    using Base = numerics::LaneVector<N>;
    using Real = double;
    static constexpr bool has_derivatives = false;
};

template <class T>
PERCUSS_INLINE void cosine_and_sine(const T& theta, T& c, T& s) {
    using std::cos;
    using std::sin;
    c = cos(theta);
    s = sin(theta);
}
template <int N>
PERCUSS_INLINE void cosine_and_sine(const numerics::LaneVector<N>& theta, numerics::LaneVector<N>& c,
                                    numerics::LaneVector<N>& s) {
    numerics::cos_sin(theta, c, s);
}
/// Base part of a scalar.
template <class T>
PERCUSS_INLINE typename SeriesTraits<T>::Base base_of(const T& a) {
    return numerics::base(a);
}
template <int N>
PERCUSS_INLINE numerics::LaneVector<N> base_of(const numerics::LaneVector<N>& a) {
    return a;
}
template <class B>
PERCUSS_INLINE B larger_modulus(const B& a, const B& b) {
    const B p = a < 0 ? -a : a;
    const B q = b < 0 ? -b : b;
    return p > q ? p : q;
}
template <int N>
PERCUSS_INLINE numerics::LaneVector<N> larger_modulus(const numerics::LaneVector<N>& a,
                                                      const numerics::LaneVector<N>& b) {
    return max(abs(a), abs(b));
}

/// A LaneSeries from a series that can be written over a LaneVector. Besides what Series asks for, S has `entry(k)`,
/// state k at the expansion point, to be changed; and `expand_beside(theta, stiffness, damping, order)`, which takes
/// the stop's force from its arguments.
template <template <class, int> class S, int N, int MaxOrder>
class LanesOf {
public:
    static constexpr int lanes = N;
    using V = numerics::LaneVector<N>;
    using Jet = S<V, MaxOrder>;
    static constexpr int states = Jet::states;
    static constexpr int max_order = MaxOrder;

    explicit LanesOf(const double* p) : jet_(spread(p).data()) {}

    [[nodiscard]] double stop_position() const { return jet_.stop_position()[0]; }
    [[nodiscard]] double stop_stiffness() const { return jet_.stop_stiffness()[0]; }
    [[nodiscard]] double stop_damping() const { return jet_.stop_damping()[0]; }
    [[nodiscard]] const V& x(int n) const { return jet_.x()[static_cast<std::size_t>(n)]; }
    [[nodiscard]] const V& v(int n) const { return jet_.v()[static_cast<std::size_t>(n)]; }

    void load(std::size_t lane, const std::array<double, states>& y) {
        for (std::size_t k = 0; k < y.size(); ++k) { jet_.entry(k).set(lane, y[k]); }
    }
    [[nodiscard]] std::array<double, states> unload(std::size_t lane) {
        std::array<double, states> y;
        for (std::size_t k = 0; k < y.size(); ++k) { y[k] = jet_.entry(k)[lane]; }
        return y;
    }
    void set_position(std::size_t lane, double x) { jet_.entry(0).set(lane, x); }
    void clear(std::size_t lane) { load(lane, {}); }
    void expand(const V& theta, const V& stiffness, const V& damping, int order) {
        jet_.expand_beside(theta, stiffness, damping, order);
    }
    void advance(const V& h, int order) { jet_.advance(h, order); }
    [[nodiscard]] V norm(int j) const { return jet_.norm(j); }

private:
    static std::array<V, max_parameters> spread(const double* p) {
        std::array<V, max_parameters> out;
        for (std::size_t i = 0; i < out.size(); ++i) { out[i] = numerics::all_lanes<N>(p[i]); }
        return out;
    }
    Jet jet_;
};

}  // namespace PERCUSS_ISA
}  // namespace percuss::model
