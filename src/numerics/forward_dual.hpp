#pragma once
/// \file
/// A number with its derivative in one direction: just enough arithmetic to differentiate a formula that is evaluated
/// once in a while. The hot paths use their own lanes.

#include <cmath>

namespace percuss::numerics {

struct ForwardDual {
    double value = 0.0;
    double derivative = 0.0;

    ForwardDual() = default;
    ForwardDual(double v, double d = 0.0) : value(v), derivative(d) {}  // NOLINT: constants mix freely with duals
};

inline ForwardDual operator+(ForwardDual a, ForwardDual b) { return {a.value + b.value, a.derivative + b.derivative}; }
inline ForwardDual operator-(ForwardDual a, ForwardDual b) { return {a.value - b.value, a.derivative - b.derivative}; }
inline ForwardDual operator*(ForwardDual a, ForwardDual b) {
    return {a.value * b.value, a.derivative * b.value + a.value * b.derivative};
}
inline ForwardDual operator/(ForwardDual a, ForwardDual b) {
    const double quotient = a.value / b.value;
    return {quotient, (a.derivative - quotient * b.derivative) / b.value};
}
/// Not differentiable at zero: the derivative is infinite or NaN there.
inline ForwardDual sqrt(ForwardDual a) {
    const double root = std::sqrt(a.value);
    return {root, 0.5 * a.derivative / root};
}
/// Not differentiable at zero.
inline ForwardDual cbrt(ForwardDual a) {
    const double root = std::cbrt(a.value);
    return {root, a.derivative / (3.0 * root * root)};
}

}  // namespace percuss::numerics
