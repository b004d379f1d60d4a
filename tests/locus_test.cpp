// Boundaries followed in two parameters: published fold curves, the cusp where hysteresis ends, grazing and flip
// curves.

#include "design/families.hpp"
#include "engine_cases.hpp"
#include "model/membrane/membrane.hpp"
#include "model/spring/spring.hpp"
#include "relative.hpp"
#include "shipped_problem.hpp"
#include "verbs/branch/branch.hpp"
#include "verbs/locus/locus.hpp"

#include <doctest/doctest.h>

#include <cmath>
#include <vector>

using namespace percuss;
using boundary::Kind;
using branch::Locus;
using branch::LocusPoint;
using model::Key;
using test::relative;

namespace {

verbs::LocusResult follow(const verbs::StudyProblem& problem, Kind kind, Key along, double from, double to,
                          int steps = 25) {
    verbs::LocusOptions study;
    study.kind = kind;
    study.along = along;
    study.from = from;
    study.to = to;
    study.steps = steps;
    return verbs::run_locus(problem, study, {}, {});
}

/// The point of a curve at a value of the key nearest to a frequency.
const LocusPoint& at_value(const Locus& curve, double value, double omega) {
    const LocusPoint* best = nullptr;
    for (const LocusPoint& p : curve.points) {
        if (std::abs(p.value - value) > 1e-12 * std::abs(value)) { continue; }
        if (best == nullptr || std::abs(p.omega - omega) < std::abs(best->omega - omega)) { best = &p; }
    }
    REQUIRE(best != nullptr);
    return *best;
}

/// The boundary of this kind nearest to omega on the main branch.
double on_main_branch(verbs::StudyProblem problem, Kind kind, Key key, double value, double omega) {
    problem.design.actuator.set(key, value);
    verbs::BranchOptions study;
    study.from = 2.0 * omega;
    study.to = 0.6 * omega;
    const auto map = verbs::run_branch(problem, study, {}, {});
    double best = 1e300;
    for (const auto& found : map.branches.at(0).boundaries) {
        if (found.kind == kind && std::abs(found.point.omega - omega) < std::abs(best - omega)) {
            best = found.point.omega;
        }
    }
    return best;
}

}  // namespace

TEST_CASE("the published fold curve of the soft stop") {
    const auto problem = test::shipped_problem("soft-impact");
    const auto result = follow(problem, Kind::fold, Key::sm_force, test::soft_impact::parameters[3], 0.5, 35);
    CHECK(result.ending == verbs::Ending::verified);
    REQUIRE(result.curves.size() == 2);  // the fold beside grazing, and the one far up
    const Locus& upper = result.curves[1];
    CHECK(upper.turns.empty());
    for (const auto& [force, omega] : test::soft_impact::fold_curve) {
        CAPTURE(force);
        CHECK(std::abs(at_value(upper, force, omega).omega - omega) < 6e-10);  // nine decimals given
    }
    for (const Locus& curve : result.curves) {
        CHECK(curve.end == branch::End::range);
        CHECK(curve.points.front().value == relative(test::soft_impact::parameters[3], 1e-14));
        CHECK(curve.points.back().value == relative(0.5, 1e-12));
    }
    // The same in the other direction.
    const auto back = follow(problem, Kind::fold, percuss::model::spring::key::force, 0.5, 0.16, 17);
    const Locus& again = back.curves.back();
    CHECK(std::abs(at_value(again, 0.2, 1.6).omega - 1.599768196) < 6e-10);
}

TEST_CASE("both folds of the paper's actuator are one curve with a cusp, from either side") {
    const auto problem = test::shipped_problem("wu2022-nondimensional");
    const auto down = follow(problem, Kind::fold, Key::nd_voltage, 0.5, 0.15);
    CHECK(down.ending == verbs::Ending::verified);
    REQUIRE(down.curves.size() == 1);  // the second fold is the end of the first one's curve
    const Locus& curve = down.curves[0];
    CHECK(curve.end == branch::End::range);
    CHECK(curve.points.front().value == relative(0.5, 1e-14));
    CHECK(curve.points.back().value == relative(0.5, 1e-12));
    CHECK(std::abs(curve.points.front().omega - curve.points.back().omega) > 0.5);
    int cusps = 0;
    for (const auto& turn : curve.turns) { cusps += turn.cusp ? 1 : 0; }
    REQUIRE(cusps == 1);
    REQUIRE(curve.turns.size() == 1);
    const auto cusp = curve.turns[0];
    CHECK(cusp.value == doctest::Approx(0.199895).epsilon(3e-6));
    CHECK(cusp.omega == doctest::Approx(1.79879).epsilon(3e-6));
    for (const LocusPoint& p : curve.points) { CHECK(p.value > cusp.value - 1e-9); }
    // Through the known folds at phi_pp = 0.4, on both sheets.
    CHECK(std::abs(at_value(curve, 0.4, 2.6).omega - test::boundary_reference::fold_upper) < 1e-10);
    CHECK(std::abs(at_value(curve, 0.4, 1.9).omega - test::boundary_reference::fold_near_grazing_upper) < 1e-10);
    CHECK(at_value(curve, 0.4, 2.6).peak_force == relative(test::boundary_reference::fold_upper_peak_force, 1e-9));
    for (const double value : {0.3, 0.22}) {
        CAPTURE(value);
        const double omega = at_value(curve, value, 2.5).omega;
        CHECK(omega ==
              relative(on_main_branch(problem, Kind::fold, percuss::model::membrane::key::nd_voltage, value, omega),
                       1e-10));
    }

    const auto up = follow(problem, Kind::fold, percuss::model::membrane::key::nd_voltage, 0.201, 0.15);
    REQUIRE(up.curves.size() == 1);
    REQUIRE(up.curves[0].turns.size() == 1);
    CHECK(up.curves[0].turns[0].cusp);
    CHECK(up.curves[0].turns[0].value == relative(cusp.value, 1e-10));
    CHECK(up.curves[0].turns[0].omega == relative(cusp.omega, 1e-7));
    // Below the cusp nothing folds.
    const auto none = follow(problem, Kind::fold, Key::nd_voltage, 0.19, 0.15);
    CHECK(none.ending == verbs::Ending::infeasible);
    CHECK(none.curves.empty());
    CHECK_FALSE(none.reason.empty());
}

TEST_CASE("grazing and flip curves lie where the branches have them") {
    const auto problem = test::shipped_problem("wu2022-nondimensional");
    const auto grazing = follow(problem, Kind::grazing, Key::nd_gap, 0.1, 0.2, 10);
    CHECK(grazing.ending == verbs::Ending::verified);
    REQUIRE(!grazing.curves.empty());
    for (const auto& gap : {0.12, 0.15}) {
        const double omega = at_value(grazing.curves[0], gap, 1.9).omega;
        CHECK(
            omega ==
            relative(on_main_branch(problem, Kind::grazing, percuss::model::membrane::key::nd_gap, gap, omega), 1e-10));
        CHECK(at_value(grazing.curves[0], gap, 1.9).peak_force == 0.0);
    }
    // Upper and lower grazing meet where the stroke at resonance is the gap: a turn, and no cusp of folds.
    for (const auto& known : test::edge_reference::vs_phi_pp) {
        const auto voltage =
            follow(problem, Kind::grazing, percuss::model::membrane::key::nd_voltage, 0.4, known[0], 4);
        CHECK(std::abs(at_value(voltage.curves.at(0), known[0], known[1]).omega - known[1]) < 1e-6);
    }
    const auto meeting = follow(problem, Kind::grazing, percuss::model::membrane::key::nd_voltage, 0.4, 0.1, 10);
    REQUIRE(meeting.curves.size() == 1);
    REQUIRE(meeting.curves[0].turns.size() == 1);
    CHECK_FALSE(meeting.curves[0].turns[0].cusp);
    CHECK(meeting.curves[0].turns[0].value > 0.19);
    CHECK(meeting.curves[0].turns[0].value < 0.2);

    const auto flip = follow(problem, Kind::flip, percuss::model::membrane::key::nd_stiffness, 2500.0, 5000.0, 10);
    REQUIRE(!flip.curves.empty());
    const double omega = at_value(flip.curves[0], 4000.0, 1.75).omega;
    CHECK(omega ==
          relative(on_main_branch(problem, Kind::flip, percuss::model::membrane::key::nd_stiffness, 4000.0, omega),
                   1e-10));
}

TEST_CASE("a torus curve") {
    auto problem = test::shipped_problem("wu2022-nondimensional");
    model::Specification& spec = problem.design.actuator;
    spec.law = model::StopLaw::none;
    spec.set(Key::nd_voltage, 0.232);
    spec.set(Key::nd_delta_a, 0.022);
    spec.set(Key::nd_delta_b, 390.0);
    const auto torus = follow(problem, Kind::torus, Key::nd_delta_a, 0.022, 0.024, 10);
    CHECK(torus.ending == verbs::Ending::verified);
    REQUIRE(!torus.curves.empty());
    const LocusPoint& there = at_value(torus.curves[0], 0.023, 1.79);
    CHECK(there.omega ==
          relative(on_main_branch(problem, Kind::torus, percuss::model::membrane::key::nd_delta_a, 0.023, there.omega),
                   1e-9));
    CHECK(there.angle != 0.0);
}

TEST_CASE("families move their parameters as their directions say") {
    model::Specification spec = test::shipped_problem("wu2022-actuator").design.actuator;
    spec.set(Key::drive_frequency, 57.0);
    const auto integrator = test::membranes();
    const flow::System system{integrator.get(), model::scale(spec).parameters, nullptr};
    CHECK(design::frequency_family(system).at(1.7).omega() == 1.7);
    for (const Key key :
         {percuss::model::membrane::key::moving_mass, Key::stop_gap, percuss::model::membrane::key::drive_voltage,
          percuss::model::membrane::key::prestretch, percuss::model::membrane::key::outer_radius}) {
        CAPTURE(model::key_info(key).name);
        const double value = spec.value(key);
        const flow::ParameterFamily alone = design::key_family(system, spec, key, value);
        const flow::ParameterFamily both = design::frequency_and_key_family(system, spec, key, value);
        CHECK(alone.dimension() == 1);
        CHECK(both.dimension() == 2);
        CHECK(both.units[1] == value);
        const auto check = [&](const flow::ParameterFamily& family, std::vector<double> p) {
            const auto directions = family.directions(p);
            REQUIRE(directions.size() == p.size());
            for (std::size_t i = 0; i < p.size(); ++i) {
                const auto numeric = test::ridders_many(
                    [&](double amount) {
                        std::vector<double> moved = p;
                        moved[i] += amount;
                        const flow::ParameterVector parameters = family.parameters(moved);
                        return std::vector<double>(parameters.begin(), parameters.end());
                    },
                    flow::max_parameters, 1e-3 * p[i]);
                for (std::size_t k = 0; k < numeric.size(); ++k) {
                    CAPTURE(k);
                    const double scale = (std::abs(system.parameters[k]) + 1.0) / p[i];
                    CHECK(std::abs(directions[i][k] - numeric[k].value) < 1e-9 * scale);
                }
            }
        };
        check(alone, {value});
        check(both, {1.8, 1.1 * value});
        CHECK(both.at(std::vector<double>{1.8, value}).omega() == 1.8);
    }
    CHECK_THROWS_WITH_AS(design::key_family(system, spec, percuss::model::membrane::key::nd_gap, 1.0),
                         doctest::Contains("nondimensional.g"), std::invalid_argument);
    CHECK(design::is_drive_frequency(percuss::model::spring::key::omega));
    CHECK_FALSE(design::is_drive_frequency(Key::stop_gap));
}

TEST_CASE("misuse and early ends") {
    const auto problem = test::shipped_problem("wu2022-nondimensional");
    const auto run = [&](const verbs::LocusOptions& study) { return verbs::run_locus(problem, study, {}, {}); };
    verbs::LocusOptions study;
    CHECK_THROWS_WITH_AS(run(study), doctest::Contains("locus.along"), std::invalid_argument);
    study.along = percuss::model::membrane::key::nd_voltage;
    study.from = 0.3;
    CHECK_THROWS_WITH_AS(run(study), doctest::Contains("locus.to"), std::invalid_argument);
    study.to = 0.3;
    CHECK_THROWS_WITH_AS(run(study), doctest::Contains("empty"), std::invalid_argument);
    study.along = percuss::model::membrane::key::nd_omega;
    study.to = 0.4;
    CHECK_THROWS_WITH_AS(run(study), doctest::Contains("drive frequency"), std::invalid_argument);
    study.along = percuss::model::spring::key::force;
    CHECK_THROWS_WITH_AS(run(study), doctest::Contains("spring-mass.force"), std::invalid_argument);
    study.along = percuss::model::membrane::key::nd_voltage;
    study.max_points = 5;
    const auto few = run(study);
    CHECK(few.ending == verbs::Ending::budget);
    CHECK(few.curves.at(0).points.size() <= 6);
    int asked = 0;
    const auto stopped = verbs::run_locus(problem, study, {}, [&] { return ++asked > 3; });
    CHECK(stopped.ending == verbs::Ending::interrupted);
    CHECK(verbs::LocusResult{}.ending == verbs::Ending::not_run);
    CHECK(Locus{}.end == branch::End::not_run);
}
