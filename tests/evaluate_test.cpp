// One design evaluated: reference tables at the edge, integrators, error estimates.

#include "design_cases.hpp"
#include "engine_cases.hpp"
#include "model/membrane/membrane.hpp"
#include "relative.hpp"

#include <doctest/doctest.h>

#include <cmath>
#include <string>
#include <vector>

using namespace percuss;
using design::Demand;
using design::EdgeKind;
using design::Evaluation;
using design::EvaluationStatus;
using design::Quantity;
using design::Verdict;
using model::Key;
using model::Specification;
using test::at;
using test::changed;
using test::Changes;
using test::evaluate;
using test::everything;
using test::nondimensional;
namespace reference = test::edge_reference;

namespace {

double gradient(const Evaluation& e, Quantity q, std::size_t i) {
    return e.gradients.quantity[static_cast<std::size_t>(q)][i];
}

}  // namespace

TEST_CASE("at the edge of the defaults: frequency, force, amplitude and their gradients") {
    const design::Problem problem = nondimensional(0.0);
    const design::Evaluator evaluator(problem);
    Demand demand = everything(problem.actuator);
    demand.gradients = {percuss::model::membrane::key::nd_gap, percuss::model::membrane::key::nd_stiffness,
                        percuss::model::membrane::key::nd_voltage};
    const Evaluation e = evaluator.evaluate(demand);
    CHECK(e.operating_point.edge_kind == EdgeKind::grazing);
    CHECK(e.operating_point.omega == e.operating_point.edge_omega);
    CHECK(std::abs(e.operating_point.edge_omega - reference::omega) < 6e-12);
    CHECK(e.operating_point.drive_frequency == test::relative(e.operating_point.omega / test::two_pi, 1e-15));
    CHECK(e.operating_point.fold_offset ==
          test::relative(test::boundary_reference::fold_offset_upper / reference::omega, 2e-2));
    CHECK(std::abs(e.value(Quantity::peak_force) - reference::peak_force) < 6e-11);
    CHECK(std::abs(e.value(Quantity::amplitude) - reference::amplitude) < 6e-11);
    // At the edge itself the fold beside it lies below: two motions stand there, the free one touching.
    CHECK(e.status == EvaluationStatus::not_unique);
    CHECK(e.uniqueness.verdict == Verdict::not_unique);
    const std::array<std::array<double, 3>, 3> known = {reference::d_gap, reference::d_stiffness, reference::d_phi_pp};
    for (std::size_t i = 0; i < 3; ++i) {
        CAPTURE(i);
        // About six digits; the last entry of d_stiffness has four.
        CHECK(e.gradients.edge_omega[i] == test::relative(known[i][0], 1e-5));
        CHECK(e.gradients.omega[i] == e.gradients.edge_omega[i]);
        CHECK(gradient(e, Quantity::peak_force, i) == test::relative(known[i][1], 1e-5));
        CHECK(gradient(e, Quantity::amplitude, i) == test::relative(known[i][2], i == 1 ? 1e-3 : 1e-5));
    }
    CHECK(e.gradients.edge_omega[1] == 0.0);
}

TEST_CASE("the tables at the edge, to all digits given") {
    const design::Problem problem = nondimensional(0.0);
    // One unit of the last digit given: where two integrators of this program agree to 1e-10, three entries of the
    // tables are 0.5 to 0.7 units away.
    for (const auto& [gap, force] : reference::peak_force_vs_gap) {
        CAPTURE(gap);
        const Evaluation e = evaluate(problem, {{percuss::model::membrane::key::nd_gap, gap}});
        CHECK(e.operating_point.edge_kind == EdgeKind::grazing);
        CHECK(std::abs(e.value(Quantity::peak_force) - force) < 1e-5);
    }
    for (const auto& [voltage, omega, force] : reference::vs_phi_pp) {
        CAPTURE(voltage);
        const Evaluation e = evaluate(problem, {{percuss::model::membrane::key::nd_voltage, voltage}});
        CHECK(std::abs(e.operating_point.edge_omega - omega) < 1e-6);
        CHECK(std::abs(e.value(Quantity::peak_force) - force) < 1e-5);
    }
    for (const auto& [stiffness, force] : reference::peak_force_vs_k) {
        CAPTURE(stiffness);
        const Evaluation e = evaluate(problem, {{percuss::model::membrane::key::nd_stiffness, stiffness}});
        CHECK(std::abs(e.operating_point.edge_omega - reference::omega) < 6e-12);  // does not move with k
        CHECK(std::abs(e.value(Quantity::peak_force) - force) < 1e-5);
    }
    // Eight layers (the paper's figure 9): 12.169, more than twice the force of one.
    CHECK(std::abs(evaluate(problem, {{percuss::model::membrane::key::nd_layers, 8.0}}).value(Quantity::peak_force) -
                   12.169) < 6e-4);
    // A stronger damper or another stiffness leaves the edge where it is.
    const Evaluation damped = evaluate(problem, {{percuss::model::membrane::key::nd_damping, 20.0}});
    CHECK(std::abs(damped.operating_point.edge_omega - reference::omega) < 6e-12);
}

TEST_CASE("one per cent below the edge the defaults are alone, by tier 1") {
    const Evaluation e = evaluate(nondimensional());
    CHECK(e.status == EvaluationStatus::ok);
    CHECK(e.reason.empty());
    CHECK(e.operating_point.omega == test::relative(0.99 * reference::omega, 1e-11));
    CHECK(e.uniqueness.tier == 1);
    CHECK(e.uniqueness.verdict == Verdict::unique);
    CHECK(e.uniqueness.attractors.empty());
    CHECK(e.orbit.period == 1);
    CHECK(e.orbit.contacts == 1);
    CHECK(e.value(Quantity::contacts) == 1.0);
    CHECK(e.orbit.residual < 1e-12);
    CHECK(e.value(Quantity::max_multiplier) < 1.0);
    CHECK(e.value(Quantity::max_multiplier) == test::relative(std::abs(e.orbit.multipliers[0]), 1e-12));
    CHECK(e.value(Quantity::amplitude) == test::relative(0.5 * (e.orbit.x_max - e.orbit.x_min), 1e-14));
    CHECK(e.periods > 10.0);
    // Without the check nothing is claimed.
    design::Problem unchecked = nondimensional();
    unchecked.single_stable = design::SingleStable::off;
    const Evaluation off = evaluate(unchecked);
    CHECK(off.status == EvaluationStatus::ok);
    CHECK(off.uniqueness.verdict == Verdict::not_checked);
    CHECK(off.value(Quantity::peak_force) == test::relative(e.value(Quantity::peak_force), 1e-12));
}

TEST_CASE("the same actuator in SI units is the nondimensional one times its scales") {
    const design::Problem si = test::shipped_problem("wu2022-actuator").design;
    const model::Scaled scaled = model::scale(si.actuator);
    const Evaluation e = evaluate(si);
    REQUIRE(e.status == EvaluationStatus::ok);
    design::Problem plain = nondimensional();
    constexpr std::array keys = {
        percuss::model::membrane::key::nd_lambda_p,  percuss::model::membrane::key::nd_mu_ratio,
        percuss::model::membrane::key::nd_alpha_a,   percuss::model::membrane::key::nd_alpha_b,
        percuss::model::membrane::key::nd_delta_a,   percuss::model::membrane::key::nd_delta_b,
        percuss::model::membrane::key::nd_length,    percuss::model::membrane::key::nd_gap,
        percuss::model::membrane::key::nd_stiffness, percuss::model::membrane::key::nd_damping,
        percuss::model::membrane::key::nd_voltage,   percuss::model::membrane::key::nd_layers};
    for (std::size_t i = 0; i < keys.size(); ++i) { plain.actuator.set(keys[i], scaled.parameters[i]); }
    const Evaluation n = evaluate(plain);
    REQUIRE(n.status == EvaluationStatus::ok);
    const model::Scales& s = scaled.scales;
    const auto same = [&](Quantity q, double scale) {
        CAPTURE(design::quantity_info(q).name);
        CHECK(e.value(q) == test::relative(n.value(q) * scale, 1e-11));
    };
    same(Quantity::peak_force, s.force);
    same(Quantity::amplitude, s.length);
    same(Quantity::drive_frequency, 1.0 / s.time);
    same(Quantity::impact_velocity, s.length / s.time);
    same(Quantity::contact_time, s.time);
    same(Quantity::impulse, s.force * s.time);
    same(Quantity::stop_work, s.force * s.length);
    same(Quantity::rig_force, s.force);
    same(Quantity::max_multiplier, 1.0);
    CHECK(e.operating_point.omega == test::relative(n.operating_point.omega, 1e-12));
    // Figure 8b: 51.9 N/mm, between 1.6 kV (0.29 N) and 3.7 kV (1.68 N).
    CHECK(e.value(Quantity::peak_force) > 0.29);
    CHECK(e.value(Quantity::peak_force) < 1.68);
    for (const auto& [voltage, force] : {std::pair{1600.0, 0.29}, std::pair{3700.0, 1.68}}) {
        // Two digits given, at the edge itself.
        design::Problem at_edge = si;
        at_edge.margin = 0.0;
        CHECK(std::abs(evaluate(at_edge, {{percuss::model::membrane::key::drive_voltage, voltage}})
                           .value(Quantity::peak_force) -
                       force) < 0.006);
    }
    // electric_field, drive_current and apparent_power, which the nondimensional problem does not have: against the
    // motion sampled in SI.
    const auto integrator = test::membranes();
    flow::ParameterVector p = scaled.parameters;
    p[model::membrane::omega] = e.operating_point.omega;
    flow::Request request;
    for (std::size_t k = 0; k < 4; ++k) { request.state[k] = n.orbit.state[k]; }
    const double thickness = si.actuator.value(percuss::model::membrane::key::membrane_thickness);
    const double stretch = si.actuator.value(percuss::model::membrane::key::prestretch);
    const double permittivity =
        8.8541878128e-12 * si.actuator.value(percuss::model::membrane::key::relative_permittivity);
    const double area =
        std::numbers::pi * (std::pow(si.actuator.value(percuss::model::membrane::key::outer_radius), 2) -
                            std::pow(si.actuator.value(percuss::model::membrane::key::inner_radius), 2));
    constexpr int samples = 4000;
    double field = 0.0;
    double current = 0.0;
    std::array<double, 2> last_charge{};
    request.duration = test::two_pi / samples;
    for (int i = 0; i <= samples; ++i) {
        const double theta = i * test::two_pi / samples;
        for (int side = 0; side < 2; ++side) {
            const double u = request.state[0] - (side == 0 ? 0.0 : p[model::membrane::length]);
            const double lambda_1 = stretch * std::sqrt(1.0 + u * u);
            const double swing = side == 0 ? -std::cos(theta) : std::cos(theta);
            const double volts = 0.5 * si.actuator.value(percuss::model::membrane::key::drive_voltage) * (1.0 + swing);
            field = std::max(field, volts * lambda_1 * stretch / thickness);
            const double capacitance =
                permittivity * area / (stretch * stretch) * std::pow(lambda_1 * stretch, 2) / thickness;
            const double charge = capacitance * volts * si.actuator.value(percuss::model::membrane::key::layers);
            const double seconds = test::two_pi / samples / p[model::membrane::omega] * s.time;
            if (i > 0) { current = std::max(current, std::abs(charge - last_charge[at(side)]) / seconds); }
            last_charge[at(side)] = charge;
        }
        request.theta = theta;
        request.state = test::run(*integrator, p, request).state;
    }
    // Sampling a maximum 4000 times per period: (pi/4000)^2/2; a difference quotient instead of the current likewise,
    // except right after the impact, where the current jumps.
    CHECK(e.value(*design::find_quantity("electric_field")) == test::relative(field, 1e-6));
    CHECK(e.value(*design::find_quantity("electric_field")) >= field * (1.0 - 1e-12));
    CHECK(e.value(*design::find_quantity("drive_current")) == test::relative(current, 2e-3));
    CHECK(e.value(*design::find_quantity("apparent_power")) ==
          test::relative(e.value(*design::find_quantity("drive_current")) *
                             si.actuator.value(percuss::model::membrane::key::drive_voltage),
                         1e-14));
}

TEST_CASE("misuse is refused") {
    const design::Problem problem = nondimensional();
    const design::Evaluator evaluator(problem);
    const Demand demand = everything(problem.actuator);
    CHECK_THROWS_AS(evaluator.orbit(problem.actuator, std::nullopt, 1, demand), std::invalid_argument);  // no frequency
    const Specification given = changed(problem.actuator, {{percuss::model::membrane::key::nd_omega, 1.9}});
    CHECK_THROWS_AS(evaluator.orbit(given, std::vector<double>{0.4, 0.0}, 1, demand), std::invalid_argument);
    CHECK_THROWS_AS(evaluator.orbit(given, std::vector<double>{0.4, 0.0, -1.0, 1.2}, 1, demand), std::invalid_argument);
    CHECK_THROWS_AS(evaluator.orbit(given, std::vector<double>{0.4, std::nan(""), 1.2, 1.2}, 1, demand),
                    std::invalid_argument);
    CHECK_THROWS_AS(evaluator.orbit(given, std::nullopt, 0, demand), std::invalid_argument);
    CHECK_THROWS_AS(
        evaluator.evaluate(changed(problem.actuator, {{percuss::model::membrane::key::nd_gap, -0.1}}), demand),
        std::invalid_argument);
    CHECK_THROWS_AS(
        evaluator.evaluate(changed(problem.actuator, {{percuss::model::membrane::key::nd_gap, std::nan("")}}), demand),
        std::invalid_argument);
    design::Problem bad = problem;
    bad.margin = -0.01;
    CHECK_THROWS_AS(design::Evaluator{bad}, std::invalid_argument);
    bad = problem;
    bad.limits.push_back({*design::find_quantity("electric_field"), true, 1.0, "electric_field <= 1"});
    CHECK_THROWS_AS(design::Evaluator{bad}, std::invalid_argument);  // not in a nondimensional problem
    bad = problem;
    bad.solver.tolerance = 0.0;
    CHECK_THROWS_AS(design::Evaluator{bad}, std::invalid_argument);
    bad = problem;
    bad.actuator.law = model::ContactLaw::none;
    CHECK_THROWS_AS(evaluate(bad), std::invalid_argument);  // no edge without a stop
}

TEST_CASE("taylor, erk and cvode agree on the orbit at omega = 1.9") {
    design::Problem problem = nondimensional();
    const Specification spec = changed(problem.actuator, {{percuss::model::membrane::key::nd_omega, 1.9}});
    const std::vector<double> start(test::reference_orbits[0].state.begin(), test::reference_orbits[0].state.end());
    Demand demand = everything(spec);
    demand.gradients = {percuss::model::membrane::key::nd_gap, percuss::model::membrane::key::nd_stiffness,
                        percuss::model::membrane::key::nd_voltage, percuss::model::membrane::key::nd_omega};
    const Evaluation taylor = design::Evaluator(problem).orbit(spec, start, 1, demand);
    REQUIRE(taylor.status == EvaluationStatus::ok);
    for (const std::string integrator : {"erk", "cvode"}) {
        CAPTURE(integrator);
        problem.solver.integrator = integrator;
        problem.solver.tolerance = integrator == "erk" ? 1e-12 : 1e-13;  // cvode's errors are a hundred tolerances
        const Evaluation other = design::Evaluator(problem).orbit(spec, start, 1, demand);
        REQUIRE(other.status == EvaluationStatus::ok);
        for (std::size_t k = 0; k < 4; ++k) { CHECK(std::abs(other.orbit.state[k] - taylor.orbit.state[k]) < 1e-8); }
        for (const Quantity q : demand.quantities) {
            CAPTURE(design::quantity_info(q).name);
            CHECK(other.value(q) == test::relative(taylor.value(q), 1e-8));
            if (!design::quantity_info(q).smooth) { continue; }
            for (std::size_t i = 0; i < demand.gradients.size(); ++i) {
                CAPTURE(model::key_info(demand.gradients[i]).name);
                // Gradients of the multiplier are differences of monodromy matrices.
                const double scale = std::abs(taylor.value(q)) / std::abs(spec.value(demand.gradients[i]));
                CHECK(std::abs(gradient(other, q, i) - gradient(taylor, q, i)) <
                      1e-6 * (std::abs(gradient(taylor, q, i)) + 0.1 * scale));
            }
        }
    }
}

TEST_CASE("error estimates cover the true errors, for several designs and tolerances") {
    struct Case {
        std::string name;
        std::string file;
        Changes changes;
    };
    const std::vector<Case> cases = {
        {"defaults", "wu2022-nondimensional", {}},
        {"four layers",
         "wu2022-nondimensional",
         {{percuss::model::membrane::key::nd_layers, 4.0}, {percuss::model::membrane::key::nd_voltage, 0.5}}},
        {"stiff", "wu2022-nondimensional", {{percuss::model::membrane::key::nd_stiffness, 25000.0}}},
        {"actuator", "wu2022-actuator", {}},
        {"soft actuator",
         "wu2022-actuator",
         {{percuss::model::membrane::key::layers, 3.0}, {Key::stop_stiffness, 10e3}}},
        {"spring", "soft-impact", {{Key::stop_damping, 0.3}}}};
    double largest_ratio = 0.0;
    for (const Case& c : cases) {
        CAPTURE(c.name);
        design::Problem problem = test::shipped_problem(c.file).design;
        const Specification spec = changed(problem.actuator, c.changes);
        Demand demand = everything(spec);
        demand.error_estimates = true;
        problem.solver.tolerance = 1e-16;
        const Evaluation truth = design::Evaluator(problem).evaluate(spec, demand);
        REQUIRE(truth.status == EvaluationStatus::ok);
        for (const double tolerance : {1e-6, 1e-8, 1e-10, 1e-13}) {
            CAPTURE(tolerance);
            problem.solver.tolerance = tolerance;
            const Evaluation e = design::Evaluator(problem).evaluate(spec, demand);
            REQUIRE(e.status == EvaluationStatus::ok);
            for (const Quantity q : demand.quantities) {
                CAPTURE(design::quantity_info(q).name);
                const double estimate = e.error_estimates[static_cast<std::size_t>(q)];
                const double error = std::abs(e.value(q) - truth.value(q));
                CAPTURE(error);
                CAPTURE(estimate);
                CHECK(estimate >= 0.0);
                // The truth itself carries rounding, amplified by 1/(1 - multiplier) and the stop's stiffness.
                const double floor = 1e-12 * std::abs(truth.value(q));
                CHECK(error <= 10.0 * estimate + floor);
                if (error > floor) { largest_ratio = std::max(largest_ratio, error / estimate); }
                // Nor is it a number that says nothing.
                CHECK(estimate < 1e4 * tolerance * std::abs(truth.value(q)) + floor);
            }
        }
    }
    MESSAGE("largest true error over estimate ", largest_ratio);
}

TEST_CASE("only what was asked for is there, and the same design gives the same bits") {
    const design::Problem problem = nondimensional();
    const design::Evaluator evaluator(problem);
    Demand demand;
    demand.quantities = {Quantity::peak_force};
    const Evaluation one = evaluator.evaluate(demand);
    CHECK(std::isnan(one.value(Quantity::amplitude)));
    CHECK(std::isnan(one.error_estimates[static_cast<std::size_t>(Quantity::peak_force)]));
    const Evaluation two = evaluator.evaluate(demand);
    CHECK(one.value(Quantity::peak_force) == two.value(Quantity::peak_force));
    CHECK(one.orbit.state == two.orbit.state);
    // Gradients asked along with it do not change the value beyond rounding.
    demand.gradients = {percuss::model::membrane::key::nd_gap};
    CHECK(evaluator.evaluate(demand).value(Quantity::peak_force) ==
          test::relative(one.value(Quantity::peak_force), 1e-12));
    CHECK(Evaluation{}.status == EvaluationStatus::not_run);
}
