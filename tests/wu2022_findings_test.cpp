// The findings of C. Wu, A. Cai, X. Gao, C. Cao, Appl. Syst. Innov. 2022, 5, 122, in the paper's own words, each row by
// the problem file of its figure.

#include "design_cases.hpp"
#include "model/membrane/membrane.hpp"
#include "reference_values.hpp"
#include "relative.hpp"
#include "verbs/branch/branch.hpp"
#include "verbs/locus/locus.hpp"
#include "verbs/sweep/sweep.hpp"

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

using namespace percuss;
using design::EdgeKind;
using design::Evaluation;
using design::EvaluationStatus;
using design::Quantity;
using model::Key;
namespace reference = test::edge_reference;

namespace {

design::Problem figure(int number) { return test::shipped_problem("wu2022-fig" + std::to_string(number)).design; }

/// The key at each value, at the edge itself; what it finds there is an orbit that strikes.
std::vector<Evaluation> row(int number, Key key, const std::vector<double>& values) {
    const design::Problem problem = figure(number);
    REQUIRE(problem.margin == 0.0);
    std::vector<Evaluation> found;
    for (double value : values) {
        CAPTURE(value);
        found.push_back(test::evaluate(problem, {{key, value}}));
        REQUIRE(found.back().operating_point.edge_kind == EdgeKind::grazing);
        REQUIRE(found.back().orbit.contacts == 1);
    }
    return found;
}

double edge(const Evaluation& e) { return e.operating_point.edge_omega; }
double force(const Evaluation& e) { return e.value(Quantity::peak_force); }
double amplitude(const Evaluation& e) { return e.value(Quantity::amplitude); }

}  // namespace

TEST_CASE("figure 6a: without the stop both sweeps are one curve") {
    verbs::StudyProblem problem = test::shipped_problem("wu2022-fig6");
    problem.design.actuator.law = model::StopLaw::none;
    const verbs::SweepResult sweep = verbs::run_sweep(problem, {.from = 1.2, .to = 3.0, .steps = 45}, nullptr, {}, {});
    CHECK(sweep.ending == verbs::Ending::verified);
    CHECK(sweep.comparison.compared == 46);
    CHECK(sweep.comparison.coincide());
    CHECK(sweep.comparison.largest < 1e-6);
}

TEST_CASE("figure 6b: forward the resonance lies far above the backward one") {
    const verbs::StudyProblem problem = test::shipped_problem("wu2022-fig6");
    // Beside the edge few states lead to the weak motion: already steps of 0.02 throw it off at 1.94.
    const verbs::SweepResult sweep = verbs::run_sweep(problem, {.from = 1.9, .to = 2.6, .steps = 70}, nullptr, {}, {});
    REQUIRE(sweep.directions.size() == 2);
    const double jump[] = {test::boundary_reference::fold_upper, test::boundary_reference::grazing_upper};
    for (std::size_t i = 0; i < 2; ++i) {
        CAPTURE(i);
        const verbs::SweepDirection& direction = sweep.directions[i];
        REQUIRE(direction.jumps.size() == 1);
        const double before = direction.points[direction.jumps[0].before].omega;
        const double after = direction.points[direction.jumps[0].after].omega;
        CHECK(direction.jumps[0].discontinuous());
        CHECK((before - jump[i]) * (after - jump[i]) < 0.0);
        CHECK(std::abs(after - before) == test::relative(0.01, 1e-9));
    }
    // Solved for, in place of swept.
    const Evaluation backward = test::evaluate(figure(6));
    CHECK(std::abs(edge(backward) - test::boundary_reference::grazing_upper) < 6e-12);
    verbs::BranchOptions range;
    range.from = 4.0;
    range.to = 1.2;
    const verbs::BranchResult branch = verbs::run_branch(problem, range, {}, {});
    REQUIRE(branch.branches.size() == 1);
    double highest_fold = 0.0;
    for (const branch::BoundaryPoint& b : branch.branches[0].boundaries) {
        if (b.kind == boundary::Kind::fold) { highest_fold = std::max(highest_fold, b.point.parameter); }
    }
    CHECK(std::abs(highest_fold - test::boundary_reference::fold_upper) < 1e-11);
}

TEST_CASE("figure 7: below a voltage of about 0.2 nothing strikes, above it edge and force grow") {
    for (double voltage : {0.19, 0.195}) {
        const Evaluation e = test::evaluate(figure(7), {{percuss::model::membrane::key::nd_voltage, voltage}});
        CHECK(e.status == EvaluationStatus::no_impact);
        CHECK(e.operating_point.edge_kind == EdgeKind::none);
    }
    std::vector<double> voltages;
    for (int i = 20; i <= 50; i += 2) { voltages.push_back(0.01 * i); }
    const auto found = row(7, percuss::model::membrane::key::nd_voltage, voltages);
    for (std::size_t i = 1; i < found.size(); ++i) {
        CAPTURE(voltages[i]);
        CHECK(edge(found[i]) > edge(found[i - 1]));
        CHECK(force(found[i]) > force(found[i - 1]));
    }
    for (const auto& [voltage, omega, known] : reference::vs_phi_pp) {
        CAPTURE(voltage);
        const auto e = row(7, percuss::model::membrane::key::nd_voltage, {voltage}).front();
        CHECK(std::abs(edge(e) - omega) < 1e-6);
        CHECK(std::abs(force(e) - known) < 1e-5);
    }
}

TEST_CASE("figure 7: the edge followed through the onset and on to the lower end of the impacts") {
    for (double from : {0.5, 0.4}) {
        CAPTURE(from);
        const verbs::LocusResult locus = verbs::run_locus(
            test::shipped_problem("wu2022-fig7"),
            {.kind = boundary::Kind::grazing, .along = Key::nd_voltage, .from = from, .to = 0.19}, {}, {});
        REQUIRE(locus.curves.size() == 1);  // one curve: both grazing points it could begin with are on it
        const branch::Locus& curve = locus.curves[0];
        CHECK(curve.end == branch::End::range);
        REQUIRE(curve.turns.size() == 1);
        CHECK(curve.turns[0].value > 0.195);
        CHECK(curve.turns[0].value < 0.2);
        // The frequency falls all the way, and at the defaults the curve passes both grazing points.
        int met = 0;
        for (std::size_t i = 0; i < curve.points.size(); ++i) {
            CAPTURE(i);
            const branch::LocusPoint& p = curve.points[i];
            if (i > 0) { CHECK(p.omega < curve.points[i - 1].omega); }
            if (std::abs(p.value - 0.4) > 1e-12) { continue; }
            const bool upper = p.omega > curve.turns[0].omega;
            CHECK(std::abs(p.omega - (upper ? test::boundary_reference::grazing_upper
                                            : test::boundary_reference::grazing_lower)) < 6e-12);
            ++met;
        }
        CHECK(met == 2);
    }
}

TEST_CASE("figure 9: edge and force grow with the layers, the amplitude hardly changes") {
    const auto found = row(9, percuss::model::membrane::key::nd_layers, {1, 2, 3, 4, 5, 6, 7, 8});
    for (std::size_t i = 1; i < found.size(); ++i) {
        CAPTURE(i);
        CHECK(edge(found[i]) > edge(found[i - 1]));
        CHECK(force(found[i]) > force(found[i - 1]));
        CHECK(amplitude(found[i]) == test::relative(amplitude(found[0]), 0.011));
    }
    CHECK(std::abs(force(found[7]) - 12.169) < 6e-4);
    CHECK(std::abs(force(found[7]) / force(found[0]) - 2.317) < 6e-4);
}

TEST_CASE("figure 11: the edge falls with the gap, the force drops and stays") {
    std::vector<double> gaps = {0.02};
    for (int i = 4; i <= 20; i += 2) { gaps.push_back(0.01 * i); }
    const auto found = row(11, percuss::model::membrane::key::nd_gap, gaps);
    for (std::size_t i = 1; i < found.size(); ++i) {
        CAPTURE(gaps[i]);
        CHECK(edge(found[i]) < edge(found[i - 1]));
        CHECK(force(found[i]) > 5.0);
        CHECK(force(found[i]) < 5.3);
    }
    CHECK(force(found[0]) - force(found[1]) > 1.0);
    for (const auto& [gap, known] : reference::peak_force_vs_gap) {
        CAPTURE(gap);
        CHECK(std::abs(force(row(11, percuss::model::membrane::key::nd_gap, {gap}).front()) - known) < 1e-5);
    }
}

TEST_CASE("figure 13: the edge does not move with the stiffness, the force grows more than tenfold") {
    const auto found =
        row(13, percuss::model::membrane::key::nd_stiffness, {100, 250, 500, 1000, 2500, 5000, 10000, 25000});
    for (std::size_t i = 0; i < found.size(); ++i) {
        CAPTURE(i);
        CHECK(std::abs(edge(found[i]) - reference::omega) < 6e-12);
        if (i > 0) { CHECK(force(found[i]) > force(found[i - 1])); }
    }
    CHECK(std::abs(force(found.front()) - 1.2252) < 6e-5);
    CHECK(std::abs(force(found.back()) - 16.160) < 6e-4);
    CHECK(force(found.back()) / force(found.front()) > 10.0);
}

TEST_CASE("figures 8, 10, 12, 14: the measured trends in SI units") {
    const std::vector<double> volts = {1600, 1900, 2200, 2500, 2800, 3100, 3400, 3700};
    const double ends[2][2] = {{0.16, 0.85}, {0.29, 1.68}};
    for (std::size_t stop = 0; stop < 2; ++stop) {
        CAPTURE(stop);
        design::Problem problem = figure(8);
        problem.actuator.set(Key::stop_stiffness, stop == 0 ? 10.6e3 : 51.9e3);
        std::vector<double> forces;
        for (double v : volts) {
            forces.push_back(force(test::evaluate(problem, {{percuss::model::membrane::key::drive_voltage, v}})));
        }
        CHECK(std::abs(forces.front() - ends[stop][0]) < 6e-3);
        CHECK(std::abs(forces.back() - ends[stop][1]) < 6e-3);
        for (std::size_t i = 1; i < forces.size(); ++i) { CHECK(forces[i] > forces[i - 1]); }
    }
    const auto layers = row(10, percuss::model::membrane::key::layers, {1, 2, 3});
    CHECK(force(layers[1]) > force(layers[0]));
    CHECK(force(layers[2]) > force(layers[1]));
    const auto gaps = row(12, Key::stop_gap, {0.4e-3, 0.8e-3, 1.2e-3, 1.6e-3});
    for (std::size_t i = 1; i < gaps.size(); ++i) {
        const double slope = (amplitude(gaps[i]) - amplitude(gaps[i - 1])) / 0.4e-3;
        CHECK(slope == test::relative(0.98, 0.02));
    }
    const auto stiffnesses = row(14, Key::stop_stiffness, {10.6e3, 51.9e3, 100e3, 200.3e3});
    for (std::size_t i = 1; i < stiffnesses.size(); ++i) {
        CHECK(edge(stiffnesses[i]) == test::relative(edge(stiffnesses[0]), 1e-11));
        CHECK(force(stiffnesses[i]) > force(stiffnesses[i - 1]));
    }
}
