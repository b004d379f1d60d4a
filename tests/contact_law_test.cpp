// The table of contact laws, row by row, and that the integrators follow it.

#include "engine_cases.hpp"
#include "model/contact_law.hpp"

#include <doctest/doctest.h>

#include <array>
#include <string>

using namespace percuss;
using model::contact_rules;
using model::ContactEvent;
using model::ContactLaw;
using model::ContactPhase;
using model::Transition;
using model::Watched;

namespace {

bool same(const Transition& a, const Transition& b) {
    return a.watched == b.watched && a.direction == b.direction && a.event == b.event && a.next == b.next &&
           a.on_surface == b.on_surface && a.deflates == b.deflates && a.saltation == b.saltation;
}

constexpr std::array phases = {ContactPhase::free, ContactPhase::contact, ContactPhase::slack};
constexpr std::array laws = {ContactLaw::kelvin_voigt, ContactLaw::no_tension, ContactLaw::none};

}  // namespace

TEST_CASE("kelvin-voigt: contact begins and ends where the gap function passes zero") {
    for (const bool damped : {true, false}) {
        const auto& rules = contact_rules(ContactLaw::kelvin_voigt, damped);
        CHECK(rules.has_stop);
        CHECK_FALSE(rules.releases_on_force);
        REQUIRE(rules.from(ContactPhase::free).count == 1);
        REQUIRE(rules.from(ContactPhase::contact).count == 1);
        CHECK(rules.from(ContactPhase::slack).count == 0);
        CHECK(same(rules.from(ContactPhase::free).rows[0],
                   {Watched::gap, +1, ContactEvent::entry, ContactPhase::contact, true, true, -1}));
        CHECK(same(rules.from(ContactPhase::contact).rows[0],
                   {Watched::gap, -1, ContactEvent::exit, ContactPhase::free, true, true, +1}));
    }
}

TEST_CASE("no-tension, damped: the force ends contact inside the zone of the stop") {
    const auto& rules = contact_rules(ContactLaw::no_tension, true);
    CHECK(rules.releases_on_force);
    REQUIRE(rules.from(ContactPhase::free).count == 1);
    REQUIRE(rules.from(ContactPhase::contact).count == 1);
    REQUIRE(rules.from(ContactPhase::slack).count == 2);
    CHECK(same(rules.from(ContactPhase::free).rows[0],
               {Watched::gap, +1, ContactEvent::entry, ContactPhase::contact, true, false, -1}));
    CHECK(same(rules.from(ContactPhase::contact).rows[0],
               {Watched::force, -1, ContactEvent::release, ContactPhase::slack, false, false, 0}));
    CHECK(same(rules.from(ContactPhase::slack).rows[0],
               {Watched::gap, -1, ContactEvent::leave, ContactPhase::free, true, true, 0}));
    CHECK(same(rules.from(ContactPhase::slack).rows[1],
               {Watched::force, +1, ContactEvent::reload, ContactPhase::contact, false, false, 0}));
}

TEST_CASE("no-tension, undamped: the force ends on the surface, so there is no slack to pass through") {
    const auto& rules = contact_rules(ContactLaw::no_tension, false);
    CHECK(same(rules.from(ContactPhase::free).rows[0],
               {Watched::gap, +1, ContactEvent::entry, ContactPhase::contact, true, true, -1}));
    CHECK(same(rules.from(ContactPhase::contact).rows[0],
               {Watched::force, -1, ContactEvent::release, ContactPhase::free, true, true, 0}));
}

TEST_CASE("none: no phase but free and nothing to watch") {
    const auto& rules = contact_rules(ContactLaw::none);
    CHECK_FALSE(rules.has_stop);
    for (const ContactPhase phase : phases) { CHECK(rules.from(phase).count == 0); }
    CHECK(rules.first_phase(1.0, 1.0) == ContactPhase::free);
}

TEST_CASE("first phases") {
    for (const bool damped : {true, false}) {
        const auto& pulling = contact_rules(ContactLaw::kelvin_voigt, damped);
        CHECK(pulling.first_phase(-1.0, -1.0) == ContactPhase::free);
        CHECK(pulling.first_phase(0.0, 1.0) == ContactPhase::free);
        CHECK(pulling.first_phase(1.0, -1.0) == ContactPhase::contact);
        const auto& pushing = contact_rules(ContactLaw::no_tension, damped);
        CHECK(pushing.first_phase(-1.0, 1.0) == ContactPhase::free);
        CHECK(pushing.first_phase(1.0, 1.0) == ContactPhase::contact);
        CHECK(pushing.first_phase(1.0, -1.0) == ContactPhase::slack);
    }
}

TEST_CASE("names and consistency of the table") {
    for (const ContactLaw law : laws) {
        CHECK(model::find_contact_law(model::to_string(law)) == law);
        CHECK(contact_rules(law, true).name == contact_rules(law, false).name);
        for (const bool damped : {true, false}) {
            const auto& rules = contact_rules(law, damped);
            for (const ContactPhase phase : phases) {
                for (const Transition& row : rules.from(phase)) {
                    CHECK(row.next != phase);
                    CHECK(rules.direction(phase, row.watched) == row.direction);
                    // a function that is zero after the event is one that the next phase watches
                    if (row.deflates) { CHECK(row.on_surface); }
                    // sensitivities jump only where the surface is crossed into or out of contact
                    if (row.saltation != 0) { CHECK(row.watched == Watched::gap); }
                }
            }
        }
    }
    CHECK_FALSE(model::find_contact_law("kelvin voigt"));
}

TEST_CASE("the three integrators pass the same contacts under every law, damped and undamped") {
    for (const ContactLaw law : laws) {
        for (const double damping : {0.0, 1.0, 40.0}) {
            CAPTURE(model::to_string(law));
            CAPTURE(damping);
            // c k1 k3 F gap k delta_i omega: slow drive, so that the mass strikes several times a period
            const flow::ParameterVector p = {0.1, 1.0, 0.3, 2.0, 0.4, 200.0, damping, 0.3};
            flow::Request request;
            request.state = {0.2, 0.5};
            request.duration = 2.0 * test::two_pi;
            kernels::IntegratorOptions options;
            options.tolerance = 1e-12;
            const auto taylor = kernels::make_integrator(model::spring::scene, law, options);
            const flow::Result expected = test::run(*taylor, p, request);
            REQUIRE(expected.status == flow::Status::ok);
            CHECK(expected.contacts.empty() == (law == ContactLaw::none));
            for (const std::string name : {"erk", "cvode"}) {
                CAPTURE(name);
                options.integrator = name;
                const flow::Result other =
                    test::run(*kernels::make_integrator(model::spring::scene, law, options), p, request);
                REQUIRE(other.status == flow::Status::ok);
                REQUIRE(other.contacts.size() == expected.contacts.size());
                for (std::size_t i = 0; i < expected.contacts.size(); ++i) {
                    CHECK(other.contacts[i].theta_in == doctest::Approx(expected.contacts[i].theta_in).epsilon(1e-6));
                    CHECK(other.contacts[i].theta_out == doctest::Approx(expected.contacts[i].theta_out).epsilon(1e-6));
                }
            }
            const std::array<flow::State, 1> starts = {request.state};
            std::array<flow::EnsembleMember, 1> members;
            flow::EnsembleRequest many;
            many.states = starts;
            many.duration = request.duration;
            taylor->run_ensemble(p, many, members);
            CHECK(members[0].status == flow::Status::ok);
            CHECK(members[0].contacts == static_cast<int>(expected.contacts.size()));
            CHECK(members[0].state[0] == doctest::Approx(expected.state[0]).epsilon(1e-7));
        }
    }
}

TEST_CASE("a run ends early when it is cancelled or its steps are spent, and says so") {
    const flow::ParameterVector p = {0.1, 1.0, 0.3, 2.0, 0.4, 200.0, 1.0, 0.3};
    for (const std::string name : {"taylor", "erk", "cvode"}) {
        CAPTURE(name);
        kernels::IntegratorOptions options;
        options.integrator = name;
        options.tolerance = 1e-10;
        const auto integrator = kernels::make_integrator(model::spring::scene, ContactLaw::kelvin_voigt, options);
        flow::Cost cost;
        const flow::System system{integrator.get(), p, &cost};
        flow::Request request;
        request.state = {0.2, 0.5};
        request.duration = 1e5;
        request.max_events = 10'000'000;
        request.max_steps = 100'000'000;
        flow::Result result;

        int asked = 0;
        cost.cancelled = [&] { return ++asked > 3; };
        system.run(request, result);
        CHECK(result.status == flow::Status::cancelled);
        CHECK(result.steps > 0);
        CHECK(result.steps <= 3 * 256);
        const long before = cost.runs;
        system.run(request, result);  // refuses to begin
        CHECK(result.status == flow::Status::cancelled);
        CHECK(result.steps == 0);
        CHECK(cost.runs == before);

        cost = {};
        cost.step_budget = 1000;
        system.run(request, result);
        CHECK(result.status == flow::Status::budget_spent);
        CHECK(result.steps == 1000);
        system.run(request, result);
        CHECK(result.status == flow::Status::budget_spent);

        const std::array<flow::State, 1> starts = {request.state};
        std::array<flow::EnsembleMember, 1> members;
        flow::EnsembleRequest many;
        many.states = starts;
        many.duration = request.duration;
        many.max_events = request.max_events;
        many.max_steps = request.max_steps;
        system.run_ensemble(many, members);
        CHECK(members[0].status == flow::Status::budget_spent);
        cost = {};
        asked = 0;
        cost.cancelled = [&] { return ++asked > 3; };
        system.run_ensemble(many, members);
        CHECK(members[0].status == flow::Status::cancelled);
    }
    CHECK(flow::to_string(flow::Status::cancelled) == "cancelled");
    CHECK(flow::to_string(flow::Status::budget_spent) == "the budget of integration steps is spent");
}
