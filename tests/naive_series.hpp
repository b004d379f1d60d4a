#pragma once
/// \file
/// Truncated power series in long double with schoolbook arithmetic, and Picard's iteration on top of them: Taylor
/// coefficients of any flow whose right-hand side is a template, without automatic-differentiation recurrences.

#include <array>
#include <cmath>
#include <cstddef>
#include <stdexcept>

namespace percuss::test {

/// c[0] + c[1] t + ... + c[N] t^N.
template <std::size_t N>
struct NaiveSeries {
    using Real = long double;
    std::array<Real, N + 1> c{};

    NaiveSeries() = default;
    NaiveSeries(double constant) { c[0] = constant; }  // NOLINT: constants mix freely with series

    friend NaiveSeries operator+(NaiveSeries a, const NaiveSeries& b) {
        for (std::size_t n = 0; n <= N; ++n) { a.c[n] += b.c[n]; }
        return a;
    }
    friend NaiveSeries operator-(NaiveSeries a, const NaiveSeries& b) {
        for (std::size_t n = 0; n <= N; ++n) { a.c[n] -= b.c[n]; }
        return a;
    }
    friend NaiveSeries operator-(const NaiveSeries& a) { return NaiveSeries(0.0) - a; }
    friend NaiveSeries operator*(const NaiveSeries& a, const NaiveSeries& b) {
        NaiveSeries r;
        for (std::size_t n = 0; n <= N; ++n) {
            for (std::size_t k = 0; k <= n; ++k) { r.c[n] += a.c[k] * b.c[n - k]; }
        }
        return r;
    }
    friend NaiveSeries operator/(const NaiveSeries& a, const NaiveSeries& b) {
        NaiveSeries r;
        for (std::size_t n = 0; n <= N; ++n) {
            Real sum = a.c[n];
            for (std::size_t k = 1; k <= n; ++k) { sum -= b.c[k] * r.c[n - k]; }
            r.c[n] = sum / b.c[0];
        }
        return r;
    }
    NaiveSeries& operator+=(const NaiveSeries& o) { return *this = *this + o; }
    NaiveSeries& operator-=(const NaiveSeries& o) { return *this = *this - o; }

    /// a^b for a constant exponent (Euler's recurrence, from a r' = b r a').
    friend NaiveSeries pow(const NaiveSeries& a, const NaiveSeries& b) {
        for (std::size_t n = 1; n <= N; ++n) {
            if (b.c[n] != 0.0L) { throw std::invalid_argument("naive series: the exponent must be constant"); }
        }
        NaiveSeries r;
        r.c[0] = std::pow(a.c[0], b.c[0]);
        for (std::size_t n = 1; n <= N; ++n) {
            Real sum = 0.0L;
            for (std::size_t k = 1; k <= n; ++k) {
                sum += (b.c[0] * static_cast<Real>(k) - static_cast<Real>(n - k)) * a.c[k] * r.c[n - k];
            }
            r.c[n] = sum / (static_cast<Real>(n) * a.c[0]);
        }
        return r;
    }
    friend NaiveSeries sqrt(const NaiveSeries& a) { return pow(a, NaiveSeries(0.5)); }
    friend NaiveSeries cos(const NaiveSeries& a) {
        NaiveSeries cosine;
        NaiveSeries sine;
        cosine.c[0] = std::cos(a.c[0]);
        sine.c[0] = std::sin(a.c[0]);
        for (std::size_t n = 1; n <= N; ++n) {
            for (std::size_t k = 1; k <= n; ++k) {
                const Real weight = static_cast<Real>(k) * a.c[k] / static_cast<Real>(n);
                cosine.c[n] -= weight * sine.c[n - k];
                sine.c[n] += weight * cosine.c[n - k];
            }
        }
        return cosine;
    }
    [[nodiscard]] Real value(Real t) const {
        Real sum = 0.0L;
        for (std::size_t n = N + 1; n-- > 0;) { sum = sum * t + c[n]; }
        return sum;
    }
};

/// Solution of y' = f(theta, y), y(theta_0) = y_0 as series in theta - theta_0: y <- y_0 + integral of f(theta, y)
/// gains one coefficient each time. f(theta, y, rate).
template <std::size_t N, std::size_t States, class Function>
std::array<NaiveSeries<N>, States> picard(double theta, const std::array<double, States>& start, Function&& f) {
    using Series = NaiveSeries<N>;
    Series phase(theta);
    phase.c[1] = 1.0L;
    std::array<Series, States> y;
    for (std::size_t i = 0; i < States; ++i) { y[i] = Series(start[i]); }
    for (std::size_t pass = 0; pass < N; ++pass) {
        std::array<Series, States> rate;
        f(phase, y.data(), rate.data());
        for (std::size_t i = 0; i < States; ++i) {
            for (std::size_t n = 1; n <= N; ++n) { y[i].c[n] = rate[i].c[n - 1] / static_cast<long double>(n); }
        }
    }
    return y;
}

}  // namespace percuss::test
