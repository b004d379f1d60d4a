// The Taylor integrator on smooth motion: coefficients, order, closed forms, the reference orbit, agreement of kernels.

#include "engine_cases.hpp"
#include "flow/sundials.hpp"
#include "flow/taylor_order.hpp"
#include "kernels/plain_systems.hpp"
#include "model/membrane_jet.hpp"
#include "model/plain_rhs.hpp"
#include "model/spring_jet.hpp"
#include "naive_series.hpp"

#include <doctest/doctest.h>

#include <cmath>
#include <string>
#include <vector>

using namespace percuss;
using flow::ParameterVector;
using flow::State;
using flow::Status;
using test::at;
using test::membranes;
using test::paper_defaults;
using test::two_pi;

namespace {

constexpr int top_order = 24;
using Viscous = model::MembraneJet<double, true, top_order>;
using Elastic = model::MembraneJet<double, false, top_order>;
using Spring = model::SpringJet<double, top_order>;

/// A place to expand at: parameters, phase, state, whether the stop acts.
struct Place {
    ParameterVector p{};
    double theta = 0.0;
    State state{};
    bool touching = false;
};

Place random_membranes(test::Random& random) {
    Place place;
    place.p = {random.uniform(1.05, 1.4), random.uniform(0.2, 1.5), random.uniform(2.1, 4.3), random.uniform(1.5, 3.0),
               random.uniform(0.02, 0.5), random.uniform(5.0, 300.0), random.uniform(0.5, 1.2),
               random.uniform(0.05, 0.2), random.log_uniform(100.0, 1e4), random.uniform(0.0, 3.0),
               random.uniform(0.2, 0.6), random.uniform(1.0, 4.0), random.uniform(1.0, 4.0)};
    place.theta = random.uniform(-4.0, 4.0);
    const double rest = place.p[model::membrane::lambda_p] * std::sqrt(1.0 + 0.25 * std::pow(place.p[6], 2));
    place.state = {0.5 * place.p[6] + random.uniform(-0.2, 0.2), random.uniform(-0.3, 0.3),
                   rest * random.uniform(0.95, 1.05), rest * random.uniform(0.95, 1.05)};
    place.touching = random.uniform(0.0, 1.0) < 0.5;
    return place;
}
Place random_elastic(test::Random& random) {
    Place place = random_membranes(random);
    place.p[model::membrane::mu_ratio] = 0.0;
    return place;
}
Place random_spring(test::Random& random) {
    Place place;
    place.p = {random.uniform(0.0, 0.4),       random.uniform(0.5, 2.0), random.uniform(-0.5, 1.0),
               random.uniform(0.1, 1.0),       random.uniform(0.3, 1.0), random.log_uniform(10.0, 1e4),
               random.uniform(0.0, 3.0),       random.uniform(0.5, 3.0)};
    place.theta = random.uniform(-4.0, 4.0);
    place.state = {random.uniform(-1.0, 1.0), random.uniform(-1.0, 1.0)};
    place.touching = random.uniform(0.0, 1.0) < 0.5;
    return place;
}

template <class Jet>
typename Jet::State start_of(const Place& place) {
    typename Jet::State y;
    for (std::size_t k = 0; k < y.size(); ++k) { y[k] = place.state[k]; }
    return y;
}

/// State after one step of length h with the given order.
template <class Jet>
typename Jet::State stepped(const Place& place, double h, int order) {
    Jet jet(place.p.data());
    jet.load(start_of<Jet>(place));
    jet.expand(place.theta, place.touching, order);
    jet.advance(h, order);
    return jet.unload();
}

template <class Jet>
double step_error(const Place& place, double h, int order) {
    const auto a = stepped<Jet>(place, h, order);
    const auto b = stepped<Jet>(place, h, top_order);
    double error = 0.0;
    for (std::size_t k = 0; k < a.size(); ++k) { error = std::max(error, std::abs(a[k] - b[k])); }
    return error;
}

using Series = test::NaiveSeries<top_order>;

/// Coefficients by Picard's iteration on the printed equations. Elastic places have mu_ratio = 0: the stretches act on
/// nothing there.
std::array<Series, 4> membrane_series(const Place& place) {
    std::array<Series, model::membrane::count> p;
    for (std::size_t k = 0; k < p.size(); ++k) { p[k] = Series(place.p[k]); }
    return test::picard<top_order, 4>(place.theta, place.state, [&](const Series& theta, const Series* y, Series* rate) {
        model::membrane_rhs(p.data(), theta, y, place.touching, rate);
    });
}
std::array<Series, 2> spring_series(const Place& place) {
    std::array<Series, model::spring::count> p;
    for (std::size_t k = 0; k < p.size(); ++k) { p[k] = Series(place.p[k]); }
    const std::array<double, 2> start = {place.state[0], place.state[1]};
    return test::picard<top_order, 2>(place.theta, start, [&](const Series& theta, const Series* y, Series* rate) {
        model::spring_rhs(p.data(), theta, y, place.touching, rate);
    });
}

/// Coefficients of x and v, and the whole state a short way on.
template <class Jet, std::size_t States>
void check_coefficients(const Place& place, const std::array<Series, States>& expected) {
    Jet jet(place.p.data());
    jet.load(start_of<Jet>(place));
    jet.expand(place.theta, place.touching, top_order);
    // The coefficients of a motion with a shortest time scale 1/r grow like r^n: errors count against the largest
    // r^n seen so far. The recurrences pass each rounding on to at most a few dozen sums.
    double rate = 1.0;
    for (int n = 0; n <= top_order; ++n) {
        CAPTURE(n);
        const double x = static_cast<double>(expected[0].c[at(n)]);
        const double v = static_cast<double>(expected[1].c[at(n)]);
        if (n > 0) { rate = std::max(rate, std::pow(std::max(std::abs(x), std::abs(v)), 1.0 / n)); }
        const double scale = std::pow(rate, n);
        CHECK(std::abs(jet.x()[at(n)] - x) < 1e-13 * scale);
        CHECK(std::abs(jet.v()[at(n)] - v) < 1e-13 * scale);
    }
    const auto slope = jet.rate();
    const double h = 0.05 / rate;  // 0.05^25 is nothing
    jet.advance(h, top_order);
    const auto moved = jet.unload();
    for (std::size_t k = 0; k < moved.size(); ++k) {
        CAPTURE(k);
        CHECK(std::abs(moved[k] - static_cast<double>(expected[k].value(h))) < 1e-14);
        CHECK(slope[k] == doctest::Approx(static_cast<double>(expected[k].c[1])).epsilon(1e-12));
    }
}

/// Local error falls like h^(p+1): two-sided.
template <class Jet>
void check_order(const Place& place) {
    for (int order : {3, 5, 8, 11, 14}) {
        double h = 6.0;
        while (!(step_error<Jet>(place, h, order) < 1e-4)) { h *= 0.8; }
        int halvings = 0;
        double coarse = step_error<Jet>(place, h, order);
        double slope = 0.0;
        // Until the next error would be rounding. Early slopes are not asymptotic yet; the last one counts.
        while (coarse / std::pow(2.0, order + 1) > 2e-14) {
            h *= 0.5;
            const double fine = step_error<Jet>(place, h, order);
            slope = std::log2(coarse / fine);
            coarse = fine;
            ++halvings;
        }
        CAPTURE(order);
        CAPTURE(halvings);
        REQUIRE(halvings >= 1);
        CHECK(std::abs(slope - (order + 1)) < 0.3);
    }
}

flow::Request reference_request() {
    flow::Request request;
    request.state = test::reference_orbits[0].state;
    request.duration = two_pi;
    return request;
}

}  // namespace

TEST_CASE("Taylor coefficients agree with Picard's iteration on the printed equations") {
    test::Random random(3);
    for (int trial = 0; trial < 30; ++trial) {
        CAPTURE(trial);
        const Place viscous = random_membranes(random);
        check_coefficients<Viscous, 4>(viscous, membrane_series(viscous));
        const Place elastic = random_elastic(random);
        check_coefficients<Elastic, 4>(elastic, membrane_series(elastic));
        const Place spring = random_spring(random);
        check_coefficients<Spring, 2>(spring, spring_series(spring));
    }
}

TEST_CASE("the local error of a step of order p falls like h^(p+1)") {
    test::Random random(5);
    for (int trial = 0; trial < 5; ++trial) {
        CAPTURE(trial);
        Place place = random_membranes(random);
        place.touching = false;
        check_order<Viscous>(place);
        place = random_elastic(random);
        place.touching = false;
        check_order<Elastic>(place);
        place = random_spring(random);
        place.touching = false;
        check_order<Spring>(place);
    }
}

TEST_CASE("the reference orbit at omega = 1.9 closes after one period") {
    const auto integrator = membranes();
    const flow::Result result = test::run(*integrator, paper_defaults, reference_request());
    REQUIRE(result.status == Status::ok);
    // State given to 5e-15, stretched by at most a few over a period; integration error below 1e-14.
    CHECK(test::distance(result.state, test::reference_orbits[0].state, 4) < 1e-13);
}
