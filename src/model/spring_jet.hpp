#pragma once
/// \file
/// Taylor coefficients of the spring-mass actuator x'' + c x' + k1 x + k3 x^3 + f_stop = F cos(theta) in the drive
/// phase theta = omega tau.

#include "model/parameters.hpp"
#include "numerics/dual.hpp"

#include <array>
#include <cmath>

namespace percuss::model {
inline namespace PERCUSS_ISA {

template <class T, int MaxOrder>
class SpringJet {
public:
    using Scalar = T;
    using Base = typename numerics::ScalarTraits<T>::Base;
    static constexpr int states = 2;
    static constexpr bool membranes = false;
    static constexpr int max_order = MaxOrder;
    using State = std::array<T, states>;
    using Series = std::array<T, MaxOrder + 1>;

    explicit SpringJet(const T* p)
        : c_(p[spring::damping]),
          k1_(p[spring::stiffness]),
          k3_(p[spring::cubic]),
          force_(p[spring::force]),
          x_stop_(p[spring::gap]),
          stiffness_(p[spring::stop_stiffness]),
          damping_(p[spring::stop_damping]),
          omega_(p[spring::omega]),
          inverse_omega_(1.0 / p[spring::omega]) {}

    void load(const State& y) {
        x_[0] = y[0];
        v_[0] = y[1];
    }
    [[nodiscard]] State unload() const { return {x_[0], v_[0]}; }
    [[nodiscard]] std::array<Base, states> rate() const { return {numerics::base(x_[1]), numerics::base(v_[1])}; }
    void set_position(const Base& x) {
        if constexpr (numerics::ScalarTraits<T>::lanes > 0) {
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
        using std::cos;
        using std::sin;
        const T c = cos(theta);
        const T s = sin(theta);
        Base inverse_factorial = 1;
        for (int n = 0; n < order; ++n) {
            if (n > 0) { inverse_factorial = inverse_factorial / static_cast<Base>(n); }
            const Base sign = (n % 4 == 1 || n % 4 == 2) ? Base(-1) : Base(1);
            drive_[n] = force_ * (n % 2 == 0 ? c : s) * (sign * inverse_factorial);
            extend(n, touching);
        }
    }

    void advance(const Base& h, int order) {
        x_[0] = at(x_, order, h);
        v_[0] = at(v_, order, h);
    }

    [[nodiscard]] const Series& x() const { return x_; }
    [[nodiscard]] const Series& v() const { return v_; }
    [[nodiscard]] const T& stop_position() const { return x_stop_; }
    [[nodiscard]] const T& stop_stiffness() const { return stiffness_; }
    [[nodiscard]] const T& stop_damping() const { return damping_; }
    [[nodiscard]] const T& omega() const { return omega_; }
    [[nodiscard]] const T& inverse_omega() const { return inverse_omega_; }
    [[nodiscard]] Base norm(int j) const {
        const Base a = magnitude(numerics::base(x_[j]));
        const Base b = magnitude(numerics::base(v_[j]));
        return a > b ? a : b;
    }

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
    static Base magnitude(const Base& a) { return a < 0 ? -a : a; }
    static T at(const Series& c, int order, const Base& h) {
        T r = c[order];
        for (int j = order - 1; j >= 0; --j) { r = r * h + c[j]; }
        return r;
    }

    void extend(int n, bool touching) {
        const Base reciprocal = Base(1) / static_cast<Base>(n + 1);
        T square(0.0);
        for (int j = 0; j <= n; ++j) { square += x_[j] * x_[n - j]; }
        square_[n] = square;
        T cube(0.0);
        for (int j = 0; j <= n; ++j) { cube += square_[j] * x_[n - j]; }
        T acceleration = drive_[n] - c_ * v_[n] - k1_ * x_[n] - k3_ * cube;
        if (touching) {
            const T penetration = n == 0 ? x_[0] - x_stop_ : x_[n];
            acceleration -= stiffness_ * penetration + damping_ * v_[n];
        }
        x_[n + 1] = v_[n] * inverse_omega_ * reciprocal;
        v_[n + 1] = acceleration * inverse_omega_ * reciprocal;
    }

    T c_, k1_, k3_, force_, x_stop_, stiffness_, damping_, omega_, inverse_omega_;
    Series x_, v_, square_, drive_;
};

}  // namespace PERCUSS_ISA
}  // namespace percuss::model
