// Contact events of the Taylor integrator: where they are, that none is missed and none invented.

#include "engine_cases.hpp"
#include "model/membrane/membrane.hpp"
#include "model/spring/spring.hpp"
#include "orbit/orbit.hpp"
#include "piecewise_linear.hpp"
#include "relative.hpp"

#include <doctest/doctest.h>

#include <cmath>
#include <vector>

using namespace percuss;
using flow::ParameterVector;
using flow::Status;
using model::ContactLaw;
using test::at;
using test::membranes;
using test::paper_defaults;
using test::two_pi;

namespace {

/// Largest derivative of the end state with respect to the start state.
double stretching(const flow::Result& result) {
    double largest = 1.0;
    for (const flow::Lanes& row : result.state_d) {
        for (double d : row) { largest = std::max(largest, std::abs(d)); }
    }
    return largest;
}

/// The linear oscillator x'' + c x' + x = F cos(w tau) moving with its steady amplitude.
struct Steady {
    ParameterVector p{};
    double amplitude = 0.0;
    double lag = 0.0;  ///< x = amplitude cos(theta - lag)
    [[nodiscard]] flow::State state(double theta) const {
        const double w = p[model::spring::omega];
        return {amplitude * std::cos(theta - lag), -w * amplitude * std::sin(theta - lag)};
    }
};
Steady steady(double c, double w, double force) {
    Steady s;
    s.p = {c, 1.0, 0.0, force, 1.0, 1e4, 2.0, w};
    s.amplitude = force / std::hypot(1.0 - w * w, c * w);
    s.lag = std::atan2(c * w, 1.0 - w * w);
    return s;
}

}  // namespace

TEST_CASE("a linear oscillator with a stop: every contact where the exact solution has it") {
    test::Random random(29);
    std::size_t contacts = 0;
    std::size_t reloads = 0;
    for (int trial = 0; trial < 130; ++trial) {
        CAPTURE(trial);
        const ContactLaw law = trial % 2 == 0 ? ContactLaw::kelvin_voigt : ContactLaw::no_tension;
        ParameterVector p = {random.uniform(0.0, 0.3),
                             1.0,
                             0.0,
                             random.uniform(0.3, 1.0),
                             random.uniform(0.1, 0.6),
                             random.log_uniform(20.0, 5000.0),
                             random.log_uniform(0.05, 20.0),
                             random.uniform(0.5, 1.5)};
        if (trial % 5 == 0) { p[model::spring::stop_damping] = 0.0; }
        flow::Request request;
        // From trial 115 on: soft, strongly damped stops left and met again inside, by the no-tension law.
        const bool deep = trial >= 115;
        if (deep) {
            p[model::spring::force] = random.uniform(2.0, 4.0);
            p[model::spring::stop_stiffness] = random.uniform(0.5, 2.0);
            p[model::spring::stop_damping] = random.uniform(5.0, 20.0);
        }
        request.state = {random.uniform(-0.5, 0.0), random.uniform(-1.0, 1.0)};
        if (trial % 7 == 0) { request.state[0] = p[model::spring::gap] + random.uniform(0.0, 0.05); }
        request.theta = random.uniform(-3.0, 3.0);
        request.duration = 2.0 * two_pi;
        if (deep) {
            request.state = {p[model::spring::gap] + 0.3, -0.5};
            request.theta = random.uniform(-0.5, 0.5);
        }
        request.observe = flow::observe_all;
        std::vector<flow::Direction> directions(2);
        directions[0].state[0] = 1.0;
        directions[1].state[1] = 1.0;
        request.directions = directions;
        const auto integrator = test::spring(law);
        const flow::Result result = test::run(*integrator, p, request);
        REQUIRE(result.status == Status::ok);
        test::PiecewiseLinear exact(p, law);
        exact.run(request.state, request.theta, request.duration);
        // Rounding, 1e-15 of motions of size 1, is stretched like a perturbation of the start.
        const double error = 1e-14 * stretching(result) + 1e-14;
        CAPTURE(error);
        REQUIRE(result.contacts.size() == exact.contacts().size());
        CHECK(std::abs(result.state[0] - static_cast<double>(exact.x())) < error);
        CHECK(std::abs(result.state[1] - static_cast<double>(exact.v())) < error);
        for (std::size_t i = 0; i < result.contacts.size(); ++i) {
            CAPTURE(i);
            const flow::Contact& found = result.contacts[i];
            const auto& wanted = exact.contacts()[i];
            CHECK(found.open_in == wanted.open_in);
            CHECK(found.open_out == wanted.open_out);
            // A time of crossing is the displacement's error over the speed; the speed's error has k times the time's.
            const double slowest = std::min(std::abs(found.state_in[1]), std::abs(found.state_out[1]));
            const double blur = error * (1.0 + 1.0 / slowest);
            CHECK(std::abs(found.theta_in - static_cast<double>(wanted.theta_in)) < 10.0 * blur);
            CHECK(std::abs(found.theta_out - static_cast<double>(wanted.theta_out)) < 10.0 * blur);
            CHECK(std::abs(found.state_in[1] - static_cast<double>(wanted.v_in)) < 10.0 * blur);
            CHECK(std::abs(found.state_out[1] - static_cast<double>(wanted.v_out)) <
                  10.0 * blur * p[model::spring::stop_stiffness]);
            if (!found.open_in && law == ContactLaw::kelvin_voigt) {
                CHECK(found.state_in[0] == p[model::spring::gap]);
            }
            if (law == ContactLaw::no_tension && !found.open_in && found.state_in[0] > p[model::spring::gap]) {
                ++reloads;
            }
        }
        contacts += result.contacts.size();
        const flow::Observables& seen = result.observables;
        const double forces = (1.0 + p[model::spring::stop_stiffness] + p[model::spring::stop_damping]) * error;
        CHECK(std::abs(seen.peak_force.value - static_cast<double>(exact.peak_force())) < forces);
        CHECK(seen.contact_time.value ==
              doctest::Approx(static_cast<double>(exact.contact_time())).epsilon(1e-11).scale(1.0));
        CHECK(std::abs(seen.impulse.value - static_cast<double>(exact.impulse())) < 1e-12 + forces);
        // Inside a step the displacement is only good to the tolerance of 1e-13, and the force to k times that.
        CHECK(std::abs(seen.stop_work.value - static_cast<double>(exact.work())) <
              1e-12 * (1.0 + seen.stop_work.value) + 10.0 * forces);
    }
    CHECK(contacts > 250);
    CHECK(reloads >= 5);
}

TEST_CASE("a long, strongly damped contact: its integrals are as good as its end points") {
    const ParameterVector p = {0.07, 1.0, 0.0, 0.885, 0.325, 22.0, 17.5, 0.65};
    flow::Request request;
    request.state = {-0.2, 0.5};
    request.duration = 12.0;
    request.observe = flow::observe_force;
    test::PiecewiseLinear exact(p, ContactLaw::kelvin_voigt);
    exact.run(request.state, 0.0, request.duration);
    REQUIRE(exact.contact_time() > 2.0);
    for (const double tolerance : {1e-8, 1e-10}) {
        CAPTURE(tolerance);
        const flow::Observables seen =
            test::run(*test::spring(ContactLaw::kelvin_voigt, tolerance), p, request).observables;
        // Errors of 0.001 to 0.02 of the tolerance were seen; with the work's product of series cut at the order of
        // its factors it was 0.16 to 1.
        CHECK(std::abs(seen.impulse.value - static_cast<double>(exact.impulse())) < 0.1 * tolerance);
        CHECK(std::abs(seen.stop_work.value - static_cast<double>(exact.work())) < 0.1 * tolerance);
    }
}

TEST_CASE("overshoots down to 1e-12 of the amplitude are found from every start, and no contact is invented") {
    for (double w : {0.7, 1.3}) {
        const Steady motion = steady(0.1, w, 0.4);
        for (const ContactLaw law : {ContactLaw::kelvin_voigt, ContactLaw::no_tension}) {
            const auto integrator = test::spring(law);
            for (double overshoot : {1e-2, 1e-4, 1e-6, 1e-8, 1e-10, 1e-12}) {
                CAPTURE(w);
                CAPTURE(overshoot);
                const double gap = motion.amplitude * (1.0 - overshoot);
                for (int start = 0; start < 40; ++start) {
                    CAPTURE(start);
                    flow::Request request;
                    request.theta = motion.lag + 0.3 + start * (two_pi - 0.6) / 40.0;
                    request.state = motion.state(request.theta);
                    if (request.state[0] > gap) { continue; }
                    request.duration = motion.lag + two_pi + 0.25 - request.theta;  // past the next maximum
                    const flow::Result result =
                        test::run(*integrator, test::with(motion.p, model::spring::gap, gap), request);
                    REQUIRE(result.status == Status::ok);
                    REQUIRE(result.contacts.size() == 1);
                    const flow::Contact& contact = result.contacts.front();
                    // x = gap: entry speed w A sqrt(1 - (1 - overshoot)^2). The overshoot itself carries the rounding
                    // of gap and motion, a few 1e-16 of the amplitude.
                    const double speed = w * motion.amplitude * std::sqrt(overshoot * (2.0 - overshoot));
                    CHECK(contact.state_in[1] == test::relative(speed, 1e-12 + 3e-15 / overshoot));
                    CHECK(contact.state_in[0] == gap);
                    CHECK(contact.theta_out > contact.theta_in);
                    CHECK(contact.state_out[1] <= 0.0);
                    const flow::Result clear = test::run(
                        *integrator, test::with(motion.p, model::spring::gap, motion.amplitude * (1.0 + overshoot)),
                        request);
                    CHECK(clear.contacts.empty());
                }
            }
        }
    }
}

TEST_CASE("the membranes' free motion just reaching the stop is caught, just missing it is not") {
    const auto integrator = membranes();
    const flow::System system{integrator.get(), test::with(paper_defaults, model::membrane::omega, 2.2), nullptr};
    orbit::ReturnMap map;
    map.stop = flow::StopMode::off;
    const orbit::Orbit free = orbit::find_orbit(system, map, test::reference_orbits[3].state);
    REQUIRE(free.ok());
    const double largest =
        orbit::apply(system, map, free.state, orbit::Differentiate::nothing, {}, flow::observe_extrema)
            .observed[orbit::x_max]
            .value;
    const double centre = integrator->centre(system.parameters);
    for (double overshoot : {1e-4, 1e-6, 1e-8, 1e-10}) {
        for (int start = 0; start < 30; ++start) {
            CAPTURE(overshoot);
            CAPTURE(start);
            flow::Request request;
            request.state = free.state;
            request.stop = flow::StopMode::off;
            request.duration = start * two_pi / 30.0;
            const flow::Result there = test::run(*integrator, system.parameters, request);
            request.theta = request.duration;
            request.state = there.state;
            request.duration = two_pi;
            request.stop = flow::StopMode::hybrid;
            request.observe = flow::observe_extrema;
            const auto at_gap = [&](double gap) {
                return test::run(*integrator, test::with(system.parameters, model::membrane::gap, gap), request);
            };
            if (there.state[0] < largest - 2.0 * overshoot) {
                const flow::Result hit = at_gap(largest - centre - overshoot);
                REQUIRE(hit.contacts.size() >= 1);  // a start just before the maximum meets the next one as well
                CHECK_FALSE(hit.contacts.front().open_in);
            }
            const flow::Result miss = at_gap(largest - centre + overshoot);
            CHECK(miss.contacts.empty());
            CHECK(std::abs(miss.observables.x_max.value - largest) < 1e-13);
        }
    }
}

TEST_CASE("a contact ends once: no second event at the instant of release") {
    // Stops from soft to very stiff, undamped to strongly damped; the exact solution has one contact per crossing.
    const Steady motion = steady(0.1, 1.0, 0.05);
    for (const ContactLaw law : {ContactLaw::kelvin_voigt, ContactLaw::no_tension}) {
        const auto integrator = test::spring(law);
        for (double k : {1e1, 1e3, 1e5, 1e7}) {
            for (double damping : {0.0, 1e-3, 1.0, 30.0}) {
                CAPTURE(k);
                CAPTURE(damping);
                ParameterVector p = test::with(motion.p, model::spring::gap, 0.3);
                p[model::spring::stop_stiffness] = k;
                p[model::spring::stop_damping] = damping;
                flow::Request request;
                request.theta = motion.lag - 1.8;
                request.state = motion.state(request.theta);
                request.duration = 1.5;  // one crossing; too short for a second bounce from a stiff stop
                const flow::Result result = test::run(*integrator, p, request);
                REQUIRE(result.status == Status::ok);
                REQUIRE(result.contacts.size() >= 1);
                const double last = result.contacts.front().theta_out;
                for (std::size_t i = 1; i < result.contacts.size(); ++i) {
                    CHECK(result.contacts[i].theta_in > last + 1e-3);
                }
                for (const flow::Contact& contact : result.contacts) {
                    if (!contact.open_out) { CHECK(contact.theta_out - contact.theta_in > 1e-6); }
                }
            }
        }
    }
}

TEST_CASE("starts on the surface, inside the stop, and marked as having just entered") {
    const auto integrator = test::spring();
    const ParameterVector p = {0.1, 1.0, 0.0, 0.5, 0.4, 200.0, 1.0, 1.1};
    flow::Request request;
    request.duration = 2.0;
    request.theta = 0.3;
    // On the surface and moving in: contact from the first instant, like one that comes from just before.
    request.state = {0.4, 0.7};
    const flow::Result on_surface = test::run(*integrator, p, request);
    request.state[0] -= 1e-13;
    const flow::Result just_before = test::run(*integrator, p, request);
    REQUIRE(just_before.contacts.size() == 1);
    REQUIRE(on_surface.contacts.size() == 1);
    CHECK(on_surface.contacts.front().theta_in == 0.3);
    CHECK(test::distance(on_surface.state, just_before.state, 2) < 1e-11);
    // The same, told that it has entered.
    request.state[0] = 0.4;
    request.starts_in_contact = true;
    const flow::Result entered = test::run(*integrator, p, request);
    REQUIRE(entered.contacts.size() == 1);
    CHECK(entered.contacts.front().open_in);
    CHECK(test::distance(entered.state, on_surface.state, 2) < 1e-14);
    request.starts_in_contact = false;
    // On the surface and moving out: no contact there.
    request.state = {0.4, -0.7};
    CHECK(test::run(*integrator, p, request).contacts.empty());
    // Inside: open at the start.
    request.state = {0.45, 0.0};
    const flow::Result inside = test::run(*integrator, p, request);
    REQUIRE(inside.contacts.size() == 1);
    CHECK(inside.contacts.front().open_in);
    // No force while it moves out fast under the no-tension law: no contact at all.
    request.state = {0.401, -0.7};
    CHECK(test::run(*test::spring(ContactLaw::no_tension), p, request).contacts.empty());
    // Contact under way at the end.
    request.state = {0.3, 0.7};
    request.duration = 0.2;
    const flow::Result cut = test::run(*integrator, p, request);
    REQUIRE(cut.contacts.size() == 1);
    CHECK(cut.contacts.front().open_out);
    CHECK(cut.contacts.front().theta_out == 0.5);
    // A force that is still rising there counts as far as it has come.
    request.duration = cut.contacts.front().theta_in + 0.02 - request.theta;
    request.observe = flow::observe_force;
    const flow::Result rising = test::run(*integrator, p, request);
    REQUIRE(rising.contacts.size() == 1);
    const double force = 200.0 * (rising.state[0] - 0.4) + 1.0 * rising.state[1];
    CHECK(force > 1.5 * rising.contacts.front().state_in[1]);
    CHECK(rising.observables.peak_force.value == test::relative(force, 1e-12));
    CHECK(rising.contacts.front().peak_force == rising.observables.peak_force.value);
}

TEST_CASE("the cap on events") {
    const auto integrator = membranes();
    flow::Request request;
    request.state = test::reference_orbits[0].state;
    request.duration = 5.0 * two_pi;
    request.max_events = 10;
    CHECK(test::run(*integrator, paper_defaults, request).status == Status::ok);
    request.max_events = 9;
    CHECK(test::run(*integrator, paper_defaults, request).status == Status::too_many_events);
    request.max_events = 0;
    CHECK(test::run(*integrator, paper_defaults, request).status == Status::too_many_events);
    request.stop = flow::StopMode::off;
    CHECK(test::run(*integrator, paper_defaults, request).status == Status::ok);
    // A motion that hops on an undamped stop under a steady push bounces without end.
    ParameterVector hopping = {0.0, 1e-3, 0.0, 1.0, 0.0, 1e8, 0.0, 1e-3};
    request = {};
    request.state = {-1e-4, 0.0};
    request.theta = -0.5;
    request.duration = 1.0;
    CHECK(test::run(*test::spring(), hopping, request).status == Status::too_many_events);
}

TEST_CASE("without a stop in the law nothing ends at the gap") {
    const Steady motion = steady(0.1, 1.0, 0.05);
    const auto integrator = test::spring(ContactLaw::none);
    flow::Request request;
    request.state = motion.state(0.0);
    request.duration = two_pi;
    request.observe = flow::observe_extrema;
    const flow::Result result = test::run(*integrator, test::with(motion.p, model::spring::gap, 0.3), request);
    CHECK(result.contacts.empty());
    CHECK(test::distance(result.state, request.state, 2) < 1e-14);
    CHECK(std::abs(result.observables.x_max.value - motion.amplitude) < 1e-15);
    CHECK(std::abs(result.observables.x_min.value + motion.amplitude) < 1e-15);
}
