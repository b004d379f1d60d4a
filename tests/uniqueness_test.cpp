#include "design/evaluate.hpp"
#include "design/integrators.hpp"
#include "design/window.hpp"
#include "design_cases.hpp"
#include "model/membrane/membrane.hpp"
#include "orbit/polish.hpp"
#include "relative.hpp"
#include "verbs/optimise/optimise.hpp"

#include <cmath>
#include <numbers>

#include <doctest/doctest.h>

using namespace percuss;
using design::Evaluation;
using design::EvaluationStatus;
using design::Quantity;
using design::Verdict;
using model::Key;
using std::numbers::pi;
using test::changed;
using test::nondimensional;

namespace {

design::Problem sampled(long starts = 512) {
    design::Problem problem = nondimensional();
    problem.single_stable = design::SingleStable::sampled;
    problem.sampling.starts = starts;
    return problem;
}

/// The period-3 motion at omega = 1.78 (reference orbit of independent programs).
orbit::Orbit period_three(const flow::System& system) {
    return orbit::polish_orbit(system, {0.29736803916883, 0.00169336011957, 1.18102762349808, 1.19292177583379}, 3);
}

}  // namespace

TEST_CASE("tier 2: the defaults are not refuted one per cent below the edge, and the bound says how sure that is") {
    const Evaluation e = test::evaluate(sampled());
    CHECK(e.status == EvaluationStatus::ok);
    CHECK(e.uniqueness.tier == 2);
    CHECK(e.uniqueness.verdict == Verdict::unique);
    CHECK(e.uniqueness.starts == 512);
    CHECK(e.uniqueness.missed_share_bound == test::relative(1.0 - std::pow(0.05, 1.0 / 512.0), 1e-12));
    CHECK(e.uniqueness.attractors.empty());
}

TEST_CASE("tier 2: at omega = 1.78 two longer motions refute the period-1 motion, and are named with their shares") {
    const Evaluation e = test::evaluate(sampled(), {{percuss::model::membrane::key::nd_omega, 1.78}});
    CHECK(e.status == EvaluationStatus::not_unique);
    CHECK(e.uniqueness.verdict == Verdict::not_unique);
    REQUIRE(e.uniqueness.attractors.size() == 2);
    double shares = 0.0;
    for (const design::Attractor& other : e.uniqueness.attractors) {
        shares += other.share;
        if (other.period == 3) {
            CHECK(other.peak_force == test::relative(5.40627738, 1e-8));
            CHECK(other.max_multiplier == test::relative(0.67176820, 1e-7));
        } else {
            CHECK(other.period == 4);
            CHECK(other.peak_force > 5.5);
        }
    }
    CHECK(shares > 0.5);
    CHECK(shares < 0.75);
    // Tier 1 does not see them.
    design::Problem orbit_only = nondimensional();
    CHECK(test::evaluate(orbit_only, {{percuss::model::membrane::key::nd_omega, 1.78}}).status == EvaluationStatus::ok);
}

TEST_CASE("the window of the period-3 motion, carried to another design, is the one found there, with its gradient") {
    const design::Problem problem = nondimensional();
    const design::Evaluator evaluator(problem);
    const model::Specification home = changed(problem.actuator, {{percuss::model::membrane::key::nd_omega, 1.78}});
    const flow::System system = evaluator.system(home);
    const orbit::Orbit orbit = period_three(system);
    REQUIRE(orbit.ok());
    const design::Intruder intruder = design::find_window(system, home, orbit);
    REQUIRE(intruder.ok);
    CHECK(intruder.period == 3);
    CHECK(intruder.lowest.omega == test::relative(1.7525492452, 1e-9));
    CHECK(intruder.highest.omega == test::relative(1.8613474958, 1e-9));
    // A grazing point beside a fold stands for it.
    CHECK(intruder.lower.kind == boundary::Kind::grazing);
    CHECK(intruder.upper.kind == boundary::Kind::grazing);
    CHECK(intruder.upper.omega == test::relative(1.8613422725, 1e-9));

    const std::vector<Key> keys = {percuss::model::membrane::key::nd_gap, percuss::model::membrane::key::nd_stiffness,
                                   percuss::model::membrane::key::nd_voltage};
    const design::WindowAt here = design::window_at(system, intruder, home, keys);
    REQUIRE(here.status == design::WindowAt::Status::found);
    CHECK(here.lower == test::relative(intruder.lower.omega, 1e-11));
    for (std::size_t k = 0; k < keys.size(); ++k) {
        CAPTURE(model::key_info(keys[k]).name);
        const double value = home.value(keys[k]);
        const double h = 1e-4 * value;
        const auto at = [&](double v) {
            const model::Specification there = changed(home, {{keys[k], v}});
            return design::window_at(evaluator.system(there), intruder, there, {});
        };
        const design::WindowAt up = at(value + h);
        const design::WindowAt down = at(value - h);
        REQUIRE(up.status == design::WindowAt::Status::found);
        REQUIRE(down.status == design::WindowAt::Status::found);
        CHECK(here.d_lower[k] == test::relative((up.lower - down.lower) / (2.0 * h), 1e-5));
        CHECK(here.d_upper[k] == test::relative((up.upper - down.upper) / (2.0 * h), 1e-5));
    }

    const model::Specification away = changed(home, {{percuss::model::membrane::key::nd_gap, 0.11}});
    const design::WindowAt carried = design::window_at(evaluator.system(away), intruder, away, {});
    REQUIRE(carried.status == design::WindowAt::Status::found);
    CHECK(carried.lower < carried.upper);
    // Found afresh at the middle of the window there.
    const double middle = 0.5 * (carried.lower + carried.upper);
    design::Problem look = sampled(256);
    const Evaluation e = test::evaluate(
        look, {{percuss::model::membrane::key::nd_gap, 0.11}, {percuss::model::membrane::key::nd_omega, middle}});
    const auto is_three = [](const design::Attractor& a) { return a.period == 3; };
    const auto three = std::find_if(e.uniqueness.attractors.begin(), e.uniqueness.attractors.end(), is_three);
    REQUIRE(three != e.uniqueness.attractors.end());
    const design::Intruder afresh = design::find_window(evaluator, away, middle, {*three});
    REQUIRE(afresh.ok);
    CHECK(carried.lower == test::relative(afresh.lower.omega, 1e-9));
    CHECK(carried.upper == test::relative(afresh.upper.omega, 1e-9));
}

TEST_CASE("the band in which the defaults are alone lies between the period-3 motion and the edge") {
    const design::Problem problem = sampled(128);
    design::Demand demand;
    demand.quantities = {Quantity::peak_force, Quantity::band_lower, Quantity::band_upper};
    demand.gradients = {percuss::model::membrane::key::nd_gap, percuss::model::membrane::key::nd_voltage};
    demand.error_estimates = true;
    const design::Evaluator evaluator(problem);
    const Evaluation e = evaluator.evaluate(demand);
    REQUIRE(e.status == EvaluationStatus::ok);
    CHECK(2.0 * pi * e.value(Quantity::band_lower) == test::relative(1.8613474958, 1e-9));
    CHECK(2.0 * pi * e.value(Quantity::band_upper) == test::relative(1.93541550079, 1e-9));
    for (const Quantity q : {Quantity::band_lower, Quantity::band_upper}) {
        const auto& gradient = e.gradients.quantity[static_cast<std::size_t>(q)];
        REQUIRE(gradient.size() == 2);
        for (std::size_t k = 0; k < 2; ++k) {
            const double value = problem.actuator.value(demand.gradients[k]);
            const double h = 1e-4 * value;
            const auto at = [&](double v) {
                design::Demand plain;
                plain.quantities = demand.quantities;
                return evaluator.evaluate(changed(problem.actuator, {{demand.gradients[k], v}}), plain).value(q);
            };
            CHECK(gradient[k] == test::relative((at(value + h) - at(value - h)) / (2.0 * h), 1e-5));
        }
    }
}

TEST_CASE("tier 1 alone puts the lower end of the band at the flip of the motion itself") {
    design::Demand demand;
    demand.quantities = {Quantity::band_lower, Quantity::band_upper};
    const Evaluation e = design::Evaluator(nondimensional()).evaluate(demand);
    CHECK(2.0 * pi * e.value(Quantity::band_lower) == test::relative(1.745872449920, 1e-9));
    CHECK(2.0 * pi * e.value(Quantity::band_upper) == test::relative(1.93541550079, 1e-9));
}

TEST_CASE("tier 3: the low-loss design is moved away from the motion that refutes it, at a price") {
    verbs::StudyProblem problem = test::shipped_problem("low-loss");
    problem.optimiser.samples = 8;
    problem.optimiser.starts = 1;
    problem.design.sampling.starts = 256;

    problem.design.single_stable = design::SingleStable::sampled;
    const auto refuted = verbs::run_optimise(problem, nullptr, {}, {});
    CHECK(refuted.status == verbs::OptimiseStatus::not_certified);
    CHECK(refuted.ending == verbs::Ending::not_certified);
    REQUIRE(refuted.counterexamples.size() == 1);
    CHECK(refuted.counterexamples[0].period == 4);
    CHECK(refuted.best.uniqueness.verdict == Verdict::not_unique);

    problem.design.single_stable = design::SingleStable::refuted;
    const auto alone = verbs::run_optimise(problem, nullptr, {}, {});
    CHECK(alone.status == verbs::OptimiseStatus::optimal);
    CHECK(alone.best.uniqueness.verdict == Verdict::unique);
    CHECK(alone.best.uniqueness.tier == 2);
    CHECK(alone.kkt_residual < 1e-6);
    REQUIRE_FALSE(alone.counterexamples.empty());
    CHECK(alone.objective_unrefuted == test::relative(15.8863, 1e-4));
    const double force = alone.best.value(Quantity::peak_force);
    CHECK(force < alone.objective_unrefuted);
    CHECK(force == test::relative(15.4960, 1e-4));
    const auto window = std::find_if(alone.limits.begin(), alone.limits.end(),
                                     [](const verbs::LimitReport& limit) { return limit.name == "omega"; });
    REQUIRE(window != alone.limits.end());
    CHECK(window->active);
    CHECK(window->multiplier > 0.0);
}
