// Contact-sequence shooting: the same orbits as by stroboscopic shooting, exact derivatives, no trouble at grazing.

#include "engine_cases.hpp"
#include "model/membrane/membrane.hpp"
#include "model/spring/spring.hpp"
#include "orbit/contact_sequence.hpp"
#include "orbit/orbit.hpp"
#include "relative.hpp"

#include <doctest/doctest.h>

#include <cmath>
#include <string>
#include <vector>

using namespace percuss;
using flow::ParameterVector;
using model::ContactLaw;
using numerics::Vector;
using orbit::Orbit;
using test::at;
using test::membranes;
using test::paper_defaults;

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

TEST_CASE("contact-sequence shooting finds the same orbits") {
    for (const ContactLaw law : {ContactLaw::kelvin_voigt, ContactLaw::no_tension}) {
        const auto integrator = membranes(law);
        for (const int which : {0, 1, 2, 5}) {
            const test::ReferenceOrbit& known = test::reference_orbits[at(which)];
            CAPTURE(known.name);
            const flow::System system = system_at(*integrator, known.omega);
            const Orbit found = reference_orbit(system, known);
            const auto sequence = orbit::sequence_of(system, found);
            REQUIRE(sequence.has_value());
            CHECK(sequence->period == known.period);
            REQUIRE(sequence->contacts.size() == at(known.contacts));
            const Vector z = orbit::pack(system, *sequence);
            CHECK(z.size() == sequence->unknowns(system));
            // Knocked about by 1e-3 and solved again.
            Vector pushed = z;
            for (int i = 0; i < z.size(); ++i) { pushed[i] *= 1.0 + 1e-3 * (i % 2 == 0 ? 1.0 : -1.0); }
            const orbit::SequenceSolution solution =
                orbit::solve_sequence(system, orbit::unpack(system, pushed, known.period));
            REQUIRE(solution.ok);
            CHECK(solution.iterations <= 10);
            const Vector again = orbit::pack(system, solution.sequence);
            // Stroboscopic Newton leaves 1e-14 in the state, divided by entry speeds of 0.05 and more.
            CHECK((again - z).lpNorm<Eigen::Infinity>() < 1e-10);
            const auto state = orbit::state_at(system, solution.sequence, 0.0);
            REQUIRE(state.has_value());
            CHECK(test::distance(*state, found.state, 4) < 1e-10);
            CHECK_FALSE(orbit::state_at(system, solution.sequence, sequence->contacts[0].phase + 1.0).has_value());
        }
    }
}

TEST_CASE("derivatives of the contact-sequence equations, one and two contacts, both laws, both models") {
    struct Scene {
        std::string name;
        std::unique_ptr<flow::Integrator> integrator;
        ParameterVector p;
        orbit::ContactSequence sequence;
        std::array<int, 3> parameters;  ///< differentiated by
    };
    std::vector<Scene> scenes;
    for (const ContactLaw law : {ContactLaw::kelvin_voigt, ContactLaw::no_tension}) {
        const std::string suffix = law == ContactLaw::kelvin_voigt ? ", kelvin-voigt" : ", no-tension";
        for (const int which : {0, 5}) {
            const test::ReferenceOrbit& known = test::reference_orbits[at(which)];
            Scene scene{std::string(known.name) + suffix, membranes(law, 1e-16), {}, {}, {}};
            const flow::System system = system_at(*scene.integrator, known.omega);
            scene.p = system.parameters;
            scene.sequence = orbit::sequence_of(system, reference_orbit(system, known)).value();
            scene.parameters = {model::membrane::gap, model::membrane::omega,
                                which == 0 ? model::membrane::stiffness : model::membrane::damping};
            scenes.push_back(std::move(scene));
        }
        Scene scene{"spring" + suffix, test::spring(law, 1e-16), {0.1, 1.0, 0.3, 0.5, 0.4, 200.0, 1.5, 1.1}, {}, {}};
        const flow::System system{scene.integrator.get(), scene.p, nullptr};
        scene.sequence = orbit::sequence_of(system, orbit::away_from_contact(system, settled_orbit(system))).value();
        scene.parameters = {model::spring::gap, model::spring::omega, model::spring::cubic};
        scenes.push_back(std::move(scene));
    }
    for (Scene& scene : scenes) {
        CAPTURE(scene.name);
        // Away from the solution, so that nothing vanishes by luck.
        for (orbit::ContactUnknowns& contact : scene.sequence.contacts) {
            contact.speed *= 1.05;
            contact.phase += 0.01;
            contact.duration *= 0.97;
            contact.rest[0] *= 1.01;
        }
        const flow::System system{scene.integrator.get(), scene.p, nullptr};
        const Vector z = orbit::pack(system, scene.sequence);
        std::array<ParameterVector, 3> directions;
        for (std::size_t i = 0; i < 3; ++i) { directions[i] = orbit::unit_direction(scene.parameters[i]); }
        const auto exact = orbit::evaluate(system, scene.sequence, directions);
        REQUIRE(exact.has_value());
        REQUIRE(exact->value.size() == z.size());
        const auto rows = static_cast<std::size_t>(z.size());
        const auto compare = [&](const std::vector<test::Derivative>& numeric, const Vector& column, double size) {
            for (std::size_t r = 0; r < rows; ++r) {
                CAPTURE(r);
                CAPTURE(numeric[r].value);
                CAPTURE(numeric[r].error);
                const double entry = column[static_cast<int>(r)];
                CHECK(numeric[r].error < 1e-6 * (1.0 / size + std::abs(entry)));
                CHECK(std::abs(entry - numeric[r].value) <
                      10.0 * numeric[r].error + 3e-8 * (1.0 / size + std::abs(entry)));
            }
        };
        const auto residual = [&](const flow::System& at_system, const Vector& at_z) {
            const auto r = orbit::evaluate(at_system, orbit::unpack(at_system, at_z, scene.sequence.period), {});
            REQUIRE(r.has_value());
            return std::vector<double>(r->value.begin(), r->value.end());
        };
        for (int column = 0; column < z.size(); ++column) {
            CAPTURE(column);
            const double size = std::abs(z[column]);
            compare(test::ridders_many(
                        [&](double amount) {
                            Vector moved = z;
                            moved[column] += amount;
                            return residual(system, moved);
                        },
                        rows, 1e-3 * size),
                    exact->by_unknowns.col(column), size);
        }
        for (int column = 0; column < 3; ++column) {
            const int parameter = scene.parameters[at(column)];
            CAPTURE(parameter);
            const double size = std::abs(scene.p[at(parameter)]);
            compare(test::ridders_many(
                        [&](double amount) {
                            return residual(
                                system.with(test::with(scene.p, parameter, scene.p[at(parameter)] + amount)), z);
                        },
                        rows, 1e-3 * size),
                    exact->by_directions.col(column), size);
        }
    }
}

TEST_CASE("the contact equations stay smooth through a contact of no duration") {
    // (x(t_c) - x_stop)/t_c has the limit v as t_c goes to zero, and slope x''/2 there; both without cancellation.
    const auto integrator = membranes();
    const flow::System system = system_at(*integrator, 1.9);
    orbit::ContactSequence sequence;
    sequence.contacts.push_back({0.05, 3.3, 0.0, {1.18, 1.19}});
    const auto column_at = [&](double duration) {
        sequence.contacts[0].duration = duration;
        const auto r = orbit::evaluate(system, sequence, {});
        REQUIRE(r.has_value());
        return std::array{r->value[0], r->by_unknowns(0, 2), r->by_unknowns(0, 0)};
    };
    const auto still = column_at(0.0);
    CHECK(still[0] == test::relative(0.05 / 1.9, 1e-14));
    CHECK(still[2] == test::relative(1.0 / 1.9, 1e-14));
    for (double duration : {1e-15, 1e-12, 1e-9, 1e-7, 1e-6, 2e-6, 1e-5, -1e-9, -1e-5}) {
        CAPTURE(duration);
        const auto r = column_at(duration);
        CHECK(std::abs(r[0] - still[0] - duration * still[1]) < 1e-16 + 1e2 * duration * duration);
        // x'''/3 of the contact, about k v, times the duration; above 1e-6 a quotient that loses 1e-16/duration.
        CHECK(std::abs(r[1] - still[1]) < 1e3 * std::abs(duration) + 1e-9);
        CHECK(std::abs(r[2] - still[2]) < 1e2 * std::abs(duration) + 1e-14);
    }
}
