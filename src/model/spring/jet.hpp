#pragma once
/// \file
/// Taylor coefficients of the spring-mass actuator x'' + c x' + k1 x + k3 x^3 + f_stop = F cos(theta) in the drive
/// phase theta = omega tau, over any scalar: real, dual, or a vector with a motion per lane.

#include "model/series.hpp"
#include "model/spring/spring.hpp"
#include "numerics/dual.hpp"

#include <array>
#include <cmath>
#include <cstddef>

namespace percuss::model {
inline namespace PERCUSS_ISA {

template <class T, int MaxOrder>
class SpringJet {
public:
    using Scalar = T;
    using Base = typename SeriesTraits<T>::Base;
    using Real = typename SeriesTraits<T>::Real;
    static constexpr int states = spring::states;
    static constexpr int peaks = 0;
    static constexpr int means = 0;
    static constexpr int max_order = MaxOrder;
    using State = std::array<T, states>;
    using Coefficients = std::array<T, MaxOrder + 1>;

    explicit SpringJet(const T* p)
        : c_(p[spring::damping]),
          k1_(p[spring::stiffness]),
          k3_(p[spring::cubic]),
          force_(p[spring::force]),
          x_stop_(p[spring::gap]),
          stiffness_(p[spring::stop_stiffness]),
          damping_(p[spring::stop_damping]),
          omega_(p[spring::omega]),
          bias_(p[spring::bias]),
          inverse_omega_(1.0 / p[spring::omega]),
          // Two convolutions less where k3 = 0; a derivative with respect to k3 needs x^3 even there.
          cubic_(SeriesTraits<T>::has_derivatives || !is_zero(p[spring::cubic])) {}

    void load(const State& y) {
        x_[0] = y[0];
        v_[0] = y[1];
    }
    [[nodiscard]] State unload() const { return {x_[0], v_[0]}; }
    [[nodiscard]] T& entry(std::size_t k) { return k == 0 ? x_[0] : v_[0]; }
    [[nodiscard]] std::array<Base, states> rate() const { return {base_of(x_[1]), base_of(v_[1])}; }
    void set_position(const Base& x) {
        if constexpr (SeriesTraits<T>::has_derivatives) {
            x_[0].v = x;
        } else {
            x_[0] = x;
        }
    }
    T& position() { return x_[0]; }
    T& velocity() { return v_[0]; }

    /// Derivative parts are so cheap here that they always have the full order.
    void expand(const T& theta, bool touching, int order, int /*derivative_order*/) { expand(theta, touching, order); }
    void expand(const T& theta, bool touching, int order) {
        start(theta);
        for (int n = 0; n < order; ++n) {
            T a = acceleration(n);
            if (touching) { a -= stop_force(n, stiffness_, damping_); }
            extend(n, a);
        }
    }
    void expand_beside(const T& theta, const T& stiffness, const T& damping, int order) {
        start(theta);
        for (int n = 0; n < order; ++n) { extend(n, acceleration(n) - stop_force(n, stiffness, damping)); }
    }

    void advance(const Base& h, int order) {
        x_[0] = at(x_, order, h);
        v_[0] = at(v_, order, h);
    }

    [[nodiscard]] const Coefficients& x() const { return x_; }
    [[nodiscard]] const Coefficients& v() const { return v_; }
    [[nodiscard]] const T& stop_position() const { return x_stop_; }
    [[nodiscard]] const T& stop_stiffness() const { return stiffness_; }
    [[nodiscard]] const T& stop_damping() const { return damping_; }
    [[nodiscard]] const T& omega() const { return omega_; }
    [[nodiscard]] const T& inverse_omega() const { return inverse_omega_; }
    [[nodiscard]] Base norm(int j) const { return larger_modulus(base_of(x_[j]), base_of(v_[j])); }

    /// Power of the drive, F cos(theta) x', and of the damper, c x'^2: coefficient n.
    [[nodiscard]] std::array<T, 2> power(int n) const {
        T drive(0.0);
        T loss(0.0);
        for (int j = 0; j <= n; ++j) {
            drive += drive_[j] * v_[n - j];
            loss += c_ * v_[j] * v_[n - j];
        }
        return {drive, loss};
    }

private:
    static bool is_zero(const T& a) {
        if constexpr (requires { a[0] == 0.0; }) {
            return a[0] == 0.0;  // lanes have the same parameters
        } else {
            return base_of(a) == 0;
        }
    }
    static T at(const Coefficients& c, int order, const Base& h) {
        T r = c[order];
        for (int j = order - 1; j >= 0; --j) { r = r * h + c[j]; }
        return r;
    }

    void start(const T& theta) {
        cosine_and_sine(theta, cos_, sin_);
        inverse_factorial_ = 1;
    }

    /// Coefficient n of the drive minus the forces of the suspension.
    T acceleration(int n) {
        if (n > 0) { inverse_factorial_ = inverse_factorial_ / static_cast<Real>(n); }
        // derivatives of cos cycle: cos, -sin, -cos, sin
        const Real sign = (n % 4 == 1 || n % 4 == 2) ? Real(-1) : Real(1);
        drive_[n] = force_ * (n % 2 == 0 ? cos_ : sin_) * (sign * inverse_factorial_);
        const T linear = drive_[n] - c_ * v_[n] - k1_ * x_[n];
        const T sum = cubic_ ? linear - k3_ * cube(n) : linear;
        return n == 0 ? sum + bias_ : sum;
    }
    /// Coefficient n of x^3, given x up to there.
    T cube(int n) {
        T square{};
        for (int j = 0; j <= n; ++j) { square += x_[j] * x_[n - j]; }
        square_[n] = square;
        T result{};
        for (int j = 0; j <= n; ++j) { result += square_[j] * x_[n - j]; }
        return result;
    }
    T stop_force(int n, const T& stiffness, const T& damping) const {
        const T penetration = n == 0 ? x_[0] - x_stop_ : x_[n];
        return stiffness * penetration + damping * v_[n];
    }
    void extend(int n, const T& acceleration) {
        const Real reciprocal = Real(1) / static_cast<Real>(n + 1);
        x_[n + 1] = v_[n] * inverse_omega_ * reciprocal;
        v_[n + 1] = acceleration * inverse_omega_ * reciprocal;
    }

    T c_, k1_, k3_, force_, x_stop_, stiffness_, damping_, omega_, bias_, inverse_omega_;
    bool cubic_;
    T cos_{}, sin_{};
    Real inverse_factorial_ = 1;
    Coefficients x_, v_, square_, drive_;
};

}  // namespace PERCUSS_ISA
}  // namespace percuss::model
