#pragma once
/// \file
/// Exact branch of the soft-impact problem, x'' + c x' + x + s max(x - 1, 0) = f cos(theta), theta = w t: both pieces
/// are linear, so motions with one contact per drive cycle are the roots of three closed equations in four unknowns.
/// Solved in long double with derivatives by the complex step, which are exact to rounding; independent of every
/// integrator.

#include "scenes.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <complex>
#include <optional>
#include <utility>

namespace percuss::bench {

class SoftImpactExact {
public:
    using Real = long double;
    /// One contact per cycle: frequency, drive phase at which it begins, speed then, and how long it lasts (in time).
    enum Unknown : std::size_t { frequency, entry, speed, duration };
    using Strike = std::array<Real, 4>;

    /// The motion in which one unknown has its value, near the given one. Empty without convergence.
    [[nodiscard]] std::optional<Strike> with_held(Strike z, Unknown held) const {
        return newton(z, [&](const Strike&) { return unit(held); });
    }

    /// The point of the branch nearest to z (to first order).
    [[nodiscard]] std::optional<Strike> nearest(const Strike& z) const {
        return newton(z, [&](const Strike& at) { return tangent(at); });
    }

    /// Distance of z from the branch, all unknowns counted alike; NaN without convergence.
    [[nodiscard]] double distance(const Strike& z) const {
        const auto near = nearest(z);
        if (!near) { return std::numeric_limits<double>::quiet_NaN(); }
        Real square = 0.0L;
        for (std::size_t k = 0; k < 4; ++k) { square += ((*near)[k] - z[k]) * ((*near)[k] - z[k]); }
        return static_cast<double>(std::sqrt(square));
    }

    /// The fold near z: d(frequency)/d(entry) = 0 by the secant method. The frequency, extremal, is good to rounding.
    [[nodiscard]] std::optional<Strike> fold(const Strike& z) const {
        auto a = with_held(z, entry);
        Strike beside = z;
        beside[entry] += 1e-3L;
        auto b = with_held(beside, entry);
        for (int iteration = 0; a && b && iteration < 60; ++iteration) {
            const Real sa = tangent(*a)[frequency];
            const Real sb = tangent(*b)[frequency];
            const Real step = sa == sb ? 0.0L : sb * ((*b)[entry] - (*a)[entry]) / (sb - sa);
            Strike next = *b;
            next[entry] -= step;
            a = b;
            b = with_held(next, entry);
            if (std::abs(step) <= 1e-12L) { return b; }
        }
        return std::nullopt;
    }

private:
    using Complex = std::complex<Real>;
    using ComplexStrike = std::array<Complex, 4>;
    using Defect = std::array<Complex, 3>;
    using Rows = std::array<Strike, 4>;
    /// Position and velocity.
    using Pair = std::pair<Complex, Complex>;

    /// x'' + c x' + k (x - centre) = f cos(phase + w t) from x, v over the time t.
    [[nodiscard]] Pair propagate(Pair from, Real k, Real centre, Complex w, Complex phase, Complex t) const {
        const Complex detuning = k - w * w;
        const Complex loss = c_ * w;
        const Complex scale = f_ / (detuning * detuning + loss * loss);
        const auto forced = [&](Complex theta) {
            const Complex co = std::cos(theta);
            const Complex si = std::sin(theta);
            return Pair{centre + scale * (detuning * co + loss * si), w * scale * (loss * co - detuning * si)};
        };
        const Pair before = forced(phase);
        const Pair after = forced(phase + w * t);
        const Real rate = 0.5L * c_;
        const Real own = std::sqrt(k - rate * rate);
        const Complex a = from.first - before.first;
        const Complex b = (from.second - before.second + rate * a) / own;
        const Complex fade = std::exp(-rate * t);
        const Complex co = std::cos(own * t);
        const Complex si = std::sin(own * t);
        const Complex x = fade * (a * co + b * si);
        return {after.first + x, after.second - rate * x + own * fade * (b * co - a * si)};
    }

    /// Contact: leaves x = 1 after its duration. Flight: arrives at x = 1 with the speed of entry.
    [[nodiscard]] Defect defect(const ComplexStrike& z) const {
        const Complex w = z[frequency];
        const Complex flight = 2.0L * pi_ / w - z[duration];
        const Pair out = propagate({1.0L, z[speed]}, 1.0L + s_, s_ / (1.0L + s_), w, z[entry], z[duration]);
        const Pair in = propagate(out, 1.0L, 0.0L, w, z[entry] + w * z[duration], flight);
        return {(out.first - 1.0L) / z[duration], in.first - 1.0L, in.second - z[speed]};
    }

    static ComplexStrike complexify(const Strike& z) { return {z[0], z[1], z[2], z[3]}; }

    static Strike unit(std::size_t k) {
        Strike e{};
        e[k] = 1.0L;
        return e;
    }

    /// Derivatives of the defect, closed by a last row.
    [[nodiscard]] Rows bordered(const Strike& at, const Strike& last) const {
        constexpr Real h = 1e-30L;
        Rows rows{};
        for (std::size_t column = 0; column < 4; ++column) {
            ComplexStrike z = complexify(at);
            z[column] += Complex(0.0L, h);
            const Defect f = defect(z);
            for (std::size_t row = 0; row < 3; ++row) { rows[row][column] = f[row].imag() / h; }
        }
        rows[3] = last;
        return rows;
    }

    /// Unit tangent of the branch, entry phase rising.
    [[nodiscard]] Strike tangent(const Strike& at) const {
        Strike t = solve(bordered(at, {0.2L, 1.0L, -0.3L, -0.2L}), unit(3));
        Real square = 0.0L;
        for (Real entry_of : t) { square += entry_of * entry_of; }
        for (Real& entry_of : t) { entry_of /= std::sqrt(square); }
        return t;
    }

    template <class LastRow>
    [[nodiscard]] std::optional<Strike> newton(Strike z, const LastRow& last_row) const {
        for (int iteration = 0; iteration < 40; ++iteration) {
            const Defect f = defect(complexify(z));
            const Strike step = solve(bordered(z, last_row(z)), {f[0].real(), f[1].real(), f[2].real(), 0.0L});
            Real size = 0.0L;
            for (std::size_t k = 0; k < 4; ++k) {
                z[k] -= step[k];
                size = std::max(size, std::abs(step[k]));
            }
            if (!(size < 1.0L)) { return std::nullopt; }
            if (size <= 1e-16L) { return z; }
        }
        return std::nullopt;
    }

    /// Gaussian elimination with row exchanges.
    static Strike solve(Rows m, Strike f) {
        for (std::size_t k = 0; k < 4; ++k) {
            std::size_t pivot = k;
            for (std::size_t i = k + 1; i < 4; ++i) {
                if (std::abs(m[i][k]) > std::abs(m[pivot][k])) { pivot = i; }
            }
            std::swap(m[k], m[pivot]);
            std::swap(f[k], f[pivot]);
            for (std::size_t i = k + 1; i < 4; ++i) {
                const Real factor = m[i][k] / m[k][k];
                for (std::size_t j = k; j < 4; ++j) { m[i][j] -= factor * m[k][j]; }
                f[i] -= factor * f[k];
            }
        }
        for (std::size_t k = 4; k-- > 0;) {
            for (std::size_t j = k + 1; j < 4; ++j) { f[k] -= m[k][j] * f[j]; }
            f[k] /= m[k][k];
        }
        return f;
    }

    static constexpr Real pi_ = 3.14159265358979323846264338327950288L;
    Real c_ = soft_impact[0];
    Real f_ = soft_impact[3];
    Real s_ = soft_impact[5];
};

}  // namespace percuss::bench
