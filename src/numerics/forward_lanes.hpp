#pragma once
/// \file
/// A number with its derivatives along N directions, as plain arrays: for formulas that are evaluated point by point
/// and with any exponents. Shares no code with the lanes of the kernels (numerics/dual.hpp), which it serves to check.

#include <array>
#include <cmath>
#include <cstddef>

namespace percuss::numerics {

template <int N>
struct ForwardLanes {
    using Derivatives = std::array<double, static_cast<std::size_t>(N)>;
    double value = 0.0;
    Derivatives d{};

    ForwardLanes() = default;
    ForwardLanes(double v) : value(v) {}  // NOLINT: constants mix freely with duals

    /// f(a) given f and f' at a.
    friend ForwardLanes chain(const ForwardLanes& a, double f, double slope) {
        ForwardLanes r(f);
        for (std::size_t j = 0; j < r.d.size(); ++j) { r.d[j] = slope * a.d[j]; }
        return r;
    }
    /// f(a, b) given f and its two partial derivatives.
    friend ForwardLanes chain(const ForwardLanes& a, const ForwardLanes& b, double f, double by_a, double by_b) {
        ForwardLanes r(f);
        for (std::size_t j = 0; j < r.d.size(); ++j) { r.d[j] = by_a * a.d[j] + by_b * b.d[j]; }
        return r;
    }

    friend ForwardLanes operator-(const ForwardLanes& a) { return chain(a, -a.value, -1.0); }
    friend ForwardLanes operator+(const ForwardLanes& a, const ForwardLanes& b) {
        return chain(a, b, a.value + b.value, 1.0, 1.0);
    }
    friend ForwardLanes operator-(const ForwardLanes& a, const ForwardLanes& b) {
        return chain(a, b, a.value - b.value, 1.0, -1.0);
    }
    friend ForwardLanes operator*(const ForwardLanes& a, const ForwardLanes& b) {
        return chain(a, b, a.value * b.value, b.value, a.value);
    }
    friend ForwardLanes operator/(const ForwardLanes& a, const ForwardLanes& b) {
        const double quotient = a.value / b.value;
        return chain(a, b, quotient, 1.0 / b.value, -quotient / b.value);
    }
    friend ForwardLanes operator+(const ForwardLanes& a, double b) { return chain(a, a.value + b, 1.0); }
    friend ForwardLanes operator+(double a, const ForwardLanes& b) { return chain(b, a + b.value, 1.0); }
    friend ForwardLanes operator-(const ForwardLanes& a, double b) { return chain(a, a.value - b, 1.0); }
    friend ForwardLanes operator-(double a, const ForwardLanes& b) { return chain(b, a - b.value, -1.0); }
    friend ForwardLanes operator*(const ForwardLanes& a, double b) { return chain(a, a.value * b, b); }
    friend ForwardLanes operator*(double a, const ForwardLanes& b) { return chain(b, a * b.value, a); }
    friend ForwardLanes operator/(const ForwardLanes& a, double b) { return chain(a, a.value / b, 1.0 / b); }
    friend ForwardLanes operator/(double a, const ForwardLanes& b) {
        const double quotient = a / b.value;
        return chain(b, quotient, -quotient / b.value);
    }
    ForwardLanes& operator+=(const ForwardLanes& o) { return *this = *this + o; }
    ForwardLanes& operator-=(const ForwardLanes& o) { return *this = *this - o; }

    friend ForwardLanes sqrt(const ForwardLanes& a) {
        const double root = std::sqrt(a.value);
        return chain(a, root, 0.5 / root);
    }
    friend ForwardLanes exp(const ForwardLanes& a) {
        const double power = std::exp(a.value);
        return chain(a, power, power);
    }
    friend ForwardLanes log(const ForwardLanes& a) { return chain(a, std::log(a.value), 1.0 / a.value); }
    friend ForwardLanes cos(const ForwardLanes& a) { return chain(a, std::cos(a.value), -std::sin(a.value)); }
    friend ForwardLanes sin(const ForwardLanes& a) { return chain(a, std::sin(a.value), std::cos(a.value)); }
    /// a^b with d(a^b) = b a^(b-1) da + a^b ln(a) db. Real for a > 0; at a = 0 the term in db is taken as zero, its
    /// limit for b > 0. Negative a gives what std::pow gives: NaN unless b is a whole number.
    friend ForwardLanes pow(const ForwardLanes& a, const ForwardLanes& b) {
        const double power = std::pow(a.value, b.value);
        const bool positive = a.value > 0.0;
        const double by_base = positive ? b.value * power / a.value : b.value * std::pow(a.value, b.value - 1.0);
        return chain(a, b, power, by_base, positive && b.moves() ? power * std::log(a.value) : 0.0);
    }

private:
    [[nodiscard]] bool moves() const {
        for (const double slope : d) {
            if (slope != 0.0) { return true; }
        }
        return false;
    }
};

}  // namespace percuss::numerics
