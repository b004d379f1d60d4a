#pragma once
/// \file
/// Polishing of a root that is known to lie between two points.

#include <algorithm>
#include <cmath>
#include <limits>

namespace percuss::flow {

/// Strictly opposite signs; a zero or a NaN has none.
inline bool opposite_signs(double a, double b) { return (a < 0.0 && b > 0.0) || (a > 0.0 && b < 0.0); }

/// A function and its derivative at one point; the derivative may be NaN when it is not known.
struct RootSample {
    double value = 0.0;
    double slope = std::numeric_limits<double>::quiet_NaN();
};

struct RootEnd {
    double at = 0.0;
    RootSample sample;
};

/// Root of the cubic that fits values and slopes at both ends, or of the straight line when a slope is not known.
inline double first_guess(const RootEnd& a, const RootEnd& b) {
    const double h = b.at - a.at;
    const double f0 = a.sample.value;
    const double f1 = b.sample.value;
    // The straight line; s runs from 0 at a to 1 at b.
    double s = f0 / (f0 - f1);
    const double d0 = a.sample.slope * h;
    const double d1 = b.sample.slope * h;
    if (std::isfinite(d0) && std::isfinite(d1)) {
        const double c2 = 3.0 * (f1 - f0) - 2.0 * d0 - d1;
        const double c3 = d0 + d1 - 2.0 * (f1 - f0);
        double low = 0.0;
        double high = 1.0;
        // Newton on the cubic, kept inside a bracket. Bisection alone would reach 1e-6 in 20 steps, and this is only
        // the first guess for the polishing that follows.
        for (int i = 0; i < 20; ++i) {
            const double f = f0 + s * (d0 + s * (c2 + s * c3));
            (opposite_signs(f, f1) ? low : high) = s;
            const double next = s - f / (d0 + s * (2.0 * c2 + 3.0 * s * c3));
            const double previous = s;
            s = next > low && next < high ? next : 0.5 * (low + high);
            if (std::abs(s - previous) < 1e-12) { break; }
        }
    }
    return a.at + h * s;
}

/// Newton's method (or the secant method where the slope is not known) kept inside a shrinking bracket. The values at
/// the ends must have opposite signs. Stops when the step is below the spacing of floating-point numbers there.
template <class Function>
double bracketed_root(RootEnd a, RootEnd b, Function&& function) {
    double t = first_guess(a, b);
    // The secant needs a second point from the beginning: the end that is nearer to the root.
    RootEnd previous = std::abs(a.sample.value) < std::abs(b.sample.value) ? a : b;
    double last_move = std::abs(b.at - a.at);
    // Bisection alone takes some 52 halvings to the spacing of numbers of one size, a few more towards a root near
    // zero.
    for (int i = 0; i < 100; ++i) {
        const RootEnd current{t, function(t)};
        if (current.sample.value == 0.0) { return t; }
        (opposite_signs(current.sample.value, b.sample.value) ? a : b) = current;
        double slope = current.sample.slope;
        if (!std::isfinite(slope)) {
            slope = (current.sample.value - previous.sample.value) / (current.at - previous.at);
        }
        const double step = -current.sample.value / slope;
        const double low = std::min(a.at, b.at);
        const double high = std::max(a.at, b.at);
        double next = t + step;
        // A step out of the bracket, or one longer than half of the last bracket, does not converge (Newton circling an
        // inflection, a secant across one): bisect. NaN fails all three comparisons and is bisected too.
        if (!(next >= low && next <= high) || !(std::abs(step) <= last_move)) { next = 0.5 * (low + high); }
        last_move = 0.5 * std::abs(b.at - a.at);
        const double spacing = 2.0 * std::numeric_limits<double>::epsilon() * std::max(std::abs(low), std::abs(high));
        if (std::abs(next - t) <= spacing || high - low <= spacing) { return next; }
        previous = current;
        t = next;
    }
    return t;
}

}  // namespace percuss::flow
