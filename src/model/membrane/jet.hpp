#pragma once
/// \file
/// Taylor coefficients of the dielectric elastomer actuator in the drive phase theta = omega tau, by the recurrences
/// of automatic differentiation. With s = 1 + u^2 and the log-derivative w = s'/s,
///
///     P = s^(alpha_A/2),  P' =  alpha_A/2 P w          Q = 1/P,  Q' = -alpha_A/2 Q w
///     S = s^(-1/2),       S' = -1/2 S w
///     L = (lambda_1/xi)^alpha_B,  L' = L z,  M = 1/L,  M' = -M z,   z = alpha_B (w/2 - r)
///     r = xi'/xi = (L - M/2 - 1/2)/(omega delta_B)
///     f = u { [k1 P - k2 Q + k3 (L - M)]/s - delta_A omega S' - phi^2 }
///
/// (primes: d/dtheta), which is the force of the paper's eq. (10) rearranged so that a step of any exponents needs nine
/// convolutions and one power. Both membranes go through the convolutions together as a Pair.

#include "model/membrane/membrane.hpp"
#include "numerics/dual.hpp"

#include <array>
#include <cmath>

namespace percuss::model {
inline namespace PERCUSS_ISA {

using numerics::as;
using numerics::base;
using numerics::Pair;
using numerics::ScalarTraits;

/// Viscous = false leaves out the Maxwell branch (mu_B = 0): the state is then (x, x').
template <class T, bool Viscous, int MaxOrder>
class MembraneJet {
public:
    using Scalar = T;
    using Base = typename ScalarTraits<T>::Base;
    static constexpr int states = Viscous ? 4 : 2;
    static constexpr int peaks = static_cast<int>(membrane::peaks.size());
    static consteval PeakSignal peak_signal(int k) { return membrane::peaks[static_cast<std::size_t>(k)]; }
    static constexpr int means = 0;
    static constexpr int max_order = MaxOrder;
    using State = std::array<T, states>;

    explicit MembraneJet(const T* p)
        : length_(p[membrane::length]),
          x_stop_(0.5 * p[membrane::length] + p[membrane::gap]),
          stiffness_(p[membrane::stiffness]),
          damping_(p[membrane::damping]),
          omega_(p[membrane::omega]),
          inverse_omega_(1.0 / p[membrane::omega]),
          half_alpha_a_(0.5 * p[membrane::alpha_a]),
          alpha_b_(p[membrane::alpha_b]),
          log_prestretch_(log_of(p[membrane::lambda_p])),
          layers_(p[membrane::layers]),
          voltage_(p[membrane::voltage]) {
        using std::exp;
        const T& lp_log = log_prestretch_;
        const T aa = p[membrane::alpha_a];
        k1_ = exp((aa - 2.0) * lp_log);
        k2_ = exp((-2.0 * aa - 2.0) * lp_log);
        k3_ = p[membrane::mu_ratio] * exp(-2.0 * lp_log);
        damping_rate_ = p[membrane::delta_a] * omega_;
        relaxation_ = inverse_omega_ / p[membrane::delta_b];
        phi_mean_ = voltage_ * voltage_ * 0.25;
    }

    /// Takes (x, x', xi_I, xi_II).
    void load(const State& y) {
        x_[0] = y[0];
        v_[0] = y[1];
        if constexpr (Viscous) {
            stretch_[0] = ratio(y[0], y[2]);
            stretch_[1] = ratio(y[0] - length_, y[3]);
        }
    }
    /// Gives back (x, x', xi_I, xi_II) of the expansion point.
    [[nodiscard]] State unload() const {
        State y;
        y[0] = x_[0];
        y[1] = v_[0];
        if constexpr (Viscous) {
            y[2] = dashpot(x_[0], stretch_[0]);
            y[3] = dashpot(x_[0] - length_, stretch_[1]);
        }
        return y;
    }
    /// d(state)/d(theta) at the expansion point; call after expand().
    [[nodiscard]] std::array<Base, states> rate() const {
        if constexpr (Viscous) {
            const State y = unload();
            return {base(x_[1]), base(v_[1]), base(y[2]) * base(r_[0].first()), base(y[3]) * base(r_[0].second())};
        } else {
            return {base(x_[1]), base(v_[1])};
        }
    }
    void set_position(const Base& x) { set_base(x_[0], x); }
    T& position() { return x_[0]; }
    T& velocity() { return v_[0]; }
    /// L = (lambda_1/xi)^alpha_B of both membranes at the expansion point, which is what is integrated instead of xi.
    std::array<T, 2>& stretch() { return stretch_; }

    /// Coefficients of x and v up to `order`, of everything else up to `order - 1`. theta is the phase at the expansion
    /// point; `touching` adds the stop's force.
    void expand(const T& theta, bool touching, int order) { expand(theta, touching, order, order); }

    /// As above, with derivative parts only up to `derivative_order` and zero beyond.
    void expand(const T& theta, bool touching, int order, int derivative_order) {
        start(theta);
        int n = 0;
        for (; n < derivative_order; ++n) { extend<T>(n, touching); }
        for (; n < order; ++n) { extend<Base>(n, touching); }
    }

    /// Moves the expansion point by h.
    void advance(const Base& h, int order) {
        x_[0] = at(x_, order, h);
        v_[0] = at(v_, order, h);
        if constexpr (Viscous) {
            Pair<T> value = l_[order];
            for (int j = order - 1; j >= 0; --j) { value = h * value + l_[j]; }
            stretch_[0] = value.first();
            stretch_[1] = value.second();
        }
    }

    using Coefficients = std::array<T, MaxOrder + 1>;
    [[nodiscard]] const Coefficients& x() const { return x_; }
    [[nodiscard]] const Coefficients& v() const { return v_; }
    [[nodiscard]] const T& stop_position() const { return x_stop_; }
    [[nodiscard]] const T& stop_stiffness() const { return stiffness_; }
    [[nodiscard]] const T& stop_damping() const { return damping_; }
    [[nodiscard]] const T& omega() const { return omega_; }
    [[nodiscard]] const T& inverse_omega() const { return inverse_omega_; }

    /// Largest modulus of the j-th coefficients over the state, for the step size.
    [[nodiscard]] Base norm(int j) const {
        Base m = larger(magnitude(base(x_[j])), magnitude(base(v_[j])));
        if constexpr (Viscous) {
            m = larger(m, larger(magnitude(base(l_[j].first())), magnitude(base(l_[j].second()))));
        }
        return m;
    }

    /// Field: s phi^2, the square of phi lambda_1 over that of lambda_p. Current: d(s phi)/dtau.
    int peak_series(int peak, int side, int order, Coefficients& out) const {
        if (peak == membrane::field) {
            for (int n = 0; n < order; ++n) {
                T sum(0.0);
                for (int j = 0; j <= n; ++j) { sum += s(side, j) * phi_squared(side, n - j); }
                out[n] = sum;
            }
            return order - 1;
        }
        for (int n = 0; n < order; ++n) {
            T charge(0.0);
            for (int j = 0; j <= n; ++j) { charge += s(side, j) * phi(side, n - j); }
            if (n > 0) { out[n - 1] = charge * (omega_ * static_cast<Base>(n)); }
        }
        return order - 2;
    }
    [[nodiscard]] T peak_value(int peak, const T& largest) const {
        using std::exp;
        using std::sqrt;
        return peak == membrane::field ? exp(log_prestretch_) * sqrt(largest) : largest;
    }

    /// Power of the drive and of the viscous losses, coefficient n (n below the expansion order), per unit tau.
    [[nodiscard]] std::array<T, 2> power(int n) const {
        T drive(0.0);
        T loss(0.0);
        // n sum of u phi^2 x' and n sum of [delta_A u^2 s^(-3/2) x'^2 + k3 (L - M) xi'/xi], where u s^(-3/2) x' =
        // -dS/dtau.
        for (int side = 0; side < 2; ++side) {
            for (int j = 0; j <= n; ++j) {
                T driven(0.0);
                T damped(0.0);
                for (int i = 0; i <= j; ++i) {
                    driven += u(side, i) * phi_squared(side, j - i);
                    damped += u(side, i) * (-damping_rate_ * slope(side, j - i));
                }
                drive += driven * v_[n - j];
                loss += damped * v_[n - j];
                if constexpr (Viscous) {
                    loss += k3_ * omega_ * (pick(l_[j], side) - pick(m_[j], side)) * pick(r_[n - j], side);
                }
            }
        }
        return {layers_ * drive, layers_ * loss};
    }

private:
    /// Squared drive phi^2 of membrane 0 or 1 and the drive phi itself, as coefficients in theta.
    [[nodiscard]] T phi_squared(int side, int n) const { return side == 0 ? phi2_[n].first() : phi2_[n].second(); }
    [[nodiscard]] T phi(int side, int n) const {
        const T swing = 0.5 * voltage_ * cos1_[n];
        const T mean = n == 0 ? 0.5 * voltage_ : T(0.0);
        return side == 0 ? mean - swing : mean + swing;
    }
    [[nodiscard]] T s(int side, int n) const { return side == 0 ? s_[n].first() : s_[n].second(); }
    static T log_of(const T& a) {
        using std::log;
        return log(a);
    }
    static Base magnitude(const Base& a) { return a < 0 ? -a : a; }
    static Base larger(const Base& a, const Base& b) { return a > b ? a : b; }
    static T pick(const Pair<T>& p, int side) { return side == 0 ? p.first() : p.second(); }
    static void set_base(T& target, const Base& value) {
        if constexpr (ScalarTraits<T>::lanes > 0) {
            target.v = value;
        } else {
            target = value;
        }
    }
    static T at(const Coefficients& c, int order, const Base& h) {
        T r = c[order];
        for (int j = order - 1; j >= 0; --j) { r = r * h + c[j]; }
        return r;
    }
    [[nodiscard]] T u(int side, int n) const { return side == 1 && n == 0 ? x_[0] - length_ : x_[n]; }
    [[nodiscard]] T slope(int side, int n) const { return pick(ds_[n], side); }

    [[nodiscard]] T ratio(const T& u, const T& xi) const {
        using std::exp;
        using std::log;
        return exp(alpha_b_ * (log_prestretch_ + 0.5 * log(1.0 + u * u) - log(xi)));
    }
    [[nodiscard]] T dashpot(const T& u, const T& l) const {
        using std::exp;
        using std::log;
        return exp(log_prestretch_ + 0.5 * log(1.0 + u * u) - log(l) / alpha_b_);
    }

    void start(const T& theta) {
        using std::cos;
        using std::exp;
        using std::log;
        using std::sin;
        using std::sqrt;
        cos1_[0] = cos(theta);
        sin1_ = sin(theta);
        cos2_ = 2.0 * cos1_[0] * cos1_[0] - 1.0;
        sin2_ = 2.0 * sin1_ * cos1_[0];
        u_.set(0, Pair<T>(x_[0], x_[0] - length_));
        s_.set(0, Pair<T>(1.0 + x_[0] * x_[0], 1.0 + u_[0].second() * u_[0].second()));
        const T s1 = s_[0].first();
        const T s2 = s_[0].second();
        inverse_s_ = Pair<T>(1.0 / s1, 1.0 / s2);
        const T p1 = exp(half_alpha_a_ * log(s1));
        const T p2 = exp(half_alpha_a_ * log(s2));
        p_.set(0, Pair<T>(p1, p2));
        q_.set(0, Pair<T>(1.0 / p1, 1.0 / p2));
        root_.set(0, Pair<T>(1.0 / sqrt(s1), 1.0 / sqrt(s2)));
        if constexpr (Viscous) {
            l_.set(0, Pair<T>(stretch_[0], stretch_[1]));
            m_.set(0, Pair<T>(1.0 / stretch_[0], 1.0 / stretch_[1]));
        }
    }

    /// phi^2 = phi_pp^2/4 (1 -+ 2 cos theta + cos^2 theta), coefficient n.
    template <class S>
    Pair<S> drive(int n) {
        if (n > 0) {
            inverse_factorial_ = inverse_factorial_ / static_cast<Base>(n);
            power_of_two_ = power_of_two_ * 2;
        } else {
            inverse_factorial_ = 1;
            power_of_two_ = 1;
        }
        // derivatives of cos cycle: cos, -sin, -cos, sin
        const S& cycle1 = as<S>(n % 2 == 0 ? cos1_[0] : sin1_);
        const S& cycle2 = as<S>(n % 2 == 0 ? cos2_ : sin2_);
        const Base sign = (n % 4 == 1 || n % 4 == 2) ? Base(-1) : Base(1);
        const S c1 = cycle1 * (sign * inverse_factorial_);
        const S c2 = cycle2 * (sign * inverse_factorial_ * power_of_two_);
        if (n > 0) { cos1_[n] = T(c1); }
        const S even = (n == 0 ? S(1.5) : S(0.0)) + 0.5 * c2;
        const S& mean = as<S>(phi_mean_);
        return Pair<S>(mean * (even - 2.0 * c1), mean * (even + 2.0 * c1));
    }

    /// From coefficients 0..n of x, v, L (and the internal series) to coefficient n + 1, in S: the scalar T, or its
    /// base type where the derivative parts are left out.
    template <class S>
    void extend(int n, bool touching) {
        const Base reciprocal = Base(1) / static_cast<Base>(n + 1);
        const S& inverse_omega = as<S>(inverse_omega_);
        const S& speed = as<S>(v_[n]);
        x_[n + 1] = T(speed * inverse_omega * reciprocal);
        u_.set(n + 1, Pair<S>(as<S>(x_[n + 1])));

        // All convolutions over already known coefficients, in one sweep.
        const Pair<S> zero(S(0.0));
        const Pair<S> first_u = u_.template get<S>(0);
        const Pair<S> next_u = u_.template get<S>(n + 1);
        Pair<S> square = first_u * next_u;
        Pair<S> sw = zero, pw = zero, qw = zero, rw = zero, lz = zero, mz = zero, se = zero, ub = zero;
        for (int j = 1; j <= n; ++j) {
            const Pair<S> u = u_.template get<S>(j);
            const Pair<S> s = s_.template get<S>(j);
            const Pair<S> w = w_.template get<S>(n - j);
            square.add_product(u, u_.template get<S>(n + 1 - j));
            sw.add_product(s, w);
            pw.add_product(p_.template get<S>(j), w);
            qw.add_product(q_.template get<S>(j), w);
            rw.add_product(root_.template get<S>(j), w);
            se.add_product(s, e_.template get<S>(n - j));
            ub.add_product(u, b_.template get<S>(n - j));
            if constexpr (Viscous) {
                const Pair<S> z = z_.template get<S>(n - j);
                lz.add_product(l_.template get<S>(j), z);
                mz.add_product(m_.template get<S>(j), z);
            }
        }
        const Pair<S> inverse_s = numerics::pair_as<S>(inverse_s_);
        const S& half_alpha = as<S>(half_alpha_a_);
        // s = 1 + u^2; s w = s' solved for the newest coefficient of w.
        const Pair<S> next_s = square + next_u * first_u;
        const Pair<S> w = inverse_s * (static_cast<Base>(n + 1) * next_s - sw);
        s_.set(n + 1, next_s);
        w_.set(n, w);
        // P' = alpha_A/2 P w, Q' = -alpha_A/2 Q w, S' = -1/2 S w.
        pw.add_product(p_.template get<S>(0), w);
        qw.add_product(q_.template get<S>(0), w);
        rw.add_product(root_.template get<S>(0), w);
        p_.set(n + 1, (half_alpha * reciprocal) * pw);
        q_.set(n + 1, (-half_alpha * reciprocal) * qw);
        const Pair<S> slope = Base(-0.5) * rw;
        ds_.set(n, slope);
        root_.set(n + 1, reciprocal * slope);

        Pair<S> stress = as<S>(k1_) * p_.template get<S>(n) - as<S>(k2_) * q_.template get<S>(n);
        if constexpr (Viscous) {
            // r = (L - M/2 - 1/2)/(omega delta_B), z = alpha_B (w/2 - r), L' = L z, M' = -M z.
            const Pair<S> l = l_.template get<S>(n);
            const Pair<S> m = m_.template get<S>(n);
            const Pair<S> r = as<S>(relaxation_) * (l - Base(0.5) * m - (n == 0 ? Pair<S>(S(0.5)) : zero));
            const Pair<S> z = as<S>(alpha_b_) * (Base(0.5) * w - r);
            r_.set(n, r);
            z_.set(n, z);
            lz.add_product(l_.template get<S>(0), z);
            mz.add_product(m_.template get<S>(0), z);
            l_.set(n + 1, reciprocal * lz);
            m_.set(n + 1, (-reciprocal) * mz);
            stress = stress + as<S>(k3_) * (l - m);
        }
        // e = [k1 P - k2 Q + k3 (L - M)]/s as s e = [...], f = u b with b = e - delta_A omega S' - phi^2.
        const Pair<S> e = inverse_s * (stress - se);
        const Pair<S> phi2 = drive<S>(n);
        const Pair<S> b = e - as<S>(damping_rate_) * slope - phi2;
        e_.set(n, e);
        phi2_.set(n, phi2);
        b_.set(n, b);
        ub.add_product(first_u, b);

        // dx'/dtau = -n (f_I + f_II) - f_stop, and over omega the derivative in theta.
        S acceleration = -as<S>(layers_) * (ub.first() + ub.second());
        if (touching) {
            const S penetration = n == 0 ? as<S>(x_[0]) - as<S>(x_stop_) : as<S>(x_[n]);
            acceleration -= as<S>(stiffness_) * penetration + as<S>(damping_) * speed;
        }
        v_[n + 1] = T(acceleration * inverse_omega * reciprocal);
    }

    T length_, x_stop_, stiffness_, damping_, omega_, inverse_omega_, half_alpha_a_, alpha_b_, log_prestretch_, layers_,
        voltage_;
    T k1_, k2_, k3_, damping_rate_, relaxation_, phi_mean_;
    std::array<T, 2> stretch_;
    T sin1_, cos2_, sin2_;
    Base inverse_factorial_ = 1;
    Base power_of_two_ = 1;
    Coefficients x_, v_, cos1_;
    Pair<T> inverse_s_;
    numerics::PairSeries<T, MaxOrder + 1> u_, s_, w_, p_, q_, root_, ds_, l_, m_, r_, z_, e_, b_, phi2_;
};

}  // namespace PERCUSS_ISA
}  // namespace percuss::model
