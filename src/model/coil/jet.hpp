#pragma once
/// \file
/// Taylor coefficients of the voice-coil actuator x'' + c x' + k1 x + k3 x^3 + f_stop = i, i' = v cos(theta) - rho i -
/// beta x' in the drive phase theta = omega tau, over any scalar: real, dual, or a vector with a motion per lane.

#include "model/coil/coil.hpp"
#include "model/series.hpp"
#include "numerics/dual.hpp"

#include <array>
#include <cstddef>

namespace percuss::model {
inline namespace PERCUSS_ISA {

template <class T, int MaxOrder>
class CoilJet {
public:
    using Scalar = T;
    using Base = typename SeriesTraits<T>::Base;
    using Real = typename SeriesTraits<T>::Real;
    static constexpr int states = coil::states;
    static constexpr int peaks = static_cast<int>(coil::peaks.size());
    static constexpr int means = static_cast<int>(coil::means.size());
    static constexpr int max_order = MaxOrder;
    using State = std::array<T, states>;
    using Coefficients = std::array<T, MaxOrder + 1>;

    explicit CoilJet(const T* p)
        : c_(p[coil::damping]),
          k1_(p[coil::stiffness]),
          k3_(p[coil::cubic]),
          rho_(p[coil::resistance]),
          beta_(p[coil::coupling]),
          voltage_(p[coil::voltage]),
          x_stop_(p[coil::gap]),
          stiffness_(p[coil::stop_stiffness]),
          damping_(p[coil::stop_damping]),
          omega_(p[coil::omega]),
          bias_(p[coil::bias]),
          inverse_omega_(1.0 / p[coil::omega]),
          inverse_beta_(1.0 / p[coil::coupling]) {}

    void load(const State& y) {
        x_[0] = y[0];
        v_[0] = y[1];
        i_[0] = y[2];
    }
    [[nodiscard]] State unload() const { return {x_[0], v_[0], i_[0]}; }
    [[nodiscard]] T& entry(std::size_t k) { return k == 0 ? x_[0] : k == 1 ? v_[0] : i_[0]; }
    [[nodiscard]] std::array<Base, states> rate() const { return {base_of(x_[1]), base_of(v_[1]), base_of(i_[1])}; }
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
        i_[0] = at(i_, order, h);
    }

    [[nodiscard]] const Coefficients& x() const { return x_; }
    [[nodiscard]] const Coefficients& v() const { return v_; }
    [[nodiscard]] const T& stop_position() const { return x_stop_; }
    [[nodiscard]] const T& stop_stiffness() const { return stiffness_; }
    [[nodiscard]] const T& stop_damping() const { return damping_; }
    [[nodiscard]] const T& omega() const { return omega_; }
    [[nodiscard]] const T& inverse_omega() const { return inverse_omega_; }
    [[nodiscard]] Base norm(int j) const {
        return larger_modulus(larger_modulus(base_of(x_[j]), base_of(v_[j])), base_of(i_[j]));
    }

    /// Power drawn, V cos(theta) i, and lost, R i^2 + c x'^2: coefficient n.
    [[nodiscard]] std::array<T, 2> power(int n) const {
        return {mean(coil::power, n), mean(coil::heat, n) + c_ * product(v_, v_, n)};
    }

    static constexpr PeakSignal peak_signal(int k) { return coil::peaks[static_cast<std::size_t>(k)]; }
    /// The current itself.
    int peak_series(int /*k*/, int /*part*/, int order, Coefficients& c) const {
        for (int n = 0; n <= order; ++n) { c[n] = i_[n]; }
        return order;
    }
    [[nodiscard]] T peak_value(int /*k*/, const T& m) const { return m; }
    [[nodiscard]] T mean(int k, int n) const {
        if (k == coil::heat) { return rho_ * inverse_beta_ * product(i_, i_, n); }
        return inverse_beta_ * product(drive_, i_, n);
    }

private:
    static T at(const Coefficients& c, int order, const Base& h) {
        T r = c[order];
        for (int j = order - 1; j >= 0; --j) { r = r * h + c[j]; }
        return r;
    }
    static T product(const Coefficients& a, const Coefficients& b, int n) {
        T sum = a[0] * b[n];
        for (int j = 1; j <= n; ++j) { sum += a[j] * b[n - j]; }
        return sum;
    }

    void start(const T& theta) {
        cosine_and_sine(theta, cos_, sin_);
        inverse_factorial_ = 1;
    }

    /// Coefficient n of the coil's force minus the forces of the suspension, given x up to there.
    T acceleration(int n) {
        square_[n] = product(x_, x_, n);
        const T sum = i_[n] - c_ * v_[n] - k1_ * x_[n] - k3_ * product(square_, x_, n);
        return n == 0 ? sum + bias_ : sum;
    }
    T stop_force(int n, const T& stiffness, const T& damping) const {
        const T penetration = n == 0 ? x_[0] - x_stop_ : x_[n];
        return stiffness * penetration + damping * v_[n];
    }
    void extend(int n, const T& acceleration) {
        if (n > 0) { inverse_factorial_ = inverse_factorial_ / static_cast<Real>(n); }
        // derivatives of cos cycle: cos, -sin, -cos, sin
        const Real sign = (n % 4 == 1 || n % 4 == 2) ? Real(-1) : Real(1);
        drive_[n] = voltage_ * (n % 2 == 0 ? cos_ : sin_) * (sign * inverse_factorial_);
        const Real reciprocal = Real(1) / static_cast<Real>(n + 1);
        x_[n + 1] = v_[n] * inverse_omega_ * reciprocal;
        v_[n + 1] = acceleration * inverse_omega_ * reciprocal;
        i_[n + 1] = (drive_[n] - rho_ * i_[n] - beta_ * v_[n]) * inverse_omega_ * reciprocal;
    }

    T c_, k1_, k3_, rho_, beta_, voltage_, x_stop_, stiffness_, damping_, omega_, bias_, inverse_omega_, inverse_beta_;
    T cos_{}, sin_{};
    Real inverse_factorial_ = 1;
    Coefficients x_, v_, i_, square_, drive_;
};

}  // namespace PERCUSS_ISA
}  // namespace percuss::model
