// The Taylor integrator on smooth motion: coefficients, order, closed forms, the reference orbit, agreement of kernels.

#include "engine_cases.hpp"
#include "flow/sundials.hpp"
#include "flow/taylor_order.hpp"
#include "kernels/plain_systems.hpp"
#include "model/membrane/jet.hpp"
#include "model/membrane/membrane.hpp"
#include "model/membrane/plain.hpp"
#include "model/spring/jet.hpp"
#include "model/spring/plain.hpp"
#include "model/spring/spring.hpp"
#include "naive_series.hpp"
#include "relative.hpp"

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
    place.p = {random.uniform(1.05, 1.4), random.uniform(0.2, 1.5),  random.uniform(2.1, 4.3),
               random.uniform(1.5, 3.0),  random.uniform(0.02, 0.5), random.uniform(5.0, 300.0),
               random.uniform(0.5, 1.2),  random.uniform(0.05, 0.2), random.log_uniform(100.0, 1e4),
               random.uniform(0.0, 3.0),  random.uniform(0.2, 0.6),  random.uniform(1.0, 4.0),
               random.uniform(1.0, 4.0)};
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
    place.p = {random.uniform(0.0, 0.4), random.uniform(0.5, 2.0), random.uniform(-0.5, 1.0),
               random.uniform(0.1, 1.0), random.uniform(0.3, 1.0), random.log_uniform(10.0, 1e4),
               random.uniform(0.0, 3.0), random.uniform(0.5, 3.0)};
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

/// State after one step of length h with the given order, in long double: room for several halvings of h.
constexpr int reference_order = 40;
using Real = long double;
template <template <class, int> class Jet>
std::vector<Real> stepped(const Place& place, Real h, int order) {
    using LongJet = Jet<Real, reference_order>;
    std::array<Real, flow::max_parameters> p;
    std::copy(place.p.begin(), place.p.end(), p.begin());
    typename LongJet::State y;
    std::copy_n(place.state.begin(), y.size(), y.begin());
    LongJet jet(p.data());
    jet.load(y);
    jet.expand(static_cast<Real>(place.theta), place.touching, order);
    jet.advance(h, order);
    y = jet.unload();
    return {y.begin(), y.end()};
}

template <template <class, int> class Jet>
double step_error(const Place& place, Real h, int order) {
    const auto a = stepped<Jet>(place, h, order);
    const auto b = stepped<Jet>(place, h, reference_order);
    Real error = 0.0L;
    for (std::size_t k = 0; k < a.size(); ++k) { error = std::max(error, std::abs(a[k] - b[k])); }
    return static_cast<double>(error);
}

template <class T, int Order>
using ViscousJet = model::MembraneJet<T, true, Order>;
template <class T, int Order>
using ElasticJet = model::MembraneJet<T, false, Order>;

using Series = test::NaiveSeries<top_order>;

/// Coefficients by Picard's iteration on the printed equations. Elastic places have mu_ratio = 0: the stretches act on
/// nothing there.
std::array<Series, 4> membrane_series(const Place& place) {
    std::array<Series, model::membrane::count> p;
    for (std::size_t k = 0; k < p.size(); ++k) { p[k] = Series(place.p[k]); }
    return test::picard<top_order, 4>(place.theta, place.state,
                                      [&](const Series& theta, const Series* y, Series* rate) {
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
        CHECK(slope[k] == test::relative(static_cast<double>(expected[k].c[1]), 1e-12));
    }
}

/// Local error falls like h^(p+1): two-sided.
template <template <class, int> class Jet>
void check_order(const Place& place) {
    for (int order : {3, 5, 8, 10}) {  // higher ones need more digits: taylor_quad_test
        double h = 6.0;
        // Down to where the halved step's error, 1e-17, is still well above the rounding of long double, 5e-20: larger
        // steps are not asymptotic, since the next term is only h/radius smaller.
        while (!(step_error<Jet>(place, h, order) < 1e-17 * std::pow(2.0, order + 1))) { h *= 0.9; }
        const double coarse = step_error<Jet>(place, h, order);
        const double fine = step_error<Jet>(place, 0.5 * h, order);
        CAPTURE(order);
        CAPTURE(h);
        CHECK(std::abs(std::log2(coarse / fine) - (order + 1)) < 0.3);
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
        check_order<ViscousJet>(place);
        place = random_elastic(random);
        place.touching = false;
        check_order<ElasticJet>(place);
        place = random_spring(random);
        place.touching = false;
        check_order<model::SpringJet>(place);
    }
}

TEST_CASE("the reference orbit at omega = 1.9 closes after one period and shows its contact and extrema") {
    const auto integrator = membranes();
    flow::Request request = reference_request();
    request.observe = flow::observe_all;
    const flow::Result result = test::run(*integrator, paper_defaults, request);
    REQUIRE(result.status == Status::ok);
    // State given to 5e-15, stretched by at most a few over a period; integration error below 1e-14.
    CHECK(test::distance(result.state, request.state, 4) < 1e-13);
    REQUIRE(result.contacts.size() == 1);
    const flow::Contact& contact = result.contacts.front();
    CHECK_FALSE(contact.open_in);
    CHECK_FALSE(contact.open_out);
    // The entry time was given with 12 decimals, the rest with 14; the state's 5e-15 enters divided by the speed 0.1.
    CHECK(std::abs(contact.theta_in / 1.9 - test::at_1_9::entry_tau) < 5e-13 + 1e-13);
    CHECK(std::abs(contact.theta_out / 1.9 - test::at_1_9::exit_tau) < 2e-13);
    CHECK(std::abs(contact.state_in[1] - test::at_1_9::entry_velocity) < 2e-13);
    CHECK(std::abs(contact.state_out[1] - test::at_1_9::exit_velocity) < 2e-13);
    CHECK(contact.state_in[0] == integrator->stop_position(paper_defaults));
    CHECK(contact.state_out[0] == integrator->stop_position(paper_defaults));
    const flow::Observables& seen = result.observables;
    CHECK(std::abs(seen.x_max.value - test::at_1_9::x_max) < 2e-14);
    CHECK(std::abs(seen.x_min.value - test::at_1_9::x_min) < 2e-14);
    CHECK(std::abs(seen.peak_force.value - test::reference_orbits[0].peak_force) < 6e-12);  // 11 decimals given
    CHECK(seen.impact_velocity.value == contact.state_in[1]);
    CHECK(std::abs(seen.contact_time.value - (contact.theta_out - contact.theta_in) / 1.9) < 1e-14);
    CHECK(contact.peak_force == seen.peak_force.value);
    CHECK(seen.theta_x_max > contact.theta_in);
    CHECK(seen.theta_x_max < contact.theta_out);
    CHECK(seen.theta_peak_force > contact.theta_in);
    CHECK(seen.theta_peak_force < seen.theta_x_max);  // damping brings the force forward
    CHECK(seen.runner_up_force == 0.0);
}

TEST_CASE("the error of a period follows the tolerance, neither worse nor far better") {
    // Order -ln(tol)/2 + 2 and steps e^-2 of the radius of convergence: the last term of a step is about tol/e^4 and
    // the error a third of that (Jorba and Zou 2005). Measured: 6e-5 to 1e-3 of the tolerance over this period, down to
    // rounding, 1e-14. Two-sided: a step or order chosen too timidly wastes time, one too bold loses digits.
    double sum_x = 0.0;
    double sum_y = 0.0;
    double sum_xx = 0.0;
    double sum_xy = 0.0;
    int count = 0;
    for (int digits = 4; digits <= 10; ++digits) {
        const double tolerance = std::pow(10.0, -digits);
        CAPTURE(tolerance);
        const auto integrator = membranes(model::ContactLaw::kelvin_voigt, tolerance);
        CHECK(integrator->tolerance() == tolerance);
        const flow::Result result = test::run(*integrator, paper_defaults, reference_request());
        const double error = test::distance(result.state, test::reference_orbits[0].state, 4);
        CHECK(error < 1e-2 * tolerance);
        CHECK(error > 5e-6 * tolerance);
        sum_x += std::log10(tolerance);
        sum_y += std::log10(error);
        sum_xx += std::pow(std::log10(tolerance), 2);
        sum_xy += std::log10(tolerance) * std::log10(error);
        ++count;
    }
    const double slope = (count * sum_xy - sum_x * sum_y) / (count * sum_xx - sum_x * sum_x);
    CAPTURE(slope);
    CHECK(slope > 0.8);
    CHECK(slope < 1.2);
    CHECK(flow::taylor_order(1e-13) == 17);  // ceil(14.97 + 2)
    CHECK(flow::taylor_order(1e-2) == 5);
    CHECK(flow::taylor_order(0.5) == 4);
}

TEST_CASE("a linear oscillator follows its closed form, free, held by the stop, forwards and back") {
    // x'' + c x' + k1 x = F cos(theta): particular solution plus a decaying rotation. Held: stiffness k1 + k, damping
    // c + delta, the stop's rest position as a constant force.
    test::Random random(19);
    for (int trial = 0; trial < 20; ++trial) {
        CAPTURE(trial);
        Place place = random_spring(random);
        place.p[model::spring::cubic] = 0.0;
        place.p[model::spring::stop_stiffness] = random.uniform(5.0, 50.0);
        const bool held = trial % 2 == 1;
        // The last ones take a single step.
        const double duration = random.uniform(0.1, 6.0) * (trial % 4 < 2 ? 1.0 : -1.0) * (trial < 16 ? 1.0 : 1e-3);
        const auto& p = place.p;
        const Real c = p[0] + (held ? p[6] : 0.0);
        const Real k = p[1] + (held ? p[5] : 0.0);
        const Real offset = held ? p[5] * static_cast<Real>(p[4]) / k : 0.0L;
        const Real w = p[7];
        const Real stiff = k - w * w;
        const Real unit = p[3] / (stiff * stiff + c * c * w * w);
        const auto particular = [&](Real theta) {
            return std::array<Real, 2>{offset + unit * (stiff * std::cos(theta) + c * w * std::sin(theta)),
                                       unit * w * (-stiff * std::sin(theta) + c * w * std::cos(theta))};
        };
        const Real decay = 0.5L * c;
        const Real turn = std::sqrt(k - decay * decay);
        REQUIRE(k > decay * decay);
        const auto first = particular(place.theta);
        const Real x0 = place.state[0] - first[0];
        const Real v0 = place.state[1] - first[1];
        const Real b = (v0 + decay * x0) / turn;
        const Real time = duration / w;
        const Real fall = std::exp(-decay * time);
        const Real x = fall * (x0 * std::cos(turn * time) + b * std::sin(turn * time));
        const Real v =
            fall * ((b * turn - decay * x0) * std::cos(turn * time) - (x0 * turn + decay * b) * std::sin(turn * time));
        const auto last = particular(place.theta + static_cast<Real>(duration));
        flow::Request request;
        request.state = place.state;
        request.theta = place.theta;
        request.duration = duration;
        request.stop = held ? flow::StopMode::held : flow::StopMode::off;
        const auto integrator = test::spring();
        const flow::Result result = test::run(*integrator, place.p, request);
        REQUIRE(result.status == Status::ok);
        // 1e-13 of the motion's size, which backwards in time grows by 1/fall.
        const double size = static_cast<double>(1.0L + std::abs(offset) + fall * (std::abs(x0) + std::abs(b) * turn));
        CHECK(std::abs(result.state[0] - static_cast<double>(x + last[0])) < 1e-13 * size);
        CHECK(std::abs(result.state[1] - static_cast<double>(v + last[1])) < 1e-13 * size * static_cast<double>(turn));
        if (held) {
            const double gap = result.state[0] - integrator->stop_position(place.p);
            CHECK(result.divided_gap.value == test::relative(gap / duration, 1e-11));
            const double force = p[5] * gap + p[6] * result.state[1];
            CHECK(result.divided_force.value == test::relative(force / (p[5] * std::abs(duration) + p[6]), 1e-10));
        }
    }
}

TEST_CASE("there and back again, with the stop off and held") {
    test::Random random(23);
    const auto integrator = membranes();
    for (int trial = 0; trial < 20; ++trial) {
        CAPTURE(trial);
        const Place place = random_membranes(random);
        flow::Request request;
        request.state = place.state;
        request.theta = place.theta;
        // Back in time the dampers feed energy: short ways for the stiff stop.
        request.stop = trial % 2 == 0 ? flow::StopMode::off : flow::StopMode::held;
        request.duration = trial % 2 == 0 ? random.uniform(0.5, 3.0) : random.uniform(0.1, 0.5);
        const flow::Result there = test::run(*integrator, place.p, request);
        REQUIRE(there.status == Status::ok);
        request.theta += request.duration;
        request.duration = -request.duration;
        request.state = there.state;
        const flow::Result back = test::run(*integrator, place.p, request);
        REQUIRE(back.status == Status::ok);
        CHECK(test::distance(there.state, place.state, 4) > 1e-3);  // it did move
        CHECK(test::distance(back.state, place.state, 4) < 1e-12);
    }
}
