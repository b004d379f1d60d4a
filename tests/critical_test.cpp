// Boundaries of striking and free motions in any parameter: reference values, and gradients against differences of
// boundaries solved again.

#include "boundary/critical.hpp"
#include "branch/trace.hpp"
#include "engine_cases.hpp"
#include "model/membrane/membrane.hpp"
#include "orbit/polish.hpp"
#include "relative.hpp"

#include <doctest/doctest.h>

#include <cmath>
#include <string>
#include <vector>

using namespace percuss;
using boundary::CriticalPoint;
using boundary::Kind;
using branch::BoundaryPoint;
using flow::ParameterVector;
using model::ContactLaw;
using test::at;
using test::membranes;
using test::paper_defaults;
using test::with;
namespace membrane = model::membrane;
namespace spring = model::spring;

namespace {

/// Main branch along omega from a motion reached from rest.
branch::Branch main_branch(const flow::Integrator& integrator, const ParameterVector& p, double from, double to,
                           double size) {
    const flow::System base{&integrator, p, nullptr};
    const flow::System start = base.at_omega(from);
    const auto settled = orbit::settle(start, integrator.rest_state(start.parameters), 200);
    REQUIRE(settled.has_value());
    const orbit::Orbit found = orbit::polish_orbit(start, *settled, 1);
    REQUIRE(found.ok());
    branch::Departure departure;
    departure.motion = orbit::motion_of(start, found);
    departure.parameter = from;
    departure.direction = to > from ? 1.0 : -1.0;
    branch::TraceOptions options;
    options.from = from;
    options.to = to;
    options.size = size;
    const flow::ParameterFamily family = flow::along_frequency(base, integrator.linear_resonance(p));
    branch::Branch traced = branch::trace(family, departure, options);
    CHECK(traced.end == branch::End::range);
    return traced;
}

const BoundaryPoint& nearest(const branch::Branch& branch, Kind kind, double omega) {
    const BoundaryPoint* best = nullptr;
    for (const BoundaryPoint& found : branch.boundaries) {
        if (found.kind != kind) { continue; }
        if (best == nullptr || std::abs(found.point.omega - omega) < std::abs(best->point.omega - omega)) {
            best = &found;
        }
    }
    REQUIRE(best != nullptr);
    return *best;
}

/// d(omega) of a boundary along parameters against differences of boundaries solved again.
void check_gradient(const flow::Integrator& integrator, const ParameterVector& p, const BoundaryPoint& found,
                    const std::vector<int>& parameters, double size, double agreement) {
    const flow::System base{&integrator, p, nullptr};
    const double unit = integrator.linear_resonance(p);
    std::vector<ParameterVector> directions;
    for (const int parameter : parameters) { directions.push_back(orbit::unit_direction(parameter)); }
    const auto solve = [&](const ParameterVector& there, std::span<const ParameterVector> along) {
        const flow::ParameterFamily family = flow::along_frequency(base.with(there), unit);
        return boundary::solve_critical(family, found.kind, found.point.motion, found.point.omega, found.contact,
                                        found.angle, size, along);
    };
    const CriticalPoint exact = solve(p, directions);
    REQUIRE(exact.ok());
    CHECK(exact.parameter == test::relative(found.point.omega, 1e-11));
    REQUIRE(exact.d_parameter.size() == parameters.size());
    for (std::size_t i = 0; i < parameters.size(); ++i) {
        INFO("by ", integrator.info().names[at(parameters[i])]);
        const double value = p[at(parameters[i])];
        const test::Derivative numeric = test::ridders(
            [&](double amount) {
                const CriticalPoint moved = solve(with(p, parameters[i], value + amount), {});
                REQUIRE(moved.ok());
                return moved.parameter;
            },
            1e-3 * value, 5);
        CAPTURE(exact.d_parameter[i]);
        CAPTURE(numeric.value);
        CAPTURE(numeric.error);
        const double scale = std::abs(exact.d_parameter[i]) + 0.1 / value;
        CHECK(numeric.error < agreement * scale);
        CHECK(std::abs(exact.d_parameter[i] - numeric.value) < 3.0 * numeric.error + agreement * scale);
    }
}

/// The multiplier that the kind is about is where it should be.
void check_multiplier(const BoundaryPoint& found) {
    if (found.kind == Kind::grazing) { return; }
    const std::complex<double> critical = found.kind == Kind::fold ? std::complex<double>(1.0)
                                        : found.kind == Kind::flip ? std::complex<double>(-1.0)
                                                                   : std::polar(1.0, found.angle);
    double away = 1e300;
    for (const auto& mu : found.point.map_multipliers) { away = std::min(away, std::abs(mu - critical)); }
    CAPTURE(boundary::to_string(found.kind));
    CAPTURE(found.point.omega);
    CHECK(away < 1e-6);
}

}  // namespace

TEST_CASE("boundaries of the paper's defaults depend on the design as differences say") {
    const auto integrator = membranes(ContactLaw::kelvin_voigt, 1e-14);
    const branch::Branch branch = main_branch(*integrator, paper_defaults, 4.0, 1.2, 0.1);
    for (const BoundaryPoint& found : branch.boundaries) { check_multiplier(found); }
    const std::vector<int> design = {membrane::gap,     membrane::stiffness, membrane::damping,
                                     membrane::voltage, membrane::delta_a,   membrane::length};
    const struct {
        Kind kind;
        double omega;
        double agreement;
    } cases[] = {
        {Kind::fold, 2.586046250529, 2e-8},
        {Kind::flip, 1.745872449920, 2e-8},
        {Kind::grazing, 1.583113016312, 2e-8},
    };
    for (const auto& each : cases) {
        CAPTURE(boundary::to_string(each.kind));
        const BoundaryPoint& found = nearest(branch, each.kind, each.omega);
        CHECK(std::abs(found.point.omega - each.omega) < 1e-11);
        check_gradient(*integrator, paper_defaults, found, design, 0.1, each.agreement);
    }
    // Beside grazing the fold moves with it: the stop itself hardly matters.
    const BoundaryPoint& beside = nearest(branch, Kind::fold, 1.9354);
    check_gradient(*integrator, paper_defaults, beside, {membrane::gap, membrane::voltage, membrane::delta_a}, 0.1,
                   2e-8);
}

TEST_CASE("fold and flip against a stop that cannot pull") {
    const auto integrator = membranes(ContactLaw::no_tension, 1e-14);
    const branch::Branch branch = main_branch(*integrator, paper_defaults, 4.0, 1.2, 0.1);
    for (const BoundaryPoint& found : branch.boundaries) {
        if (found.partner < 0) { check_multiplier(found); }
    }
    const std::vector<int> design = {membrane::gap, membrane::stiffness, membrane::damping, membrane::voltage};
    check_gradient(*integrator, paper_defaults, nearest(branch, Kind::fold, 2.587), design, 0.1, 2e-8);
    check_gradient(*integrator, paper_defaults, nearest(branch, Kind::flip, 1.746), design, 0.1, 2e-8);
}

TEST_CASE("torus points, free and striking") {
    {
        const auto integrator = membranes(ContactLaw::none, 1e-14);
        ParameterVector p = paper_defaults;
        p[membrane::voltage] = 0.232;
        p[membrane::delta_a] = 0.022;
        p[membrane::delta_b] = 390.0;
        const branch::Branch branch = main_branch(*integrator, p, 3.0, 1.6, 0.1);
        const BoundaryPoint& torus = nearest(branch, Kind::torus, 1.79);
        CHECK(torus.point.omega == doctest::Approx(1.7928).epsilon(1e-4));
        check_multiplier(torus);
        check_gradient(*integrator, p, torus, {membrane::voltage, membrane::delta_a, membrane::layers}, 0.1, 3e-7);
    }
    const auto integrator = membranes(ContactLaw::no_tension, 1e-14);
    ParameterVector p = paper_defaults;
    p[membrane::stiffness] = 4231.0;
    p[membrane::gap] = 0.04066;
    p[membrane::voltage] = 0.6947;
    p[membrane::layers] = 3.0;
    p[membrane::delta_a] = 0.5113;
    p[membrane::delta_b] = 24.03;
    p[membrane::damping] = 12.3;
    const branch::Branch branch = main_branch(*integrator, p, 8.0, 3.0, p[membrane::gap]);
    const BoundaryPoint& torus = nearest(branch, Kind::torus, 4.82);
    CHECK(torus.point.omega == doctest::Approx(4.819895).epsilon(1e-6));
    CHECK(torus.point.contacts.size() == 1);
    CHECK(torus.uncertainty < 1e-10);
    check_multiplier(torus);
    check_gradient(*integrator, p, torus, {membrane::voltage, membrane::delta_a, membrane::gap, membrane::stiffness},
                   p[membrane::gap], 3e-7);
}

TEST_CASE("the soft stop of the bilinear oscillator, both laws") {
    for (const ContactLaw law : {ContactLaw::kelvin_voigt, ContactLaw::no_tension}) {
        const auto integrator = test::spring(law, 1e-15);
        ParameterVector p = test::soft_impact::parameters;
        const bool published = law == ContactLaw::kelvin_voigt;
        if (!published) { p[spring::stop_damping] = 0.5; }
        const branch::Branch branch = main_branch(*integrator, p, 2.5, 0.7, 1.0);
        std::vector<int> parameters = {spring::force, spring::gap, spring::stop_stiffness, spring::damping};
        if (!published) { parameters.push_back(spring::stop_damping); }
        const BoundaryPoint& fold = nearest(branch, Kind::fold, 1.5);
        check_multiplier(fold);
        check_gradient(*integrator, p, fold, parameters, 1.0, 2e-8);
        if (!published) { continue; }
        CHECK(std::abs(fold.point.omega - test::soft_impact::fold_upper) < 6e-10);  // nine decimals given
        const auto& contact = fold.point.motion.sequence.contacts.at(0);
        CHECK(std::abs(contact.duration / fold.point.omega - test::soft_impact::fold_upper_contact_time) < 6e-9);
        const BoundaryPoint& beside = nearest(branch, Kind::fold, 1.0727);
        CHECK(std::abs(beside.point.omega - test::soft_impact::fold_near_grazing) < 6e-12);
        check_multiplier(beside);
        check_gradient(*integrator, p, beside, {spring::force, spring::gap, spring::damping}, 1.0, 2e-8);
        for (const double omega : {test::soft_impact::grazing_lower, test::soft_impact::grazing_upper}) {
            const BoundaryPoint& grazing = nearest(branch, Kind::grazing, omega);
            CHECK(std::abs(grazing.point.omega - omega) < 6e-13);
            // A = d sqrt((k - w^2)^2 + c^2 w^2): dw/dA is one over its derivative by w.
            const flow::ParameterFamily family = flow::along_frequency({integrator.get(), p, nullptr}, 1.0);
            const ParameterVector by_force = orbit::unit_direction(spring::force);
            const CriticalPoint exact = boundary::solve_critical(family, Kind::grazing, grazing.point.motion, omega,
                                                                 grazing.contact, 0.0, 1.0, {&by_force, 1});
            REQUIRE(exact.ok());
            const double c = p[spring::damping];
            const double slope = (-2.0 * omega * (1.0 - omega * omega) + c * c * omega) / p[spring::force];
            CHECK(exact.d_parameter[0] == test::relative(1.0 / slope, 1e-10));
        }
    }
}

TEST_CASE("a boundary that is not there is not found") {
    const auto integrator = membranes();
    const flow::System system{integrator.get(), paper_defaults, nullptr};
    const flow::ParameterFamily family = flow::along_frequency(system, 1.7);
    const orbit::Orbit found = orbit::polish_orbit(system, test::reference_orbits[0].state, 1);
    REQUIRE(found.ok());
    const orbit::Motion motion = orbit::motion_of(system, found);
    const CriticalPoint torus = boundary::solve_critical(family, Kind::torus, motion, 1.9, 0, 1.5, 0.1);
    CHECK_FALSE(torus.ok());
    CHECK(torus.status != boundary::SolveStatus::not_run);
    CHECK_FALSE(CriticalPoint{}.ok());
}
