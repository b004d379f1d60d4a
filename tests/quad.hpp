#pragma once
/// \file
/// Quadruple precision as a scalar for the Taylor templates: __float128 in a class, so that exp, log, sqrt, cos and sin
/// are found by argument-dependent lookup. Needs gnu++20 and libquadmath.

#include <quadmath.h>

namespace percuss::test {

struct Quad {
    __float128 v;

    Quad() = default;
    constexpr Quad(double value) : v(value) {}  // NOLINT: constants mix freely with quads
    constexpr Quad(int value) : v(value) {}     // NOLINT
    constexpr explicit Quad(__float128 value) : v(value) {}
    explicit operator double() const { return static_cast<double>(v); }

    Quad& operator+=(const Quad& o) { return v += o.v, *this; }
    Quad& operator-=(const Quad& o) { return v -= o.v, *this; }
    Quad& operator*=(const Quad& o) { return v *= o.v, *this; }
    friend Quad operator-(const Quad& a) { return Quad(-a.v); }
    friend Quad operator+(const Quad& a, const Quad& b) { return Quad(a.v + b.v); }
    friend Quad operator-(const Quad& a, const Quad& b) { return Quad(a.v - b.v); }
    friend Quad operator*(const Quad& a, const Quad& b) { return Quad(a.v * b.v); }
    friend Quad operator/(const Quad& a, const Quad& b) { return Quad(a.v / b.v); }
    friend bool operator<(const Quad& a, const Quad& b) { return a.v < b.v; }
    friend bool operator>(const Quad& a, const Quad& b) { return a.v > b.v; }
    friend bool operator<=(const Quad& a, const Quad& b) { return a.v <= b.v; }
    friend bool operator>=(const Quad& a, const Quad& b) { return a.v >= b.v; }
    friend bool operator==(const Quad& a, const Quad& b) { return a.v == b.v; }
    friend bool operator!=(const Quad& a, const Quad& b) { return a.v != b.v; }

    friend Quad sqrt(const Quad& a) { return Quad(sqrtq(a.v)); }
    friend Quad exp(const Quad& a) { return Quad(expq(a.v)); }
    friend Quad log(const Quad& a) { return Quad(logq(a.v)); }
    friend Quad cos(const Quad& a) { return Quad(cosq(a.v)); }
    friend Quad sin(const Quad& a) { return Quad(sinq(a.v)); }
};

}  // namespace percuss::test
