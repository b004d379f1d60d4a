// Where a design is driven: at a given frequency, the margin below its edge, or nowhere; and evaluations that end
// early.

#include "design/operating_point.hpp"

#include "design/scene.hpp"
#include "design_cases.hpp"
#include "relative.hpp"

#include <doctest/doctest.h>

#include <cmath>
#include <stdexcept>

using namespace percuss;
using design::EdgeKind;
using design::Evaluation;
using design::EvaluationStatus;
using design::Operation;
using design::OperationOptions;
using design::OperationStatus;
using design::Reached;
using model::Key;
using test::changed;
using test::nondimensional;

namespace {

/// A design with all that operate() asks for.
struct Ready {
    design::Problem problem;
    design::Scene scene = design::make_scene(problem);
    model::Scaled scaled = model::scale(problem.actuator);

    explicit Ready(const test::Changes& changes) : problem(nondimensional()) {
        problem.actuator = changed(problem.actuator, changes);
        scaled = model::scale(problem.actuator);
    }
    [[nodiscard]] Operation operate(const OperationOptions& options = {}) const {
        return design::operate({problem.actuator,
                                scaled,
                                {scene.own.get(), scaled.parameters, nullptr},
                                {scene.scout.get(), scaled.parameters, nullptr}},
                               options);
    }
};

}  // namespace

TEST_CASE("a given frequency is taken as it is") {
    const Ready ready({{Key::nd_omega, 1.9}});
    const Operation operation = ready.operate();
    REQUIRE(operation.found());
    CHECK(operation.point.omega == 1.9);
    CHECK(operation.point.edge_kind == EdgeKind::given);
    CHECK(std::isnan(operation.point.edge_omega));
    CHECK(std::isnan(operation.point.margin));
    CHECK(operation.system.omega() == 1.9);
    CHECK(operation.scout.omega() == 1.9);
    CHECK_FALSE(operation.edge);
    CHECK(operation.d_omega.empty());
    CHECK_FALSE(operation.free_orbits);
}

TEST_CASE("below an edge: the margin is kept, and the derivative of the frequency is that of the edge") {
    const Ready ready({});
    OperationOptions options;
    options.margin = 0.02;
    options.find_neighbours = true;
    const std::vector<flow::ParameterVector> directions = {
        model::scale_derivative(ready.problem.actuator, Key::nd_gap).parameters};
    options.directions = directions;
    const Operation operation = ready.operate(options);
    REQUIRE(operation.found());
    REQUIRE(operation.edge);
    CHECK(operation.point.edge_kind == EdgeKind::grazing);
    CHECK(operation.point.edge_omega == operation.edge->omega);
    CHECK(operation.point.omega == test::relative(0.98 * operation.edge->omega, 1e-15));
    CHECK(operation.system.omega() == operation.point.omega);
    CHECK(operation.fold);
    CHECK(operation.free_orbits);
    // Central difference over 2e-5 of the gap: the error of the edge (1e-12) and the curvature leave 1e-6.
    REQUIRE(operation.d_omega.size() == 1);
    const double gap = ready.problem.actuator.value(Key::nd_gap);
    const double step = 1e-5 * gap;
    const double above = Ready({{Key::nd_gap, gap + step}}).operate(options).point.omega;
    const double below = Ready({{Key::nd_gap, gap - step}}).operate(options).point.omega;
    CHECK(operation.d_omega[0] == test::relative((above - below) / (2.0 * step), 1e-6));
    // The motion there is the one that strikes.
    const Reached reached = design::reach_motion(operation);
    CHECK(reached.kind == Reached::Kind::stable);
    CHECK(reached.orbit.contacts.size() == 1);
}

TEST_CASE("no edge: a status with its reason and no frequency; without a stop there is nothing to have an edge with") {
    const Operation operation = Ready({{Key::nd_voltage, 0.195}}).operate();
    CHECK(operation.status == OperationStatus::no_impact);
    CHECK(operation.reason.find("every drive frequency") != std::string::npos);
    CHECK(std::isnan(operation.point.omega));
    CHECK_FALSE(operation.edge);

    Ready free({});
    free.problem.actuator.law = model::StopLaw::none;
    free.scene = design::make_scene(free.problem);
    CHECK_THROWS_WITH_AS((void)free.operate(), "drive.frequency = edge needs a stop: stop.law is none",
                         std::invalid_argument);
}

TEST_CASE("an evaluation that is cancelled, or spends its steps, fails and says so") {
    design::Problem problem = nondimensional();
    problem.single_stable = design::SingleStable::sampled;
    problem.sampling.starts = 256;
    const design::Evaluator evaluator(problem);
    design::Demand demand;
    demand.quantities = {design::Quantity::peak_force};
    long asked = 0;
    demand.cancelled = [&] { return ++asked > 4; };  // in the ensemble: the stages before it ask less often
    const Evaluation cancelled = evaluator.evaluate(demand);
    CHECK(cancelled.status == EvaluationStatus::failed);
    CHECK(cancelled.reason == "cancelled");
    CHECK(cancelled.uniqueness.verdict == design::Verdict::not_checked);
    demand.cancelled = [] { return true; };
    CHECK(evaluator.evaluate(demand).reason == "cancelled");
    demand.cancelled = {};
    demand.step_budget = 100;  // it takes some 2000
    const Evaluation spent = evaluator.evaluate(demand);
    CHECK(spent.status == EvaluationStatus::failed);
    CHECK(spent.reason == "the budget of 100 integration steps is spent");
    demand.step_budget = design::default_step_budget;
    const Evaluation whole = evaluator.evaluate(demand);
    CHECK(whole.status == EvaluationStatus::ok);
    CHECK(whole.steps < design::default_step_budget / 100);
}
