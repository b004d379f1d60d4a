// The Taylor integrator's kernels: scenes, instruction sets, numbers of directions; what they refuse and what they
// report.

#include "engine_cases.hpp"
#include "flow/sundials.hpp"
#include "kernels/plain_systems.hpp"
#include "model/membrane/membrane.hpp"
#include "relative.hpp"

#include <doctest/doctest.h>

#include <cmath>
#include <string_view>
#include <vector>

using namespace percuss;
using flow::ParameterVector;
using flow::State;
using flow::Status;
using test::membranes;
using test::paper_defaults;
using test::two_pi;

namespace {

flow::Request reference_request() {
    flow::Request request;
    request.state = test::reference_orbits[0].state;
    request.duration = two_pi;
    return request;
}

}  // namespace

TEST_CASE("without Maxwell branches: the limit of a vanishing mu_ratio, and the explicit Runge-Kutta method") {
    flow::Request request;
    request.state = {0.4, 0.35, 1.18, 1.19};
    request.duration = 9.0;
    request.observe = flow::observe_all;
    const auto elastic = membranes(model::ContactLaw::kelvin_voigt, 1e-13, false);
    const auto viscous = membranes();
    REQUIRE(elastic->info().states == 2);
    const ParameterVector none = test::with(paper_defaults, model::membrane::mu_ratio, 0.0);
    const flow::Result a = test::run(*elastic, none, request);
    REQUIRE(a.status == Status::ok);
    REQUIRE(a.contacts.size() >= 2);
    double last = 1.0;
    for (double ratio : {1e-4, 1e-8, 1e-12}) {
        CAPTURE(ratio);
        const ParameterVector small = test::with(paper_defaults, model::membrane::mu_ratio, ratio);
        const flow::Result b = test::run(*viscous, small, request);
        const double apart = test::distance(a.state, b.state, 2);
        CHECK(apart < 20.0 * ratio + 1e-12);  // linear in mu_ratio
        CHECK(apart < 1e-2 * last);
        last = apart;
    }
    const auto exact = kernels::make_plain_system(model::membrane::elastic, model::ContactLaw::kelvin_voigt);
    const auto erk = flow::make_erk(exact, 1e-13);
    const flow::Result c = test::run(*erk, none, request);
    REQUIRE(c.status == Status::ok);
    // Contacts multiply errors by about 5 each; forces by k = 2500.
    CHECK(test::distance(a.state, c.state, 2) < 1e-11);
    for (const auto& [name, member] : test::observables) {
        CAPTURE(name);
        CHECK(member(a.observables).value == test::relative(member(c.observables).value, 1e-9));
    }
}

TEST_CASE("kernels of all instruction sets agree, and so do those for few and many directions") {
    std::vector<flow::Direction> directions(8);
    for (std::size_t i = 0; i < 4; ++i) { directions[i].state[i] = 1.0; }
    directions[4].phase = 1.0;
    directions[5].parameter[model::membrane::gap] = 1.0;
    directions[6].parameter[model::membrane::omega] = 1.0;
    directions[7].parameter[model::membrane::voltage] = 1.0;
    struct Scene {
        const model::Scene* kind;
        ParameterVector p;
        State state;
    };
    const std::vector<Scene> scenes = {
        {&model::membrane::viscous, paper_defaults, test::reference_orbits[0].state},
        {&model::membrane::elastic, test::with(paper_defaults, model::membrane::mu_ratio, 0.0), {0.4, 0.35}},
        {&model::spring::scene, {0.1, 1.0, 0.3, 0.5, 0.4, 200.0, 1.0, 1.1}, {0.2, 0.5}}};
    CHECK(kernels::instruction_sets().size() >= 1);
    CHECK(kernels::instruction_set_in_use("auto") == kernels::instruction_sets().back());
    for (const Scene& scene : scenes) {
        CAPTURE(scene.kind->name);
        const auto run_with = [&](std::string_view set, std::size_t lanes) {
            kernels::IntegratorOptions options;
            options.instruction_set = set;
            const auto integrator = kernels::make_integrator(*scene.kind, model::ContactLaw::kelvin_voigt, options);
            flow::Request request;
            request.state = scene.state;
            request.duration = two_pi;
            request.observe = flow::observe_all;
            request.directions = std::span(directions.data(), lanes);
            return test::run(*integrator, scene.p, request);
        };
        // Rounding differs by fused multiply-adds: 1e-13 of each quantity, more where it is a difference (k = 2500).
        // With another number of directions the steps differ: lanes agree as far as their shorter series go.
        const auto check_same = [&](const flow::Result& one, const flow::Result& two, std::size_t lanes, double apart) {
            CHECK(test::distance(one.state, two.state, 4) < 1e-13);
            for (std::size_t k = 0; k < 4; ++k) {
                for (std::size_t i = 0; i < lanes; ++i) {
                    CHECK(two.state_d[k][i] == doctest::Approx(one.state_d[k][i]).epsilon(apart).scale(1.0));
                }
            }
            for (const auto& [name, member] : test::observables) {
                CAPTURE(name);
                const flow::Sensitive& a = member(one.observables);
                const flow::Sensitive& b = member(two.observables);
                CHECK(b.value == test::relative(a.value, 1e-12));
                for (std::size_t i = 0; i < lanes; ++i) {
                    CHECK(b.d[i] == doctest::Approx(a.d[i]).epsilon(apart).scale(1.0));
                }
            }
        };
        for (const std::size_t lanes : {std::size_t{8}, std::size_t{3}, std::size_t{0}}) {
            CAPTURE(lanes);
            const flow::Result base = run_with(kernels::instruction_sets().front(), lanes);
            REQUIRE(base.status == Status::ok);
            REQUIRE(base.contacts.size() >= 1);
            check_same(run_with(kernels::instruction_sets().front(), 8), base, lanes, 1e-7);
            for (const std::string_view set : kernels::instruction_sets()) {
                CAPTURE(set);
                const flow::Result other = run_with(set, lanes);
                CHECK(base.steps == other.steps);
                check_same(base, other, lanes, 1e-11);
            }
        }
    }
}

TEST_CASE("requests that cannot be served are refused; motions that cannot be followed have a status") {
    const auto integrator = membranes();
    flow::Request request = reference_request();
    request.duration = -1.0;
    CHECK_THROWS_AS(test::run(*integrator, paper_defaults, request), std::invalid_argument);
    request.duration = 1.0;
    const std::vector<flow::Direction> nine(9);
    request.directions = nine;
    CHECK_THROWS_AS(test::run(*integrator, paper_defaults, request), std::invalid_argument);
    for (double tolerance : {0.0, -1e-9, 1e-17, 0.1, std::nan("")}) {
        CAPTURE(tolerance);
        CHECK_THROWS_AS(membranes(model::ContactLaw::kelvin_voigt, tolerance), std::invalid_argument);
    }
    kernels::IntegratorOptions options;
    options.integrator = "euler";
    CHECK_THROWS_AS(kernels::make_integrator(model::spring::scene, model::ContactLaw::none, options),
                    std::invalid_argument);
    options = {};
    options.instruction_set = "v9";
    CHECK_THROWS_AS(kernels::make_integrator(model::spring::scene, model::ContactLaw::none, options),
                    std::invalid_argument);

    request = reference_request();
    request.max_steps = 10;
    CHECK(test::run(*integrator, paper_defaults, request).status == Status::too_many_steps);
    // A softening cubic spring beyond its top runs away; a NaN never counts as success.
    request = {};
    request.state = {3.0, 0.0};
    request.duration = 50.0;
    const ParameterVector runaway = {0.1, 1.0, -0.5, 0.1, 10.0, 100.0, 0.0, 1.0};
    CHECK(test::run(*test::spring(model::ContactLaw::none), runaway, request).status == Status::diverged);
    request.state = {std::nan(""), 0.0};
    CHECK(test::run(*test::spring(model::ContactLaw::none), runaway, request).status == Status::diverged);
    request = reference_request();
    request.state[2] = -1.0;  // a negative stretch
    CHECK(test::run(*integrator, paper_defaults, request).status == Status::diverged);
    // Nothing to do is done.
    request = reference_request();
    request.duration = 0.0;
    const flow::Result still = test::run(*integrator, paper_defaults, request);
    CHECK(still.status == Status::ok);
    CHECK(test::distance(still.state, request.state, 4) < 1e-15);
}
