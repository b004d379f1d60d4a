// Grazing, fold, flip and torus points: published and reference values, closed forms, derivatives.

#include "boundary/edge.hpp"
#include "design/operating_point.hpp"
#include "engine_cases.hpp"
#include "orbit/orbit.hpp"
#include "relative.hpp"

#include <doctest/doctest.h>

#include <cmath>
#include <functional>
#include <vector>

using namespace percuss;
using boundary::Boundary;
using boundary::Kind;
using flow::ParameterVector;
using orbit::Orbit;
using orbit::ReturnMap;
using test::at;
using test::membranes;
using test::paper_defaults;
using test::two_pi;
namespace reference = test::boundary_reference;

namespace {

flow::System system_of(const flow::Integrator& integrator, const ParameterVector& p) {
    return {&integrator, p, nullptr};
}

/// Free orbit of the half-cycle map at a frequency, from rest.
flow::State free_state(const flow::System& system, double omega) {
    const flow::System there = system.at_omega(omega);
    const auto settled = orbit::settle(there, there.integrator->rest_state(there.parameters), 60, flow::StopMode::off);
    REQUIRE(settled.has_value());
    const Orbit free = orbit::find_orbit(there, boundary::FreeBranch::map_of(there), *settled);
    REQUIRE(free.ok());
    return free.state;
}

Boundary grazing_near(const flow::System& system, double omega, std::span<const ParameterVector> directions = {}) {
    return boundary::solve_boundary(system, boundary::FreeBranch::map_of(system), Kind::grazing,
                                    free_state(system, omega), omega, directions);
}

/// Impacting orbit of the defaults at one frequency, continued to another.
Orbit impacting(const flow::Integrator& integrator, const test::ReferenceOrbit& from, double to) {
    const flow::System system = system_of(integrator, test::with(paper_defaults, model::membrane::omega, from.omega));
    const Orbit start = orbit::find_orbit(system, {}, from.state);
    REQUIRE(start.ok());
    const auto moved = design::continue_orbit(system, start, to);
    REQUIRE(moved.has_value());
    return *moved;
}

/// d_omega and d_state along each parameter against differences of solved boundaries.
void check_derivatives(const flow::System& system, const ReturnMap& map, Kind kind, const Boundary& point,
                       const std::vector<int>& parameters, double agreement) {
    std::vector<ParameterVector> directions;
    for (int i : parameters) { directions.push_back(orbit::unit_direction(i)); }
    const Boundary exact = boundary::solve_boundary(system, map, kind, point.state, point.omega, directions);
    REQUIRE(exact.ok());
    REQUIRE(exact.d_omega.size() == parameters.size());
    const int n = system.states();
    for (std::size_t i = 0; i < parameters.size(); ++i) {
        const int parameter = parameters[i];
        INFO("by ", system.integrator->info().names[at(parameter)]);
        const double size = std::abs(system.parameters[at(parameter)]);
        const auto solved = [&](double amount) {
            const Boundary moved = boundary::solve_boundary(
                system.with(test::with(system.parameters, parameter, system.parameters[at(parameter)] + amount)), map,
                kind, point.state, point.omega, {});
            REQUIRE(moved.ok());
            std::vector<double> all(moved.state.begin(), moved.state.begin() + n);
            all.push_back(moved.omega);
            return all;
        };
        const auto numeric = test::ridders_many(solved, at(n + 1), 1e-3 * size, 5);
        for (int c = 0; c <= n; ++c) {
            const double value = c == n ? exact.d_omega[i] : exact.d_state[i][at(c)];
            const test::Derivative& d = numeric[at(c)];
            CAPTURE(c);
            CAPTURE(value);
            CAPTURE(d.value);
            CAPTURE(d.error);
            const double scale = std::abs(value) + 0.1 / size;
            CHECK(d.error < 0.3 * agreement * scale);
            CHECK(std::abs(value - d.value) < 3.0 * d.error + agreement * scale);
        }
    }
}

}  // namespace

TEST_CASE("grazing points of the defaults, upper and lower") {
    const auto integrator = membranes();
    const flow::System system = system_of(*integrator, paper_defaults);
    const Boundary upper = grazing_near(system, 1.96);
    REQUIRE(upper.ok());
    CHECK(std::abs(upper.omega - reference::grazing_upper) < 6e-12);  // 11 decimals given
    const Boundary lower = grazing_near(system, 1.57);
    REQUIRE(lower.ok());
    CHECK(std::abs(lower.omega - reference::grazing_lower) < 1e-12);
    for (const Boundary& point : {upper, lower}) {
        CAPTURE(point.omega);
        CHECK(point.kind == Kind::grazing);
        // The state at the contact's phase is on the surface and at rest.
        flow::Request request;
        request.state = point.state;
        request.duration = point.theta_contact;
        request.stop = flow::StopMode::off;
        const flow::Result there =
            test::run(*integrator, test::with(paper_defaults, model::membrane::omega, point.omega), request);
        CHECK(std::abs(there.state[0] - integrator->stop_position(paper_defaults)) < 1e-13);
        CHECK(std::abs(there.state[1]) < 1e-7);  // the phase of a maximum: half the digits
    }
    // It belongs to the free orbit: no trace of the stop's stiffness and damping.
    check_derivatives(system, boundary::FreeBranch::map_of(system), Kind::grazing, upper,
                      {model::membrane::gap, model::membrane::voltage, model::membrane::delta_a,
                       model::membrane::length, model::membrane::layers, model::membrane::alpha_a},
                      1e-7);
    const std::vector<ParameterVector> stop = {orbit::unit_direction(model::membrane::stiffness),
                                               orbit::unit_direction(model::membrane::damping)};
    const Boundary untouched = grazing_near(system, 1.96, stop);
    CHECK(untouched.d_omega[0] == 0.0);
    CHECK(untouched.d_omega[1] == 0.0);
}

TEST_CASE("grazing of a linear oscillator: F = d sqrt((k - w^2)^2 + c^2 w^2)") {
    const auto integrator = test::spring();
    test::Random random(31);
    for (int trial = 0; trial < 40; ++trial) {
        CAPTURE(trial);
        // The first is the example of the collection: k = 1, c = 0.1, d = 1, F = 0.1, w = 1.
        const double k = trial == 0 ? 1.0 : random.uniform(0.5, 2.0);
        const double c = trial == 0 ? 0.1 : random.uniform(0.05, 0.4);
        const double d = trial == 0 ? 1.0 : random.uniform(0.2, 2.0);
        const double w = trial == 0 ? 1.0 : std::sqrt(k) * random.uniform(0.5, 1.8);
        const double force = d * std::hypot(k - w * w, c * w);
        // d(F^2)/dw = 0 at the resonance: a double root, two grazing points in one.
        const double steepness = std::abs(-4.0 * w * (k - w * w) + 2.0 * c * c * w) * d * d / (2.0 * force * force);
        if (steepness < 0.05) { continue; }
        const flow::System system = system_of(*integrator, {c, k, 0.0, force, d, 100.0, 1.0, w});
        const double guess = w * (1.0 + (trial % 2 == 0 ? 0.01 : -0.01) * std::min(1.0, steepness));
        const std::vector<ParameterVector> directions = {orbit::unit_direction(model::spring::force),
                                                         orbit::unit_direction(model::spring::gap)};
        const Boundary point = grazing_near(system, guess, directions);
        REQUIRE(point.ok());
        // 1e-15 of the amplitude over its slope in w.
        CHECK(std::abs(point.omega - w) < 1e-12 * (1.0 + 1.0 / steepness));
        // F^2/d^2 = (k - w^2)^2 + c^2 w^2 differentiated.
        const double by_omega = -4.0 * w * (k - w * w) + 2.0 * c * c * w;
        CHECK(point.d_omega[0] == test::relative(2.0 * force / (d * d) / by_omega, 1e-8));
        CHECK(point.d_omega[1] == test::relative(-2.0 * force * force / (d * d * d) / by_omega, 1e-8));
        const double lag = std::atan2(c * w, k - w * w);
        CHECK(std::abs(std::remainder(point.theta_contact - lag, two_pi)) < 1e-7);
    }
}

TEST_CASE("the fold beside the upper grazing point of the defaults") {
    const auto integrator = membranes();
    const flow::System system = system_of(*integrator, paper_defaults);
    const Boundary grazing = grazing_near(system, 1.96);
    REQUIRE(grazing.ok());
    const boundary::GrazingFold fold = boundary::find_fold_beside(system, grazing, 0.02);
    REQUIRE(fold.status == boundary::GrazingFold::Status::found);
    // 5.64e-9, known to three digits.
    CHECK(grazing.omega - fold.omega == test::relative(reference::fold_offset_upper, 2e-3));
    CHECK(fold.offset * grazing.omega == test::relative(reference::fold_offset_upper, 2e-3));
    CHECK(std::abs(fold.omega - reference::fold_near_grazing_upper) < 6e-12);
    CHECK(fold.speed == test::relative(8.4e-5, 1e-2));  // two digits published
    // On either side of the fold's speed the branch lies higher in frequency.
    for (const double factor : {0.5, 2.0}) {
        orbit::ContactSequence guess = fold.sequence;
        guess.contacts[0].duration *= factor;
        const orbit::SpeedSolution beside = orbit::solve_at_speed(system, guess, fold.omega, factor * fold.speed);
        REQUIRE(beside.ok);
        CHECK(beside.omega > fold.omega);
        CHECK((beside.slope > 0.0) == (factor > 1.0));
    }
}

TEST_CASE("fold and flip of the impacting orbit of the defaults") {
    const auto integrator = membranes();
    const flow::System system = system_of(*integrator, paper_defaults);
    const ReturnMap whole;

    const Orbit near_fold = impacting(*integrator, test::reference_orbits[1], 2.58);
    const Boundary fold = boundary::solve_boundary(system, whole, Kind::fold, near_fold.state, 2.58, {});
    REQUIRE(fold.ok());
    CHECK(std::abs(fold.omega - reference::fold_upper) < 1e-9);
    const orbit::Image image = orbit::apply(system.at_omega(fold.omega), whole, fold.state, orbit::Differentiate::state,
                                            {}, flow::observe_force);
    // The state at a fold is only as good as the square root of what omega is good to; the force has 11 digits given.
    CHECK(image.observed[orbit::peak_force].value == test::relative(reference::fold_upper_peak_force, 1e-9));
    Orbit there;
    there.monodromy = image.derivative;
    CHECK(std::abs(orbit::multipliers(there)[0] - 1.0) < 1e-7);
    // The differences of monodromy matrices inside are good to 1e-8.
    check_derivatives(system, whole, Kind::fold, fold,
                      {model::membrane::gap, model::membrane::stiffness, model::membrane::damping,
                       model::membrane::voltage, model::membrane::delta_a, model::membrane::delta_b},
                      1e-6);

    const Orbit near_flip = impacting(*integrator, test::reference_orbits[0], 1.75);
    const Boundary flip = boundary::solve_boundary(system, whole, Kind::flip, near_flip.state, 1.75, {});
    REQUIRE(flip.ok());
    CHECK(std::abs(flip.omega - reference::flip) < 1e-9);
    const orbit::Image at_flip =
        orbit::apply(system.at_omega(flip.omega), whole, flip.state, orbit::Differentiate::state);
    there.monodromy = at_flip.derivative;
    CHECK(std::abs(orbit::multipliers(there)[0] + 1.0) < 1e-9);
    check_derivatives(system, whole, Kind::flip, flip,
                      {model::membrane::gap, model::membrane::stiffness, model::membrane::damping,
                       model::membrane::voltage, model::membrane::delta_a, model::membrane::layers},
                      1e-6);
}

TEST_CASE("torus point of a free motion with low losses") {
    ParameterVector p = paper_defaults;
    p[model::membrane::voltage] = 0.232;
    p[model::membrane::delta_a] = 0.022;
    p[model::membrane::delta_b] = 390.0;
    const auto integrator = membranes();
    const flow::System system = system_of(*integrator, p);
    boundary::FreeBranch branch(system);
    const boundary::Edge edge = boundary::find_edge(branch, system, {}, {});
    // The motion touches the stop, at 1.854, before it comes down to the torus point.
    REQUIRE(edge.status == boundary::EdgeStatus::found);
    CHECK(edge.boundary.kind == Kind::grazing);
    CHECK(edge.boundary.omega > 1.85);
    const ReturnMap half = boundary::FreeBranch::map_of(system);
    const Boundary torus = boundary::solve_boundary(system, half, Kind::torus, free_state(system, 1.81), 1.80, {});
    REQUIRE(torus.ok());
    CHECK(std::abs(torus.omega - 1.79) < 0.01);  // "near 1.79"
    Orbit there;
    there.monodromy =
        orbit::apply(system.at_omega(torus.omega), half, torus.state, orbit::Differentiate::state).derivative;
    const auto leading = orbit::multipliers(there)[0];
    CHECK(std::abs(std::abs(leading) - 1.0) < 1e-9);
    CHECK(std::abs(leading.imag()) > 1e-3);
    check_derivatives(system, half, Kind::torus, torus,
                      {model::membrane::voltage, model::membrane::delta_a, model::membrane::delta_b,
                       model::membrane::layers, model::membrane::length},
                      1e-6);
}

TEST_CASE("soft impact: grazing frequencies, multipliers, folds and the fold curve") {
    namespace soft = test::soft_impact;
    const auto integrator = test::spring();
    const flow::System system = system_of(*integrator, soft::parameters);
    const Boundary upper = grazing_near(system, 1.08);
    REQUIRE(upper.ok());
    CHECK(std::abs(upper.omega - soft::grazing_upper) < 1e-12);
    const Boundary lower = grazing_near(system, 0.915);
    REQUIRE(lower.ok());
    CHECK(std::abs(lower.omega - soft::grazing_lower) < 1e-12);

    const boundary::GrazingFold beside = boundary::find_fold_beside(system, upper, 0.02);
    REQUIRE(beside.status == boundary::GrazingFold::Status::found);
    CHECK(std::abs(beside.omega - soft::fold_near_grazing) < 6e-12);

    // The impacting motion is followed up from where it is the only one.
    const ReturnMap whole;
    const flow::System low = system.at_omega(1.05);
    const auto settled = orbit::settle(low, integrator->rest_state(soft::parameters), 500);
    REQUIRE(settled.has_value());
    const Orbit start = orbit::away_from_contact(low, orbit::find_orbit(low, whole, *settled));
    REQUIRE(start.ok());
    REQUIRE(start.contacts.size() == 1);
    const auto at_known = design::continue_orbit(low, start, soft::multiplier_omega);
    REQUIRE(at_known.has_value());
    CHECK(std::abs(orbit::multipliers(*at_known)[0] - soft::multiplier) < 1e-8);  // eight decimals given
    CHECK(std::abs(orbit::multipliers(*at_known)[1] - std::conj(soft::multiplier)) < 1e-8);

    const auto near_fold = design::continue_orbit(system.at_omega(soft::multiplier_omega), *at_known, 1.572);
    REQUIRE(near_fold.has_value());
    const Boundary fold = boundary::solve_boundary(system, near_fold->map, Kind::fold, near_fold->state, 1.572, {});
    REQUIRE(fold.ok());
    CHECK(std::abs(fold.omega - soft::fold_upper) < 1e-9);
    const orbit::Image image = orbit::apply(system.at_omega(fold.omega), near_fold->map, fold.state,
                                            orbit::Differentiate::nothing, {}, flow::observe_force);
    CHECK(std::abs(image.observed[orbit::contact_time].value - soft::fold_upper_contact_time) < 2e-8);
    check_derivatives(system, near_fold->map, Kind::fold, fold,
                      {model::spring::force, model::spring::damping, model::spring::gap, model::spring::stop_stiffness},
                      1e-6);

    // Fold curve in the force, each point from the one before it, in short steps.
    Boundary point = fold;
    double force = soft::parameters[model::spring::force];
    for (const auto& [known_force, known_omega] : soft::fold_curve) {
        CAPTURE(known_force);
        while (force != known_force) {
            force = std::min(known_force, force + 0.01);
            point = boundary::solve_boundary(system.with(test::with(soft::parameters, model::spring::force, force)),
                                             near_fold->map, Kind::fold, point.state, point.omega, {});
            REQUIRE(point.ok());
        }
        CHECK(std::abs(point.omega - known_omega) < 1.1e-9);  // nine decimals given
    }
}

TEST_CASE("the edge of the defaults by the rule, and free motions that coexist below it") {
    const auto integrator = membranes();
    const flow::System system = system_of(*integrator, paper_defaults);
    boundary::FreeBranch branch(system);
    const std::vector<ParameterVector> directions = {orbit::unit_direction(model::membrane::gap),
                                                     orbit::unit_direction(model::membrane::voltage)};
    const boundary::Edge edge = boundary::find_edge(branch, system, {}, directions);
    REQUIRE(edge.status == boundary::EdgeStatus::found);
    CHECK(edge.boundary.kind == Kind::grazing);
    CHECK(std::abs(edge.boundary.omega - test::edge_reference::omega) < 6e-12);
    CHECK(edge.boundary.d_omega[0] == test::relative(test::edge_reference::d_gap[0], 1e-5));
    CHECK(edge.boundary.d_omega[1] == test::relative(test::edge_reference::d_phi_pp[0], 1e-5));
    CHECK(edge.searched_from > 3.0 * 1.5);
    CHECK(edge.searched_to <= edge.boundary.omega);
    CHECK(edge.reason.empty());
    // Just below the edge no free motion is clear of the stop; followed on, the branch is back below the lower one.
    const boundary::FreeOrbitsAt below = boundary::free_orbits_at(branch, system, 1.9, 1.8);
    CHECK(below.complete);
    REQUIRE(below.points.size() == 1);
    CHECK(below.points[0].clearance > 0.0);
    const boundary::FreeOrbitsAt lower = boundary::free_orbits_at(branch, system, 1.55, 1.5);
    CHECK(lower.complete);
    REQUIRE(lower.points.size() == 1);
    CHECK(lower.points[0].clearance < 0.0);
    CHECK(lower.points[0].stable());
}

TEST_CASE("followed down through a resonance with low losses the free branch does not hop back to where it has been") {
    // The branch of the torus point's design comes back from its upper loop steeply, past the point where the motion
    // changes from anti-phase to in-phase: a long step there can land on the branch above the resonance.
    ParameterVector p = paper_defaults;
    p[model::membrane::voltage] = 0.232;
    p[model::membrane::delta_a] = 0.022;
    p[model::membrane::delta_b] = 390.0;
    const auto integrator = membranes();
    const flow::System system = system_of(*integrator, p);
    boundary::FreeBranch branch(system);
    REQUIRE(branch.start(4.0));
    for (const double omega : {1.9, 1.85, 1.77}) {
        CAPTURE(omega);
        boundary::FreeBranch again(system);
        REQUIRE(again.start(4.0));
        const boundary::FreeOrbitsAt found = boundary::free_orbits_at(again, system, omega, 1.4);
        CHECK(found.complete);
        for (std::size_t i = 0; i < found.points.size(); ++i) {
            for (std::size_t j = 0; j < i; ++j) {
                CHECK(test::distance(found.points[i].state, found.points[j].state, 4) > 1e-6);
            }
        }
    }
    int steps = 0;
    while (branch.current().omega > 1.5 && steps < 100 && branch.advance()) { ++steps; }
    CHECK(branch.current().omega < 1.5);
    CHECK(steps < 100);
}

TEST_CASE("points that are not there") {
    const auto integrator = membranes();
    // Too little voltage ever to reach the stop.
    const flow::System weak = system_of(*integrator, test::with(paper_defaults, model::membrane::voltage, 0.1));
    boundary::FreeBranch branch(weak);
    const boundary::Edge edge = boundary::find_edge(branch, weak, {}, {});
    CHECK(edge.status == boundary::EdgeStatus::no_impact);
    CHECK_FALSE(edge.reason.empty());
    CHECK_FALSE(grazing_near(weak, 1.9).ok());
    CHECK(Boundary{}.status == boundary::SolveStatus::not_run);
    CHECK_FALSE(Boundary{}.ok());
}
