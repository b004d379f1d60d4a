// Contacts of the step-by-step backends: closed forms, grazing, the no-tension law, held and free runs, stiff stops,
// and what is returned or thrown when a run cannot be done.

#include "model/membrane/membrane.hpp"
#include "model/spring/spring.hpp"
#include "sundials_cases.hpp"

#include <doctest/doctest.h>

#include <array>
#include <cmath>
#include <limits>
#include <numbers>
#include <stdexcept>

using namespace percuss;
using flow::Result;
using flow::Status;
using flow::StopMode;
using test::Case;
using test::two_pi;

namespace {

struct Backend {
    const char* name;
    std::unique_ptr<flow::Integrator> (*make)(std::shared_ptr<const flow::RightHandSide>, double);
    double error;  ///< at tolerance 1e-12, for motions of size one
};
constexpr std::array<Backend, 2> backends = {{{"erk", flow::make_erk, 1e-12}, {"cvode", flow::make_cvode, 1e-9}}};

constexpr double k = 40.0;
constexpr double delta = 3.0;
constexpr double start_speed = 0.8;
constexpr double gap = 0.3;

/// A free mass that flies into the stop: no spring, no drive; omega = 2 makes theta = 2 tau.
Case flight() {
    Case c{{0.0, 0.0, 0.0, 0.0, gap, k, delta, 2.0}, {}};
    c.request.state = {0.0, start_speed};
    c.request.duration = 3.0;
    c.request.observe = flow::observe_all;
    return c;
}

/// In contact y'' + delta y' + k y = 0 from y = 0, y' = v.
struct Bounce {
    double damped = std::sqrt(k - 0.25 * delta * delta);
    double decay = 0.5 * delta;
    [[nodiscard]] double y(double t) const {
        return start_speed * std::exp(-decay * t) * std::sin(damped * t) / damped;
    }
    [[nodiscard]] double v(double t) const {
        return start_speed * std::exp(-decay * t) * (std::cos(damped * t) - decay / damped * std::sin(damped * t));
    }
    [[nodiscard]] double force(double t) const { return k * y(t) + delta * v(t); }
    [[nodiscard]] double time_of_peak() const {
        return std::atan(damped / (decay + delta * k / (k - delta * delta))) / damped;
    }
    [[nodiscard]] double time_of_no_force() const {
        return (std::numbers::pi + std::atan(damped / (decay - k / delta))) / damped;
    }
};

}  // namespace

TEST_CASE("a bounce off the stop: closed form, both laws") {
    const Bounce bounce;
    for (const Backend& backend : backends) {
        for (const auto law : {model::ContactLaw::kelvin_voigt, model::ContactLaw::no_tension}) {
            CAPTURE(backend.name);
            const bool pulls = law == model::ContactLaw::kelvin_voigt;
            CAPTURE(pulls);
            const auto integrator = backend.make(test::spring(law), 1e-12);
            const Result result = test::run(*integrator, flight());
            REQUIRE(result.status == Status::ok);
            REQUIRE(result.contacts.size() == 1);
            const double lasts = pulls ? std::numbers::pi / bounce.damped : bounce.time_of_no_force();
            const double enters = gap / start_speed;
            const flow::Contact& contact = result.contacts.front();
            const double error = 30.0 * backend.error;
            CHECK(std::abs(contact.theta_in - 2.0 * enters) < error);
            CHECK(std::abs(contact.theta_out - 2.0 * (enters + lasts)) < error);
            CHECK(std::abs(contact.state_out[0] - gap - (pulls ? 0.0 : bounce.y(lasts))) < error);
            CHECK(std::abs(contact.state_out[1] - bounce.v(lasts)) < error);
            CHECK(std::abs(contact.peak_force - bounce.force(bounce.time_of_peak())) < error);
            const flow::Observables& seen = result.observables;
            CHECK(std::abs(seen.peak_force.value - contact.peak_force) == 0.0);
            CHECK(std::abs(seen.theta_peak_force - 2.0 * (enters + bounce.time_of_peak())) < 1e-4);
            CHECK(std::abs(seen.contact_time.value - lasts) < error);
            CHECK(std::abs(seen.impulse.value - (start_speed - bounce.v(lasts))) < error);
            CHECK(std::abs(seen.stop_work.value -
                           0.5 * (start_speed * start_speed - bounce.v(lasts) * bounce.v(lasts))) < error);
            CHECK(std::abs(seen.impact_velocity.value - start_speed) < error);
            CHECK(std::abs(seen.peak_acceleration.value - contact.peak_force) < error);
            const double leaves = 1.5 - enters - lasts;
            CHECK(std::abs(result.state[0] - (contact.state_out[0] + bounce.v(lasts) * leaves)) < error);
            CHECK(integrator->info().releases_on_force == !pulls);
        }
    }
}

TEST_CASE(
    "on a free mass the peak acceleration is the peak force, also when it is reached in the first step of contact") {
    for (const Backend& backend : backends) {
        CAPTURE(backend.name);
        const auto integrator = backend.make(test::spring(), 1e-8);
        for (const double damping : {0.0, 1.0, 3.0, 5.0, 5.5, 5.8, 6.0, 7.0}) {
            CAPTURE(damping);
            Case c = flight();
            c.parameters[model::spring::stop_damping] = damping;
            const flow::Observables seen = test::run(*integrator, c).observables;
            CHECK(seen.peak_acceleration.value == doctest::Approx(seen.peak_force.value).epsilon(1e-12));
        }
    }
}

TEST_CASE("a contact far shallower than the tolerance is one contact") {
    Case c{test::paper_defaults, {}};
    c.request.theta = 3.3;
    c.request.duration = 3.0;
    c.request.starts_in_contact = true;
    for (const Backend& backend : backends) {
        CAPTURE(backend.name);
        const auto integrator = backend.make(test::membranes(), 1e-12);
        for (const double speed : {1e-3, 1e-6, 1e-9, 1e-12}) {
            CAPTURE(speed);
            c.request.state = {0.5, speed, 1.18, 1.19};
            const Result result = test::run(*integrator, c);
            CHECK(result.status == Status::ok);
            CHECK(result.contacts.size() == 1);
        }
    }
}

TEST_CASE("an overshoot a thousand times shorter than a step is found, and none is invented") {
    // Steady oscillation of amplitude A = 1 exactly; the mass is beyond 1 - 1e-9 for 9e-5 of a cycle's 6.3.
    const double w = 0.9;
    const double c = 0.2;
    const double stiff = 1.0 - w * w;
    const double force = std::hypot(stiff, c * w);
    Case graze{{c, 1.0, 0.0, force, 1.0, 10.0, 0.5, w}, {}};
    graze.request.state = {stiff / force, w * c * w / force};
    graze.request.duration = two_pi;
    for (const Backend& backend : backends) {
        CAPTURE(backend.name);
        const auto integrator = backend.make(test::spring(), 1e-13);
        graze.parameters[model::spring::gap] = 1.0 - 1e-9;
        const Result touching = test::run(*integrator, graze);
        REQUIRE(touching.contacts.size() == 1);
        const double speed = w * std::sqrt(2e-9);
        CHECK(touching.contacts.front().state_in[1] == doctest::Approx(speed).epsilon(0.1));
        CHECK(touching.contacts.front().theta_out - touching.contacts.front().theta_in ==
              doctest::Approx(2.0 * std::sqrt(2e-9)).epsilon(0.1));
        graze.parameters[model::spring::gap] = 1.0 + 1e-9;
        CHECK(test::run(*integrator, graze).contacts.empty());
    }
}

TEST_CASE("no tension: force never pulls, contact may be renewed inside the zone") {
    Case c{{0.1, 1.0, 0.2, 1.0, 0.05, 3.0, 10.0, 0.5}, {}};
    c.request.duration = 3.0 * two_pi;
    c.request.observe = flow::observe_force;
    for (const Backend& backend : backends) {
        CAPTURE(backend.name);
        const auto integrator = backend.make(test::spring(model::ContactLaw::no_tension), 1e-12);
        const Result result = test::run(*integrator, c);
        REQUIRE(result.status == Status::ok);
        REQUIRE(result.contacts.size() == 7);
        int renewed = 0;
        for (const flow::Contact& contact : result.contacts) {
            const auto force = [&](const flow::State& y) { return 3.0 * (y[0] - 0.05) + 10.0 * y[1]; };
            if (contact.state_in[0] > 0.05) {
                ++renewed;
                CHECK(std::abs(force(contact.state_in)) < 1e-11);
            } else {
                CHECK(contact.state_in[0] == 0.05);
                CHECK(contact.state_in[1] > 0.0);
            }
            if (!contact.open_out) {
                CHECK(std::abs(force(contact.state_out)) < 1e-11);
                CHECK(contact.state_out[0] > 0.05);
            }
        }
        CHECK(renewed == 3);
    }
    // A start inside the zone that leaves faster than the spring pushes is no contact; one that does not is.
    Case inside = flight();
    inside.request.state = {gap + 0.01, -0.5};  // force 40 * 0.01 - 3 * 0.5 < 0
    const auto integrator = flow::make_erk(test::spring(model::ContactLaw::no_tension), 1e-12);
    const Result slack = test::run(*integrator, inside);
    CHECK(slack.contacts.empty());
    CHECK(slack.state[1] == -0.5);
    inside.request.state[1] = -0.05;
    const Result pushed = test::run(*integrator, inside);
    REQUIRE(pushed.contacts.size() == 1);
    CHECK(pushed.contacts.front().open_in);
    CHECK(pushed.state[1] < -0.05);
    // Without damping the force ends on the surface, as in the other law.
    Case elastic = flight();
    elastic.parameters[model::spring::stop_damping] = 0.0;
    const Result one = test::run(*flow::make_erk(test::spring(model::ContactLaw::no_tension), 1e-12), elastic);
    const Result other = test::run(*flow::make_erk(test::spring(), 1e-12), elastic);
    REQUIRE(one.contacts.size() == 1);
    CHECK(one.contacts.front().state_out[0] == doctest::Approx(gap).epsilon(1e-14));
    CHECK(one.state[0] == doctest::Approx(other.state[0]).epsilon(1e-12));
    CHECK(one.state[1] == doctest::Approx(-start_speed).epsilon(1e-12));
}

TEST_CASE("stop modes: off ignores the stop, held keeps it, both run backwards") {
    for (const Backend& backend : backends) {
        CAPTURE(backend.name);
        const auto integrator = backend.make(test::membranes(), 1e-12);
        Case c{test::paper_defaults, {}};
        c.request.state = test::paper_orbit;
        c.request.duration = two_pi;
        c.request.observe = flow::observe_extrema | flow::observe_force;
        c.request.stop = StopMode::off;
        const Result free = test::run(*integrator, c);
        CHECK(free.contacts.empty());
        CHECK(free.observables.x_max.value > 0.505);
        Case back = c;
        back.request.state = free.state;
        back.request.theta = two_pi;
        back.request.duration = -two_pi;
        const Result returned = test::run(*integrator, back);
        REQUIRE(returned.status == Status::ok);
        // Backwards the losses are gains: errors grow by the reciprocal multipliers.
        for (std::size_t i = 0; i < 4; ++i) {
            CHECK(std::abs(returned.state[i] - test::paper_orbit[i]) < 10.0 * backend.error);
        }
        CHECK(returned.observables.x_max.value == doctest::Approx(free.observables.x_max.value).epsilon(1e-9));

        // Inside a contact held and hybrid are the same motion.
        Case contact = c;
        contact.request.state = {0.5, 0.103, 1.18, 1.19};
        contact.request.theta = 3.3;
        contact.request.duration = 0.08;
        contact.request.stop = StopMode::hybrid;
        contact.request.starts_in_contact = true;
        const Result hybrid = test::run(*integrator, contact);
        contact.request.stop = StopMode::held;
        const Result held = test::run(*integrator, contact);
        REQUIRE(hybrid.contacts.size() == 1);
        REQUIRE(held.contacts.size() == 1);
        CHECK(hybrid.contacts.front().open_out);
        for (std::size_t i = 0; i < 4; ++i) { CHECK(std::abs(held.state[i] - hybrid.state[i]) < 10.0 * backend.error); }
        CHECK(held.observables.impulse.value == doctest::Approx(hybrid.observables.impulse.value).epsilon(1e-8));
        CHECK(held.observables.contact_time.value == doctest::Approx(0.08 / 1.9).epsilon(1e-14));
        // Held past the release the stop pulls the mass back; hybrid lets it go.
        contact.request.duration = 0.4;
        CHECK(test::run(*integrator, contact).contacts.size() == 1);
        contact.request.stop = StopMode::hybrid;
        const Result released = test::run(*integrator, contact);
        REQUIRE(released.contacts.size() == 1);
        CHECK_FALSE(released.contacts.front().open_out);
    }
}

TEST_CASE("divided gap and force of held runs are smooth through duration zero") {
    const double w = test::paper_defaults[model::membrane::omega];
    const double v = 1e-3;
    Case c{test::paper_defaults, {}};
    c.request.state = {0.5, v, 1.18, 1.19};
    c.request.theta = 3.3;
    c.request.stop = StopMode::held;
    std::array<flow::Direction, 1> directions{};
    directions[0].state[1] = 1.0;
    c.request.directions = directions;
    flow::State rate{};
    test::membranes()->rate(c.parameters, 3.3, c.request.state, true, rate);
    const double acceleration = rate[1] * w;
    for (const Backend& backend : backends) {
        CAPTURE(backend.name);
        const auto integrator = backend.make(test::membranes(), 1e-12);
        for (const double duration : {-1e-6, -1e-9, 0.0, 1e-12, 1e-9, 1e-6}) {
            CAPTURE(duration);
            c.request.duration = duration;
            const Result result = test::run(*integrator, c);
            REQUIRE(result.status == Status::ok);
            // x'(0) t + x''(0) t^2/2 over t; the next term is x''' t^2/6, x''' about k v: 1e-12 here.
            const double expected = v / w + 0.5 * acceleration * duration / (w * w);
            CHECK(std::abs(result.divided_gap.value - expected) < 1e-9 * v + 1e-12);
            CHECK(result.divided_gap.d[0] == doctest::Approx(1.0 / w).epsilon(1e-5));
            CHECK(result.divided_force.value == doctest::Approx(v).epsilon(2e-2));
            if (duration == 0.0) {
                CHECK(result.divided_force.value == v);
                CHECK(result.state == c.request.state);
            }
        }
    }
}

TEST_CASE("a stiff overdamped stop: both methods agree and the implicit one needs fewer evaluations") {
    Case c{test::paper_defaults, {}};
    c.parameters[model::membrane::stiffness] = 1e6;
    c.parameters[model::membrane::damping] = 2e4;
    c.request.state = test::paper_orbit;
    c.request.duration = two_pi;
    c.request.observe = flow::observe_force | flow::observe_extrema;
    const Result explicit_run = test::run(*flow::make_erk(test::membranes(), 1e-11), c);
    const Result implicit_run = test::run(*flow::make_cvode(test::membranes(), 1e-12), c);
    REQUIRE(explicit_run.status == Status::ok);
    REQUIRE(implicit_run.status == Status::ok);
    REQUIRE(explicit_run.contacts.size() == implicit_run.contacts.size());
    REQUIRE_FALSE(explicit_run.contacts.empty());
    for (std::size_t i = 0; i < 4; ++i) { CHECK(std::abs(explicit_run.state[i] - implicit_run.state[i]) < 1e-8); }
    CHECK(implicit_run.observables.peak_force.value ==
          doctest::Approx(explicit_run.observables.peak_force.value).epsilon(1e-7));
    // Damping ratio 10. Measured: 1438 against 25782; with a wrong Jacobian Newton's method needs 4688.
    CHECK(implicit_run.rhs_evaluations < explicit_run.rhs_evaluations / 10);
}

TEST_CASE("what cannot be done ends as a status") {
    for (const Backend& backend : backends) {
        CAPTURE(backend.name);
        const auto integrator = backend.make(test::spring(), 1e-10);
        Case c = flight();
        c.request.max_steps = 5;
        CHECK(test::run(*integrator, c).status == Status::too_many_steps);
        c.request.max_steps = 100000;
        c.request.max_events = 1;
        CHECK(test::run(*integrator, c).status == Status::too_many_events);
        c.request.max_events = 2;
        CHECK(test::run(*integrator, c).status == Status::ok);

        Case escape{{0.0, -1.0, -1.0, 0.0, 1e9, 1.0, 0.0, 1.0}, {}};  // x'' = x + x^3 blows up at a finite time
        escape.request.state = {2.0, 0.0};
        escape.request.duration = 50.0;
        CHECK(test::run(*integrator, escape).status == Status::diverged);
        escape.request.state[1] = std::numeric_limits<double>::quiet_NaN();
        CHECK(test::run(*integrator, escape).status == Status::diverged);
    }
}

TEST_CASE("misuse is an exception") {
    for (const Backend& backend : backends) {
        CAPTURE(backend.name);
        for (const double bad : {0.0, -1e-9, 9e-17, 1.1e-2, std::nan("")}) {
            CHECK_THROWS_AS(backend.make(test::spring(), bad), std::invalid_argument);
        }
        CHECK_THROWS_AS(backend.make(nullptr, 1e-9), std::invalid_argument);
        const auto integrator = backend.make(test::spring(), 1e-9);
        Case c = flight();
        c.request.duration = -1.0;
        CHECK_THROWS_AS(test::run(*integrator, c), std::invalid_argument);
        c.request.duration = std::nan("");
        CHECK_THROWS_AS(test::run(*integrator, c), std::invalid_argument);
        c = flight();
        std::array<flow::Direction, flow::max_lanes + 1> directions{};
        c.request.directions = directions;
        CHECK_THROWS_AS(test::run(*integrator, c), std::invalid_argument);
        c = flight();
        c.parameters[model::spring::omega] = 0.0;
        CHECK_THROWS_AS(test::run(*integrator, c), std::invalid_argument);
    }
}
