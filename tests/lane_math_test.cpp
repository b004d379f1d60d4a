// Elementary functions of SIMD lanes: accuracy against 80-bit arithmetic, special values, independence of lanes.

#include "numerics/lane_math.hpp"

#include "engine_cases.hpp"

#include <doctest/doctest.h>

#include <bit>
#include <cmath>
#include <cstdint>
#include <limits>

using namespace percuss;

namespace {

constexpr int lanes = 8;
using V = numerics::LaneVector<lanes>;
constexpr double infinity = std::numeric_limits<double>::infinity();
const double not_a_number = std::nan("");

template <class Function>
V filled(Function&& value) {
    V a{};
    for (std::size_t i = 0; i < lanes; ++i) { a.set(i, value()); }
    return a;
}

/// |got - exact| in units of the last place of `exact`, or of `floor` when that is larger.
double ulps(double got, long double exact, double floor = 0.0) {
    const double size = std::max(std::abs(static_cast<double>(exact)), floor);
    const double unit = std::nextafter(size, infinity) - size;
    return static_cast<double>(std::abs(static_cast<long double>(got) - exact)) / unit;
}

}  // namespace

TEST_CASE("logarithm, exponential, cosine and sine of lanes are good to about the last place") {
    test::Random random(7);
    double worst_log = 0.0;
    double worst_exp = 0.0;
    double worst_circle = 0.0;
    for (int round = 0; round < 20000; ++round) {
        // around one, where the logarithm is small, and over the whole range
        const V a =
            filled([&] { return round % 2 == 0 ? random.uniform(0.7, 1.5) : random.log_uniform(1e-300, 1e300); });
        const V b = filled([&] { return round % 2 == 0 ? random.uniform(-1.0, 1.0) : random.uniform(-700.0, 700.0); });
        const V angle = filled([&] { return random.uniform(-1.0, 1.0) * (round % 2 == 0 ? 10.0 : 1e4); });
        const V log_a = log(a);
        const V exp_b = exp(b);
        V c;
        V s;
        cos_sin(angle, c, s);
        for (std::size_t i = 0; i < lanes; ++i) {
            worst_log = std::max(worst_log, ulps(log_a[i], std::log(static_cast<long double>(a[i]))));
            worst_exp = std::max(worst_exp, ulps(exp_b[i], std::exp(static_cast<long double>(b[i]))));
            // relative to the amplitude of one
            worst_circle = std::max(worst_circle, ulps(c[i], std::cos(static_cast<long double>(angle[i])), 0.5));
            worst_circle = std::max(worst_circle, ulps(s[i], std::sin(static_cast<long double>(angle[i])), 0.5));
        }
    }
    CHECK(worst_log < 2.0);
    CHECK(worst_exp < 2.0);
    CHECK(worst_circle < 2.0);
    // The argument itself has an uncertainty of half a unit in its last place: 1e6 is good to 1e-10, its cosine as
    // well, but as a function of the number given it is better than that.
    V c;
    V s;
    cos_sin(numerics::all_lanes<lanes>(1e6), c, s);
    CHECK(std::abs(c[0] - static_cast<double>(std::cos(1e6L))) < 1e-15);
    CHECK(std::abs(s[0] - static_cast<double>(std::sin(1e6L))) < 1e-15);
}

TEST_CASE("special values stay in their lane") {
    V a = numerics::all_lanes<lanes>(1.25);
    const V log_plain = log(a);
    const V exp_plain = exp(a);
    V c_plain;
    V s_plain;
    cos_sin(a, c_plain, s_plain);
    for (double special : {not_a_number, infinity, -infinity, 0.0, 1e300}) {
        CAPTURE(special);
        a.set(3, special);
        V c;
        V s;
        cos_sin(a, c, s);
        const V log_a = log(a);
        const V exp_a = exp(a);
        for (std::size_t i = 0; i < lanes; ++i) {
            if (i == 3) { continue; }
            CHECK(log_a[i] == log_plain[i]);
            CHECK(exp_a[i] == exp_plain[i]);
            CHECK(c[i] == c_plain[i]);
            CHECK(s[i] == s_plain[i]);
        }
        if (std::isnan(special)) {
            CHECK(std::isnan(log_a[3]));
            CHECK(std::isnan(exp_a[3]));
            CHECK(std::isnan(c[3]));
            CHECK(std::isnan(s[3]));
        }
        if (special == infinity) { CHECK(log_a[3] == infinity); }
        if (special == infinity) { CHECK(exp_a[3] == infinity); }
        if (special == -infinity) { CHECK(exp_a[3] < 1e-300); }
        if (special == 0.0) {
            CHECK(log_a[3] < -700.0);
            CHECK(exp_a[3] == 1.0);
            CHECK(c[3] == 1.0);
            CHECK(s[3] == 0.0);
        }
    }
    CHECK(log(numerics::all_lanes<lanes>(1.0))[0] == 0.0);
}
