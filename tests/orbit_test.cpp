// Periodic orbits: the reference orbits by both kinds of shooting, multipliers, energy, symmetry, convergence.

#include "engine_cases.hpp"
#include "model/membrane/membrane.hpp"
#include "orbit/contact_sequence.hpp"
#include "orbit/orbit.hpp"
#include "relative.hpp"

#include <doctest/doctest.h>

#include <cmath>
#include <string>
#include <vector>

using namespace percuss;
using flow::ParameterVector;
using flow::State;
using model::ContactLaw;
using numerics::Matrix;
using numerics::Vector;
using orbit::Orbit;
using test::at;
using test::membranes;
using test::paper_defaults;
using test::pi;
using test::two_pi;

namespace {

flow::System system_at(const flow::Integrator& integrator, double omega) {
    return {&integrator, test::with(paper_defaults, model::membrane::omega, omega), nullptr};
}

orbit::ReturnMap map_of(const test::ReferenceOrbit& known) {
    orbit::ReturnMap map;
    map.period = known.period;
    return map;
}

Orbit reference_orbit(const flow::System& system, const test::ReferenceOrbit& known) {
    const Orbit found = orbit::find_orbit(system, map_of(known), known.state);
    REQUIRE(found.ok());
    return found;
}

/// Orbit reached by settling from rest.
Orbit settled_orbit(const flow::System& system, int cycles = 300) {
    const auto state = orbit::settle(system, system.integrator->rest_state(system.parameters), cycles);
    REQUIRE(state.has_value());
    const Orbit found = orbit::find_orbit(system, {}, *state);
    REQUIRE(found.ok());
    return found;
}

}  // namespace

TEST_CASE("the six reference orbits") {
    const auto integrator = membranes();
    for (const test::ReferenceOrbit& known : test::reference_orbits) {
        CAPTURE(known.name);
        const flow::System system = system_at(*integrator, known.omega);
        const Orbit found = reference_orbit(system, known);
        CHECK(found.residual < 1e-11);
        // Given to 1e-12 (1e-14 at 1.9).
        CHECK(test::distance(found.state, known.state, 4) < 2e-12);
        CHECK(static_cast<int>(found.contacts.size()) == known.contacts);
        const orbit::Portrait portrait = orbit::portray(system, found, {}, flow::observe_all);
        REQUIRE(portrait.ok());
        const auto& observed = portrait.image.observed;
        // Nine to eleven digits given; half a unit of the last.
        CHECK(observed[orbit::peak_force].value == test::relative(known.peak_force, 1e-9));
        if (known.amplitude > 0.0) {
            const double amplitude = 0.5 * (observed[orbit::x_max].value - observed[orbit::x_min].value);
            CHECK(std::abs(amplitude - known.amplitude) < 6e-13);  // twelve decimals given
        }
        CHECK(std::abs(orbit::max_multiplier(found) - known.max_multiplier) <
              known.max_multiplier_error + 2e-9 * known.max_multiplier);
    }
}

TEST_CASE("multipliers and extrema at omega = 1.9") {
    const auto integrator = membranes();
    const flow::System system = system_at(*integrator, 1.9);
    const Orbit found = reference_orbit(system, test::reference_orbits[0]);
    const numerics::SmallComplexVector values = orbit::multipliers(found);
    REQUIRE(values.size() == 4);
    for (int k = 0; k < 4; ++k) {
        CAPTURE(k);
        // The reference is good to 4e-10 of the modulus.
        CHECK(std::abs(values[k] - test::at_1_9::multipliers[at(k)]) < 1e-9);
    }
    const orbit::Portrait portrait = orbit::portray(system, found, {}, flow::observe_extrema);
    CHECK(std::abs(portrait.image.observed[orbit::x_max].value - test::at_1_9::x_max) < 1e-13);
    CHECK(std::abs(portrait.image.observed[orbit::x_min].value - test::at_1_9::x_min) < 1e-13);
    CHECK(portrait.residual < 1e-13);
    // Liouville: the product of all multipliers is exp of the integrated divergence, which must be below 1 here and is
    // the same number however the orbit is strobed.
    const double product = std::abs(values[0] * values[1] * values[2] * values[3]);
    orbit::ReturnMap later;
    later.phase = 1.0;
    flow::Request request;
    request.state = found.state;
    request.duration = 1.0;
    const Orbit moved = orbit::find_orbit(system, later, test::run(*integrator, system.parameters, request).state);
    REQUIRE(moved.ok());
    for (int k = 0; k < 4; ++k) { CHECK(std::abs(orbit::multipliers(moved)[k] - values[k]) < 1e-9); }
    CHECK(std::abs(moved.monodromy.determinant()) == test::relative(product, 1e-8));
    CHECK(product < 1.0);
}

TEST_CASE("energy over a period: drive work = dissipation + stop work, ten orbits") {
    struct Scene {
        std::string name;
        ContactLaw law;
        ParameterVector p;
    };
    const auto varied = [](std::initializer_list<std::pair<int, double>> changes) {
        ParameterVector p = paper_defaults;
        for (const auto& [index, value] : changes) { p[at(index)] = value; }
        return p;
    };
    using namespace model::membrane;
    const std::vector<Scene> actuators = {
        {"defaults", ContactLaw::kelvin_voigt, varied({{omega, 1.9}})},
        {"no tension", ContactLaw::no_tension, varied({{omega, 1.9}})},
        {"soft stop", ContactLaw::kelvin_voigt, varied({{omega, 1.8}, {stiffness, 100.0}})},
        {"four layers", ContactLaw::kelvin_voigt, varied({{omega, 3.5}, {layers, 4.0}})},
        {"alpha_A 2.6, alpha_B 2.5", ContactLaw::kelvin_voigt, varied({{omega, 1.85}, {alpha_a, 2.6}, {alpha_b, 2.5}})},
        {"damped stop, no tension", ContactLaw::no_tension, varied({{omega, 1.85}, {damping, 20.0}})},
        {"free at 3", ContactLaw::kelvin_voigt, varied({{omega, 3.0}})}};
    int impacting = 0;
    const auto check = [&](const Scene& scene, const flow::Integrator& integrator) {
        CAPTURE(scene.name);
        const flow::System system{&integrator, scene.p, nullptr};
        const Orbit found = settled_orbit(system);
        impacting += found.contacts.empty() ? 0 : 1;
        const orbit::Portrait portrait = orbit::portray(system, found, {}, flow::observe_energy | flow::observe_force);
        REQUIRE(portrait.ok());
        const auto& seen = portrait.image.observed;
        const double drive = seen[orbit::drive_work].value;
        CAPTURE(drive);
        CHECK(drive > 0.0);
        CHECK(seen[orbit::dissipation].value > 0.0);
        CHECK((seen[orbit::stop_work].value > 0.0) == !found.contacts.empty());
        CHECK(std::abs(drive - seen[orbit::dissipation].value - seen[orbit::stop_work].value) < 1e-10 * drive);
    };
    for (const Scene& scene : actuators) { check(scene, *membranes(scene.law)); }
    const std::vector<Scene> springs = {
        {"spring", ContactLaw::kelvin_voigt, {0.1, 1.0, 0.3, 0.5, 0.4, 200.0, 1.5, 1.1}},
        {"spring, no tension", ContactLaw::no_tension, {0.1, 1.0, 0.3, 0.5, 0.4, 200.0, 1.5, 1.1}},
        {"Duffing", ContactLaw::none, {0.05, 1.0, 0.1, 0.18, 1.0, 0.0, 0.0, 1.4}}};
    for (const Scene& scene : springs) { check(scene, *test::spring(scene.law)); }
    CHECK(impacting >= 7);
}

TEST_CASE("without the stop an orbit is its own mirror image half a period later") {
    const auto integrator = membranes();
    for (const double w : {1.7, 2.2, 3.0, 4.5}) {
        CAPTURE(w);
        const flow::System system = system_at(*integrator, w);
        orbit::ReturnMap whole;
        whole.stop = flow::StopMode::off;
        const auto settled = orbit::settle(system, integrator->rest_state(system.parameters), 100, flow::StopMode::off);
        REQUIRE(settled.has_value());
        const Orbit full = orbit::find_orbit(system, whole, *settled);
        REQUIRE(full.ok());
        orbit::ReturnMap half = whole;
        half.mirrored = true;
        CHECK(half.duration() == doctest::Approx(pi));
        const orbit::Image image = orbit::apply(system, half, full.state, orbit::Differentiate::nothing);
        CHECK(test::distance(image.state, full.state, 4) < 1e-12);
        flow::Request still;
        still.state = full.state;
        still.stop = flow::StopMode::off;
        CHECK(test::distance(image.rate, test::run(*integrator, system.parameters, still).rate, 4) < 1e-12);
        // The same orbit from half a cycle's map; its multipliers squared are those of the whole.
        const Orbit mirrored = orbit::find_orbit(system, half, *settled);
        REQUIRE(mirrored.ok());
        CHECK(test::distance(mirrored.state, full.state, 4) < 1e-12);
        const auto a = orbit::multipliers(full);
        const auto b = orbit::multipliers(mirrored);
        for (int k = 0; k < 4; ++k) { CHECK(std::abs(a[k] - b[k]) < 1e-9); }
        // Twice mirrored is as before.
        CHECK(test::distance(orbit::mirror(system, orbit::mirror(system, full.state)), full.state, 4) < 1e-15);
        // Both extrema lie equally far from the centre.
        const orbit::Portrait portrait = orbit::portray(system, full, {}, flow::observe_extrema);
        const double centre = integrator->centre(system.parameters);
        CHECK(std::abs(portrait.image.observed[orbit::x_max].value + portrait.image.observed[orbit::x_min].value -
                       2.0 * centre) < 1e-12);
    }
    orbit::ReturnMap wrong;
    wrong.mirrored = true;
    CHECK_THROWS_AS(orbit::apply(system_at(*integrator, 2.0), wrong, test::reference_orbits[0].state,
                                 orbit::Differentiate::nothing),
                    std::invalid_argument);
}

TEST_CASE("Newton's method converges quadratically from perturbed guesses") {
    const auto integrator = membranes();
    for (const int which : {0, 1, 2, 3}) {
        const test::ReferenceOrbit& known = test::reference_orbits[at(which)];
        CAPTURE(known.name);
        const flow::System system = system_at(*integrator, known.omega);
        State guess = known.state;
        guess[0] += 2e-3;
        guess[1] -= 3e-3;
        guess[2] += 1e-3;
        std::vector<double> residuals;
        for (int iterations = 1; iterations <= 8; ++iterations) {
            orbit::NewtonOptions options;
            options.max_iterations = iterations;
            const Orbit found = orbit::find_orbit(system, {}, guess, options);
            residuals.push_back(found.residual);
            if (found.ok()) {
                CHECK(found.iterations <= 6);
                CHECK(test::distance(found.state, known.state, 4) < 2e-12);
                break;
            }
        }
        REQUIRE(residuals.size() >= 3);
        CHECK(residuals.back() < 1e-11);
        // r_(k+1) <= C r_k^2 while above rounding; C is the map's curvature, a few thousand with k = 2500.
        int pairs = 0;
        for (std::size_t k = 0; k + 1 < residuals.size(); ++k) {
            CAPTURE(k);
            CAPTURE(residuals[k]);
            CAPTURE(residuals[k + 1]);
            if (residuals[k] > 1e-4) { continue; }
            CHECK(residuals[k + 1] < 5e3 * residuals[k] * residuals[k] + 1e-13);
            ++pairs;
        }
        CHECK(pairs >= 1);
    }
}

TEST_CASE("what cannot be found is said") {
    const auto integrator = membranes();
    const flow::System system = system_at(*integrator, 1.9);
    orbit::NewtonOptions options;
    options.max_iterations = 1;
    State guess = test::reference_orbits[0].state;
    guess[0] += 1e-2;
    const Orbit early = orbit::find_orbit(system, {}, guess, options);
    CHECK(early.status == orbit::OrbitStatus::no_convergence);
    CHECK_FALSE(early.ok());
    guess[2] = -1.0;
    CHECK(orbit::find_orbit(system, {}, guess).status == orbit::OrbitStatus::flow_failed);
    CHECK(Orbit{}.status == orbit::OrbitStatus::not_run);
    CHECK_FALSE(orbit::settle(system, guess, 3).has_value());
    const std::vector<ParameterVector> many(orbit::max_directions + 1);
    CHECK_THROWS_AS(orbit::apply(system, {}, test::reference_orbits[0].state, orbit::Differentiate::all, many),
                    std::invalid_argument);
}

TEST_CASE("an orbit strobed in contact is moved to the middle of its flight") {
    const auto integrator = membranes();
    const flow::System system = system_at(*integrator, 1.9);
    const Orbit known = reference_orbit(system, test::reference_orbits[0]);
    flow::Request request;
    request.state = known.state;
    request.duration = 3.42;  // contact from 3.3618 to 3.4771
    const State inside = test::run(*integrator, system.parameters, request).state;
    orbit::ReturnMap map;
    map.phase = 3.42;
    const Orbit touching = orbit::find_orbit(system, map, inside);
    REQUIRE(touching.ok());
    REQUIRE(touching.contacts.size() == 2);  // cut in two by the strobe
    CHECK(touching.contacts.front().open_in);
    CHECK(touching.contacts.back().open_out);
    CHECK_FALSE(orbit::sequence_of(system, touching).has_value());
    const Orbit moved = orbit::away_from_contact(system, touching);
    REQUIRE(moved.ok());
    REQUIRE(moved.contacts.size() == 1);
    CHECK_FALSE(moved.contacts.front().open_in);
    const double entry = known.contacts[0].theta_in;
    const double middle = known.contacts[0].theta_out + 0.5 * (entry + two_pi - known.contacts[0].theta_out);
    CHECK(moved.map.phase == test::relative(std::fmod(middle, two_pi), 1e-9));
    for (int k = 0; k < 4; ++k) {
        CHECK(std::abs(orbit::multipliers(moved)[k] - orbit::multipliers(known)[k]) < 1e-9);
        // A strobe inside the contact has the same multipliers.
        CHECK(std::abs(orbit::multipliers(touching)[k] - orbit::multipliers(known)[k]) < 1e-8);
    }
    // An orbit without contacts stays as it is.
    const flow::System above = system_at(*integrator, 3.0);
    const Orbit free = reference_orbit(above, test::reference_orbits[4]);
    CHECK(orbit::away_from_contact(above, free).map.phase == 0.0);
}

TEST_CASE("derivatives of an orbit and its observables along parameters, implicitly and by differences") {
    const auto integrator = membranes();
    const flow::System system = system_at(*integrator, 1.9);
    const Orbit base = reference_orbit(system, test::reference_orbits[0]);
    std::vector<ParameterVector> directions;
    for (int i = 0; i < model::membrane::count; ++i) { directions.push_back(orbit::unit_direction(i)); }
    const orbit::Portrait portrait = orbit::portray(system, base, directions, flow::observe_all);
    REQUIRE(portrait.ok());
    for (int i = 0; i < model::membrane::count; ++i) {
        CAPTURE(model::membrane::names[at(i)]);
        const double size = paper_defaults[at(i)];
        const auto values = [&](double amount) {
            const flow::System moved = system.with(test::with(system.parameters, i, size + amount));
            const Orbit found = orbit::find_orbit(moved, {}, base.state);
            REQUIRE(found.ok());
            const orbit::Image image =
                orbit::apply(moved, {}, found.state, orbit::Differentiate::nothing, {}, flow::observe_all);
            std::vector<double> all(found.state.begin(), found.state.end());
            for (const orbit::Observed& o : image.observed) { all.push_back(o.value); }
            return all;
        };
        const std::size_t count = 4 + orbit::first_mean;  // membranes have no mean signals
        const auto numeric = test::ridders_many(values, count, 1e-3 * size);
        const std::vector<double> at_base = values(0.0);
        for (std::size_t c = 0; c < count; ++c) {
            CAPTURE(c);
            CAPTURE(numeric[c].error);
            const double exact = c < 4 ? portrait.d_state(static_cast<int>(c), i)
                                       : portrait.total(static_cast<orbit::ObservableIndex>(c - 4), i);
            const double scale = std::abs(exact) + std::abs(at_base[c]) / size;
            CHECK(numeric[c].error < 1e-6 * scale);
            // Orbits are converged to 1e-14/(1 - 0.89); lanes are good to 1e-8.
            CHECK(std::abs(exact - numeric[c].value) < 10.0 * numeric[c].error + 1e-7 * scale);
        }
    }
}

TEST_CASE("error estimates bound the true error and are not absurdly large") {
    const test::ReferenceOrbit& known = test::reference_orbits[0];
    const auto exact = membranes(ContactLaw::kelvin_voigt, 1e-16);
    const Orbit best = reference_orbit(system_at(*exact, 1.9), known);
    const orbit::Image truth =
        orbit::apply(system_at(*exact, 1.9), {}, best.state, orbit::Differentiate::nothing, {}, flow::observe_all);
    for (const double tolerance : {1e-6, 1e-8, 1e-10, 1e-13}) {
        CAPTURE(tolerance);
        const auto loose = membranes(ContactLaw::kelvin_voigt, tolerance);
        const auto tighter = membranes(ContactLaw::kelvin_voigt, std::max(1e-16, 1e-2 * tolerance));
        const flow::System system = system_at(*loose, 1.9);
        const Orbit found = reference_orbit(system, known);
        const orbit::Portrait portrait = orbit::portray(system, found, {}, flow::observe_all);
        const orbit::ErrorEstimate estimate =
            orbit::estimate_errors(system_at(*tighter, 1.9), found, portrait, flow::observe_all);
        double state_error = 0.0;
        for (std::size_t k = 0; k < 4; ++k) { state_error += std::pow(found.state[k] - best.state[k], 2); }
        state_error = std::sqrt(state_error);
        // Rounding, 1e-14, is in neither.
        CHECK(state_error < 10.0 * estimate.state + 2e-14);
        CHECK(estimate.state < 100.0 * state_error + 1e-13);
        for (std::size_t q = 0; q < orbit::observable_count; ++q) {
            CAPTURE(q);
            const double error = std::abs(portrait.image.observed[q].value - truth.observed[q].value);
            CAPTURE(error);
            CHECK(error < 10.0 * estimate.observed[q] + 1e-13 * std::abs(truth.observed[q].value) + 1e-13);
        }
    }
}
