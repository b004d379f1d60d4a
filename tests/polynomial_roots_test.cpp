// Real roots in (0, 1]: none missed, none invented, each as good as its conditioning allows.

#include "engine_cases.hpp"
#include "numerics/polynomial_roots.hpp"

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <iomanip>
#include <sstream>
#include <string>
#include <vector>

using namespace percuss;
using numerics::Roots;

namespace {

using Real = long double;
constexpr double eps = std::numeric_limits<double>::epsilon();

/// Coefficients in long double, so that rounding to double is the only perturbation.
using Polynomial = std::vector<Real>;

Polynomial times(const Polynomial& a, const Polynomial& b) {
    Polynomial c(a.size() + b.size() - 1, 0.0L);
    for (std::size_t i = 0; i < a.size(); ++i) {
        for (std::size_t j = 0; j < b.size(); ++j) { c[i + j] += a[i] * b[j]; }
    }
    return c;
}
Polynomial linear(Real root) { return {-root, 1.0L}; }
/// (t - re)^2 + im^2
Polynomial pair(Real re, Real im) { return {re * re + im * im, -2.0L * re, 1.0L}; }

std::vector<double> rounded(const Polynomial& p) { return {p.begin(), p.end()}; }

template <class Coefficients>
Real value(const Coefficients& c, Real t) {
    Real sum = 0.0L;
    for (std::size_t j = c.size(); j-- > 0;) { sum = sum * t + c[j]; }
    return sum;
}
template <class Coefficients>
Real slope(const Coefficients& c, Real t) {
    Real sum = 0.0L;
    for (std::size_t j = c.size(); j-- > 1;) { sum = sum * t + static_cast<Real>(j) * c[j]; }
    return sum;
}
std::vector<Real> derivative(const std::vector<double>& c) {
    std::vector<Real> d;
    for (std::size_t j = 1; j < c.size(); ++j) { d.push_back(static_cast<Real>(j) * c[j]); }
    return d;
}
/// How far a simple root can be moved by errors of one unit in the last place of every coefficient, in evaluation and
/// in t itself.
double uncertainty(const std::vector<double>& c, double t) {
    double size = 0.0;
    for (std::size_t j = c.size(); j-- > 0;) { size = size * t + std::abs(c[j]); }
    return eps * (1.0 + size / std::abs(static_cast<double>(slope(c, t))));
}

Roots find(const std::vector<double>& c) { return numerics::sign_changes(c.data(), static_cast<int>(c.size()) - 1); }

/// A sign change seen by dense sampling, narrowed by bisection in long double.
struct Seen {
    double at;
    int sign;
};
std::vector<Seen> sampled(const std::vector<double>& c, int samples) {
    std::vector<Seen> found;
    Real before = value(c, 1e-300L);
    Real last = 0.0L;
    for (int i = 1; i <= samples; ++i) {
        const Real t = static_cast<Real>(i) / samples;
        const Real now = value(c, t);
        if ((before < 0.0L && now > 0.0L) || (before > 0.0L && now < 0.0L)) {
            Real low = last;
            Real high = t;
            for (int k = 0; k < 80; ++k) {
                const Real middle = 0.5L * (low + high);
                ((value(c, middle) > 0.0L) == (now > 0.0L) ? high : low) = middle;
            }
            found.push_back({static_cast<double>(high), now > 0.0L ? 1 : -1});
        }
        if (now != 0.0L) { before = now; }
        last = t;
    }
    return found;
}

std::string text(const std::vector<double>& c) {
    std::ostringstream out;
    out << std::setprecision(17);
    for (double x : c) { out << x << ' '; }
    return out.str();
}

/// Finds must be the expected roots, in order, with the right signs; ten units of conditioning are allowed.
void check_roots(const std::vector<double>& c, const std::vector<Seen>& expected) {
    const Roots roots = find(c);
    INFO("coefficients ", text(c));
    REQUIRE(roots.count == static_cast<int>(expected.size()));
    for (std::size_t i = 0; i < expected.size(); ++i) {
        CAPTURE(i);
        CHECK(std::abs(roots.at[i] - expected[i].at) <= 10.0 * uncertainty(c, expected[i].at));
        CHECK(roots.sign[i] == expected[i].sign);
    }
    for (int sign : {-1, 1}) {
        const auto first =
            std::find_if(expected.begin(), expected.end(), [&](const Seen& s) { return s.sign == sign; });
        double t = -1.0;
        const bool found = numerics::first_sign_change(c.data(), static_cast<int>(c.size()) - 1, sign, t);
        CHECK(found == (first != expected.end()));
        if (found && first != expected.end()) { CHECK(std::abs(t - first->at) <= 10.0 * uncertainty(c, first->at)); }
    }
}

}  // namespace

TEST_CASE("random polynomials with known roots, degree 1 to 17") {
    test::Random random(7);
    int used = 0;
    int roots_met = 0;
    for (int trial = 0; trial < 4000; ++trial) {
        const int degree = 1 + trial % 17;
        Polynomial p = {static_cast<Real>(random.uniform(-1.0, 1.0) < 0.0 ? -1.0 : 1.0)};
        std::vector<double> inside;
        while (static_cast<int>(p.size()) - 1 < degree) {
            const bool complex = degree + 1 - static_cast<int>(p.size()) >= 2 && random.uniform(0.0, 1.0) < 0.5;
            if (complex) {
                p = times(p, pair(random.uniform(-0.5, 1.5), random.uniform(0.05, 1.0)));
                continue;
            }
            const double root = random.uniform(-0.5, 1.5);
            p = times(p, linear(root));
            if (root > 0.0 && root <= 1.0) { inside.push_back(root); }
        }
        std::sort(inside.begin(), inside.end());
        const std::vector<double> c = rounded(p);
        // Where rounding of the coefficients could merge roots or push one over an end, nothing is promised.
        bool clear = true;
        double previous = 0.0;
        for (double root : inside) {
            const double blur = 50.0 * uncertainty(c, root);
            clear = clear && blur < root - previous && blur < 1.0 - root;
            previous = root + blur;
        }
        if (!clear) { continue; }
        ++used;
        std::vector<Seen> expected;
        for (double root : inside) { expected.push_back({root, slope(c, root) > 0.0L ? 1 : -1}); }
        roots_met += static_cast<int>(inside.size());
        CAPTURE(trial);
        check_roots(c, expected);
    }
    CHECK(used > 3500);
    CHECK(roots_met > 5000);
}

TEST_CASE("degree 17, like a displacement or velocity over a step: against dense sampling") {
    // Taylor coefficients of a sum of two oscillations and an offset, in units of the step.
    test::Random random(11);
    int crossings = 0;
    for (int trial = 0; trial < 300; ++trial) {
        std::vector<double> c(18, 0.0);
        for (int wave = 0; wave < 2; ++wave) {
            const double amplitude = random.uniform(-1.0, 1.0);
            const double frequency = random.uniform(0.1, 4.0);
            const double phase = random.uniform(0.0, 2.0 * std::numbers::pi);
            double term = amplitude;
            for (std::size_t j = 0; j < c.size(); ++j) {
                c[j] += term * std::cos(phase + 0.5 * std::numbers::pi * static_cast<double>(j));
                term *= frequency / static_cast<double>(j + 1);
            }
        }
        c[0] += random.uniform(-0.5, 0.5);
        const std::vector<Seen> expected = sampled(c, 20000);
        crossings += static_cast<int>(expected.size());
        CAPTURE(trial);
        check_roots(c, expected);
    }
    CHECK(crossings > 150);
}

TEST_CASE("two roots a millionth apart, deep inside or near an end, are both found") {
    // Between them the polynomial dips to -2.5e-13 of its scale, a thousand times the rounding of its coefficients.
    test::Random random(13);
    for (int trial = 0; trial < 500; ++trial) {
        const double where = trial % 5 == 0 ? random.uniform(2e-6, 1e-3) : random.uniform(1e-3, 1.0 - 2e-6);
        const Real half = 0.5e-6L;
        Polynomial p = times(linear(where - half), linear(where + half));
        const int more = trial % 6;
        for (int i = 0; i < more; ++i) { p = times(p, pair(random.uniform(-0.3, 1.3), random.uniform(0.5, 1.0))); }
        CAPTURE(trial);
        CAPTURE(where);
        check_roots(rounded(p), {{static_cast<double>(where - half), -1}, {static_cast<double>(where + half), 1}});
    }
}

TEST_CASE("touching without crossing is not an event") {
    // Rounding may turn a touch into two roots around it, sqrt(eps) apart, never into one.
    test::Random random(17);
    for (int trial = 0; trial < 200; ++trial) {
        const double where = trial < 4 ? std::array{0.5, 0.25, 0.75, 0.125}[static_cast<std::size_t>(trial)]
                                       : random.uniform(0.01, 0.99);
        Polynomial p = times(linear(where), linear(where));
        for (int i = 0; i < trial % 4; ++i) { p = times(p, pair(random.uniform(0.0, 1.0), random.uniform(0.5, 1.0))); }
        const std::vector<double> c = rounded(p);
        const Roots roots = find(c);
        double size = 0.0;
        for (double x : c) { size += std::abs(x); }
        const Real bend = slope(derivative(c), where);  // p = bend/2 (t - where)^2 nearby
        const double blur = std::sqrt(20.0 * eps * size / static_cast<double>(bend));
        INFO("coefficients ", text(c));
        CAPTURE(where);
        CHECK(roots.count % 2 == 0);
        for (int i = 0; i < roots.count; ++i) { CHECK(std::abs(roots.at[static_cast<std::size_t>(i)] - where) < blur); }
    }
    // A triple root is a crossing; it is only good to the cube root of eps.
    const Roots triple = find(rounded(times(linear(0.3L), times(linear(0.3L), linear(0.3L)))));
    REQUIRE(triple.count % 2 == 1);
    CHECK(std::abs(triple.at[0] - 0.3) < 2e-5);
}

TEST_CASE("roots at the ends: 0 is not in the interval, 1 is; one half, where the interval is cut, is seen once") {
    CHECK(find({0.0, 1.0}).count == 0);
    CHECK(find({0.0, 0.0, 1.0}).count == 0);
    check_roots({0.0, -0.5, 1.0}, {{0.5, 1}});
    check_roots({-0.5, 1.0}, {{0.5, 1}});
    // Exactly representable throughout, so that the first cut lands on the root at 1/2 to the last bit.
    check_roots({0.125, -0.75, 1.0}, {{0.25, -1}, {0.5, 1}});
    check_roots({0.375, -1.25, 1.0}, {{0.5, -1}, {0.75, 1}});
    check_roots(rounded(times(linear(0.5L), times(linear(0.25L), linear(0.75L)))), {{0.25, 1}, {0.5, -1}, {0.75, 1}});
    check_roots(rounded(times(linear(0.5L), pair(0.5L, 0.1L))), {{0.5, 1}});
    check_roots({-1.0, 1.0}, {{1.0, 1}});
    check_roots({1.0, -1.0}, {{1.0, -1}});
    check_roots(rounded(times(linear(1.0L), linear(0.5L))), {{0.5, -1}, {1.0, 1}});
    // A touch at 1 is none.
    CHECK(find(rounded(times(linear(1.0L), linear(1.0L)))).count == 0);
    // 1 - t^17: degree 17 with its only root at the end.
    std::vector<double> power(18, 0.0);
    power[0] = 1.0;
    power[17] = -1.0;
    check_roots(power, {{1.0, -1}});
}

TEST_CASE("degenerate polynomials") {
    CHECK(find({0.0}).count == 0);
    CHECK(find({1.0}).count == 0);
    CHECK(find({0.0, 0.0, 0.0}).count == 0);
    CHECK(find({1.0, 2.0, 3.0}).count == 0);
    check_roots({-0.25, 1.0, 0.0, 0.0, 0.0}, {{0.25, 1}});  // trailing zeros
    CHECK(find({std::nan(""), 1.0}).count == 0);
    // Scales at the limits of what a step can bring.
    check_roots({-1e-290, 2e-290}, {{0.5, 1}});
    check_roots({-1e290, 2e290}, {{0.5, 1}});
}

TEST_CASE("at most sixteen roots are returned, the first ones") {
    // Chebyshev polynomial of degree 17 on [0, 1]: roots (1 - cos((2 k + 1) pi/34))/2.
    Polynomial before = {1.0L};
    Polynomial now = {-1.0L, 2.0L};
    for (int n = 1; n < 17; ++n) {
        Polynomial next = times({-2.0L, 4.0L}, now);
        for (std::size_t j = 0; j < before.size(); ++j) { next[j] -= before[j]; }
        before = now;
        now = next;
    }
    const Roots roots = find(rounded(now));
    REQUIRE(roots.count == 16);
    for (int k = 0; k < 16; ++k) {
        const double expected = 0.5 * (1.0 - std::cos((2.0 * k + 1.0) * std::numbers::pi / 34.0));
        // Coefficients reach 1e12, slopes 17 to 300: 1e-16 1e12/17.
        CHECK(std::abs(roots.at[static_cast<std::size_t>(k)] - expected) < 1e-4);
        CHECK(roots.sign[static_cast<std::size_t>(k)] == (k % 2 == 0 ? 1 : -1));
    }
}
