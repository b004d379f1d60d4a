// The point-by-point equations of motion: exact derivatives, power balance, symmetry, rest and resonance.

#include "model/membrane/membrane.hpp"
#include "model/spring/spring.hpp"
#include "sundials_cases.hpp"

#include <doctest/doctest.h>

#include <array>
#include <cmath>

using namespace percuss;
using flow::Direction;
using flow::ParameterVector;
using flow::State;
using test::at;

namespace {

constexpr State somewhere = {0.47, 0.21, 1.17, 1.21};
constexpr ParameterVector spring_parameters = {0.1, 1.3, 0.4, 0.7, 0.2, 40.0, 1.5, 0.9};

struct Point {
    std::shared_ptr<const flow::RightHandSide> rhs;
    ParameterVector p{};
    double theta = 0.8;
    State state = somewhere;
};

Point moved(Point point, const Direction& direction, double amount) {
    for (std::size_t i = 0; i < point.state.size(); ++i) { point.state[i] += amount * direction.state[i]; }
    for (std::size_t i = 0; i < point.p.size(); ++i) { point.p[i] += amount * direction.parameter[i]; }
    point.theta += amount * direction.phase;
    return point;
}

/// Fourth-order central difference of f along a direction: truncation (1e-3)^4, rounding 1e-16/1e-3.
template <class Function>
double difference(const Point& point, const Direction& direction, double h, Function f) {
    const auto value = [&](double amount) { return f(moved(point, direction, amount)); };
    return (8.0 * (value(h) - value(-h)) - (value(2.0 * h) - value(-2.0 * h))) / (12.0 * h);
}

void check_derivatives(const Point& point) {
    const auto directions = test::all_directions(point.rhs->info());
    for (std::size_t j = 0; j < directions.size(); ++j) {
        const Direction& direction = directions[j];
        CAPTURE(j);
        const double h =
            j + 1 == directions.size() ? 1e-3 : 1e-3 * test::size_along({point.p, {point.state}}, direction);
        for (const bool touching : {false, true}) {
            State exact{};
            point.rhs->rate_derivative(point.p, point.theta, point.state, touching, direction, exact);
            for (int i = 0; i < point.rhs->states(); ++i) {
                const double numeric = difference(point, direction, h, [&](const Point& q) {
                    State out{};
                    q.rhs->rate(q.p, q.theta, q.state, touching, out);
                    return out[at(i)];
                });
                CHECK(exact[at(i)] == doctest::Approx(numeric).epsilon(1e-8));
            }
        }
        flow::Powers power;
        flow::Powers power_d;
        point.rhs->powers(point.p, point.theta, point.state, {&direction, 1}, power, &power_d);
        const auto powers = [](const Point& q) {
            flow::Powers out;
            q.rhs->powers(q.p, q.theta, q.state, {}, out, nullptr);
            return out;
        };
        CHECK(power_d.drive == doctest::Approx(difference(point, direction, h, [&](const Point& q) {
                                   return powers(q).drive;
                               })).epsilon(1e-8));
        CHECK(power_d.loss == doctest::Approx(difference(point, direction, h, [&](const Point& q) {
                                  return powers(q).loss;
                              })).epsilon(1e-8));
        const auto peaks = point.rhs->info().peaks;
        for (int which = 0; which < static_cast<int>(peaks.size()); ++which) {
            for (int side = 0; side < peaks[static_cast<std::size_t>(which)].parts; ++side) {
                double exact = 0.0;
                static_cast<void>(
                    point.rhs->peak(which, side, point.p, point.theta, point.state, {&direction, 1}, &exact));
                const double numeric = difference(point, direction, h, [&](const Point& q) {
                    return q.rhs->peak(which, side, q.p, q.theta, q.state, {}, nullptr);
                });
                CHECK(exact == doctest::Approx(numeric).epsilon(1e-8));
            }
        }
    }
}

}  // namespace

TEST_CASE("derivatives of the equations of motion agree with differences") {
    check_derivatives({test::membranes(), test::paper_defaults});
    check_derivatives({test::spring(), spring_parameters});
}

TEST_CASE("eight directions at once give what one at a time gives") {
    const auto rhs = test::membranes();
    const auto directions = test::all_directions(rhs->info());
    State rate{};
    std::array<State, 8> together{};
    rhs->rates(test::paper_defaults, 0.8, somewhere, true, {directions.data() + 3, 8}, rate, together.data());
    for (std::size_t j = 0; j < together.size(); ++j) {
        State alone{};
        rhs->rate_derivative(test::paper_defaults, 0.8, somewhere, true, directions[j + 3], alone);
        for (int i = 0; i < rhs->states(); ++i) {
            CHECK(together[j][at(i)] == doctest::Approx(alone[at(i)]).epsilon(1e-14));
        }
    }
}

TEST_CASE("power balance: kinetic energy changes by drive, loss and the stored energy's rate") {
    // The elastic and Maxwell springs store energy; its rate at a point is minus the work of all forces but drive and
    // damping. Taking away drive and viscosity leaves that work alone, so the three together must close.
    const auto rhs = test::membranes();
    const ParameterVector full = test::paper_defaults;
    ParameterVector passive = full;
    passive[model::membrane::voltage] = 0.0;
    passive[model::membrane::delta_a] = 0.0;
    State with_all{};
    State springs_only{};
    rhs->rate(full, 0.8, somewhere, false, with_all);
    rhs->rate(passive, 0.8, somewhere, false, springs_only);
    flow::Powers power;
    rhs->powers(full, 0.8, somewhere, {}, power, nullptr);
    flow::Powers maxwell_loss;
    rhs->powers(passive, 0.8, somewhere, {}, maxwell_loss, nullptr);
    const double difference = full[model::membrane::omega] * (with_all[1] - springs_only[1]) * somewhere[1];
    CHECK(difference == doctest::Approx(power.drive - (power.loss - maxwell_loss.loss)).epsilon(1e-13));
    CHECK(maxwell_loss.loss > 0.0);
}

TEST_CASE("fields and currents of both sides") {
    const auto rhs = test::membranes();
    const ParameterVector p = test::paper_defaults;
    // phi and s of the paper, by hand; the current is d(s phi)/dtau along the motion.
    const auto charge = [&](int side, double theta, const State& y) {
        const double u = side == 0 ? y[0] : y[0] - 0.8;
        return (1.0 + u * u) * 0.2 * (side == 0 ? 1.0 - std::cos(theta) : 1.0 + std::cos(theta));
    };
    Direction along;
    along.phase = 1.0;
    rhs->rate(p, 0.8, somewhere, false, along.state);
    for (int side = 0; side < 2; ++side) {
        CAPTURE(side);
        const double u = side == 0 ? somewhere[0] : somewhere[0] - 0.8;
        const double field = charge(side, 0.8, somewhere) * 1.1 / std::sqrt(1.0 + u * u);
        CHECK(rhs->peak(model::membrane::field, side, p, 0.8, somewhere, {}, nullptr) == doctest::Approx(field));
        const double rate =
            difference({rhs, p}, along, 1e-3, [&](const Point& q) { return charge(side, q.theta, q.state); });
        CHECK(rhs->peak(model::membrane::current, side, p, 0.8, somewhere, {}, nullptr) ==
              doctest::Approx(1.9 * rate).epsilon(1e-9));
    }
}

TEST_CASE("without the stop the motion is the same reflected and half a cycle later") {
    const auto rhs = test::membranes();
    const ParameterVector p = test::paper_defaults;
    const double centre = rhs->centre(p);
    const State mirrored = {2.0 * centre - somewhere[0], -somewhere[1], somewhere[3], somewhere[2]};
    State rate{};
    State other{};
    rhs->rate(p, 0.8, somewhere, false, rate);
    rhs->rate(p, 0.8 + std::numbers::pi, mirrored, false, other);
    CHECK(other[0] == doctest::Approx(-rate[0]).epsilon(1e-14));
    CHECK(other[1] == doctest::Approx(-rate[1]).epsilon(1e-13));
    CHECK(other[2] == doctest::Approx(rate[3]).epsilon(1e-13));
    CHECK(other[3] == doctest::Approx(rate[2]).epsilon(1e-13));
    CHECK(rhs->info().mirror[2] == 3);
}

TEST_CASE("rest is an equilibrium and the resonance is its frequency") {
    const auto rhs = test::membranes();
    ParameterVector p = test::paper_defaults;
    p[model::membrane::voltage] = 0.0;
    p[model::membrane::layers] = 2.0;
    const State rest = rhs->rest_state(p);
    State rate{};
    rhs->rate(p, 0.0, rest, false, rate);
    for (const double r : rate) { CHECK(std::abs(r) < 1e-15); }
    Direction along;
    along.state[0] = 1.0;
    State stiffness{};
    rhs->rate_derivative(p, 0.0, rest, false, along, stiffness);
    const double squared = -stiffness[1] * p[model::membrane::omega];
    CHECK(rhs->linear_resonance(p) == doctest::Approx(std::sqrt(squared)).epsilon(1e-13));
    // Each membrane's -u phi^2 takes phi^2, on average 3/8 phi_pp^2, off its stiffness.
    p[model::membrane::voltage] = 0.4;
    CHECK(rhs->linear_resonance(p) == doctest::Approx(std::sqrt(squared - 2.0 * 2.0 * 0.375 * 0.16)).epsilon(1e-13));
    // Beyond the pull-in voltage a frequency is still needed.
    p[model::membrane::voltage] = 5.0;
    CHECK(rhs->linear_resonance(p) == doctest::Approx(std::sqrt(squared)).epsilon(1e-13));

    ParameterVector s{};
    s[model::spring::stiffness] = 4.0;
    CHECK(test::spring()->linear_resonance(s) == 2.0);
    s[model::spring::stiffness] = 0.0;
    CHECK(test::spring()->linear_resonance(s) == 1.0);
    s[model::spring::cubic] = 2.0;
    s[model::spring::force] = 2.0;
    CHECK(test::spring()->linear_resonance(s) == doctest::Approx(std::sqrt(1.5)));
}

TEST_CASE("without Maxwell branches two states remain and move alike") {
    ParameterVector p = test::paper_defaults;
    p[model::membrane::mu_ratio] = 0.0;
    p[model::membrane::delta_b] = std::numeric_limits<double>::infinity();
    const auto elastic = kernels::make_plain_system(model::membrane::elastic, model::ContactLaw::kelvin_voigt);
    REQUIRE(elastic->states() == 2);
    State full{};
    State reduced{};
    test::membranes()->rate(p, 0.8, somewhere, true, full);
    elastic->rate(p, 0.8, {somewhere[0], somewhere[1]}, true, reduced);
    CHECK(reduced[0] == full[0]);
    CHECK(reduced[1] == doctest::Approx(full[1]).epsilon(1e-14));
    CHECK(elastic->meaningful({0.4, 0.0}));
    CHECK_FALSE(elastic->meaningful({std::nan(""), 0.0}));
}

TEST_CASE("the model's range") {
    CHECK(test::membranes()->meaningful(somewhere));
    CHECK_FALSE(test::membranes()->meaningful({0.4, 0.0, -0.1, 1.2}));
    CHECK_FALSE(test::membranes()->meaningful({0.4, std::nan(""), 1.2, 1.2}));
    CHECK_FALSE(test::spring()->meaningful({1e13, 0.0}));
}
