// Branches of periodic motions: the hysteresis map of the defaults, published oscillators, isolas, branches along a
// design variable.

#include "branch/corner.hpp"
#include "branch/switching.hpp"
#include "branch/trace.hpp"
#include "engine_cases.hpp"
#include "model/membrane/membrane.hpp"
#include "model/spring/spring.hpp"
#include "orbit/polish.hpp"
#include "relative.hpp"
#include "shipped_problem.hpp"
#include "verbs/branch/branch.hpp"
#include "verbs/orbit/orbit.hpp"

#include <doctest/doctest.h>

#include <cmath>
#include <string>
#include <vector>

using namespace percuss;
using boundary::Kind;
using branch::BoundaryPoint;
using branch::Branch;
using branch::End;
using branch::Point;
using model::Key;
using test::at;
using test::relative;
namespace reference = test::boundary_reference;

namespace {

verbs::StudyProblem paper() { return test::shipped_problem("wu2022-nondimensional"); }

verbs::BranchResult map_of(const verbs::StudyProblem& problem, const verbs::BranchOptions& study) {
    return verbs::run_branch(problem, study, {}, {});
}

verbs::BranchResult map_of(const verbs::StudyProblem& problem, double from, double to) {
    verbs::BranchOptions study;
    study.from = from;
    study.to = to;
    return map_of(problem, study);
}

std::vector<Kind> kinds(const Branch& branch) {
    std::vector<Kind> all;
    for (const BoundaryPoint& found : branch.boundaries) { all.push_back(found.kind); }
    return all;
}

const BoundaryPoint& nearest(const Branch& branch, Kind kind, double parameter) {
    const BoundaryPoint* best = nullptr;
    for (const BoundaryPoint& found : branch.boundaries) {
        if (found.kind != kind) { continue; }
        if (best == nullptr ||
            std::abs(found.point.parameter - parameter) < std::abs(best->point.parameter - parameter)) {
            best = &found;
        }
    }
    REQUIRE(best != nullptr);
    return *best;
}

/// What must hold on every branch: stability changes only at boundaries, the parameter turns only at folds, the points
/// close and have as many contacts as their form says.
void check_consistency(const Branch& branch) {
    const auto& points = branch.points;
    std::vector<int> crossings(points.size(), 0);
    std::vector<int> folds(points.size(), 0);
    for (const BoundaryPoint& found : branch.boundaries) {
        REQUIRE(found.after < points.size());
        CHECK(found.uncertainty <= 1e-10 * std::abs(found.point.parameter));
        crossings[found.after] += found.kind == Kind::grazing ? 0 : 1;
        folds[found.after] += found.kind == Kind::fold ? 1 : 0;
    }
    int turns = 0;
    for (std::size_t i = 0; i + 1 < points.size(); ++i) {
        CAPTURE(i);
        CAPTURE(points[i].parameter);
        // A grazing point is a point of the branch, and its own stability that of either side.
        const bool corner = crossings[i] > 0 || (i > 0 && crossings[i - 1] > 0) || crossings[i + 1] > 0;
        if (points[i].stable() != points[i + 1].stable()) { CHECK(corner); }
        if (i > 0) {
            const double before = points[i].parameter - points[i - 1].parameter;
            const double after = points[i + 1].parameter - points[i].parameter;
            turns += before * after < 0.0 ? 1 : 0;
        }
        CHECK(std::isfinite(points[i].peak_force));
        CHECK(points[i].x_max > points[i].x_min);
        CHECK((points[i].peak_force > 0.0) == !points[i].contacts.empty());
    }
    int all = 0;
    for (const int count : folds) { all += count; }
    CHECK(turns == all);
}

/// Every point is a periodic orbit: solved again stroboscopically it stays where it is.
void check_orbits(const flow::ParameterFamily& family, const Branch& branch, std::size_t stride) {
    for (std::size_t i = 0; i < branch.points.size(); i += stride) {
        const Point& point = branch.points[i];
        CAPTURE(point.parameter);
        const flow::System system = family.at(point.parameter);
        orbit::ReturnMap map;
        map.phase = point.phase;
        map.period = branch.period;
        const orbit::Orbit orbit = orbit::find_orbit(system, map, point.state);
        REQUIRE(orbit.ok());
        CHECK(test::distance(orbit.state, point.state, system.states()) < 1e-9);
        CHECK(orbit.contacts.size() == point.contacts.size());
        // At grazing the multipliers jump.
        if (!point.contacts.empty() && std::abs(point.contacts[0].state_in[1]) < 1e-3) { continue; }
        CHECK(orbit::max_multiplier(orbit) == relative(point.max_multiplier(), 1e-6));
    }
}

}  // namespace

TEST_CASE("the hysteresis map of the defaults: one branch through both grazing points") {
    const auto result = map_of(paper(), 4.0, 1.2);
    CHECK(result.ending == verbs::Ending::verified);
    REQUIRE(result.branches.size() == 1);
    const Branch& main = result.branches.front();
    CHECK(main.end == End::range);
    CHECK(main.points.front().parameter == relative(4.0, 1e-15));
    CHECK(main.points.back().parameter == relative(1.2, 1e-15));
    CHECK(result.solves < 400);
    CHECK(result.periods < 400.0);
    check_consistency(main);

    REQUIRE(kinds(main) ==
            std::vector<Kind>{Kind::grazing, Kind::fold, Kind::fold, Kind::flip, Kind::flip, Kind::grazing});
    const auto& found = main.boundaries;
    CHECK(std::abs(found[0].point.omega - reference::grazing_upper) < 6e-12);  // eleven decimals given
    const double offset = found[0].point.omega - found[1].point.omega;
    CHECK(offset == relative(reference::fold_offset_upper, 2e-3));
    CHECK(std::abs(found[1].point.omega - reference::fold_near_grazing_upper) < 6e-12);
    CHECK(found[0].partner == 1);  // one physical jump
    CHECK(found[1].partner == 0);
    CHECK(std::abs(found[2].point.omega - reference::fold_upper) < 1e-11);
    CHECK(found[2].point.peak_force == relative(reference::fold_upper_peak_force, 1e-10));
    CHECK(found[2].partner == -1);
    CHECK(std::abs(found[3].point.omega - reference::flip) < 1e-11);
    CHECK(std::abs(found[5].point.omega - reference::grazing_lower) < 1e-11);
    CHECK(found[5].partner == -1);
    CHECK(found[2].point.contacts.size() == 1);
    CHECK_FALSE(found[3].of_half_cycle);

    // Between the folds three motions at one frequency, as known.
    int met = 0;
    for (std::size_t i = 0; i + 1 < main.points.size(); ++i) {
        met += (main.points[i].omega - 2.2) * (main.points[i + 1].omega - 2.2) < 0.0 ? 1 : 0;
    }
    CHECK(met == 3);
}

TEST_CASE("the same map the other way round, and without the stop") {
    for (const auto law : {model::StopLaw::kelvin_voigt, model::StopLaw::no_tension}) {
        verbs::StudyProblem problem = paper();
        problem.design.actuator.law = law;
        const auto down = map_of(problem, 4.0, 1.2);
        const auto up = map_of(problem, 1.2, 4.0);
        const Branch& a = down.branches.at(0);
        const Branch& b = up.branches.at(0);
        check_consistency(a);
        check_consistency(b);
        REQUIRE(a.boundaries.size() == b.boundaries.size());
        for (std::size_t i = 0; i < a.boundaries.size(); ++i) {
            const BoundaryPoint& there = b.boundaries[a.boundaries.size() - 1 - i];
            CHECK(a.boundaries[i].kind == there.kind);
            CHECK(a.boundaries[i].point.omega == relative(there.point.omega, 1e-11));
        }
        // Against a stop that cannot pull the branch turns back at the upper grazing point at once.
        CHECK(a.boundaries[0].partner == 1);
        CHECK(a.boundaries[0].point.omega == relative(reference::grazing_upper, 6e-12));
    }
    verbs::StudyProblem free = paper();
    free.design.actuator.law = model::StopLaw::none;
    const auto alone = map_of(free, 4.0, 1.2);
    CHECK(alone.ending == verbs::Ending::verified);
    CHECK(alone.branches.at(0).boundaries.empty());
    for (const Point& p : alone.branches.at(0).points) { CHECK(p.stable()); }
}

TEST_CASE("points of the branch are the known orbits") {
    const auto integrator = test::membranes();
    const flow::System base{integrator.get(), test::paper_defaults, nullptr};
    const flow::ParameterFamily family =
        flow::along_frequency(base, integrator->linear_resonance(test::paper_defaults));
    const test::ReferenceOrbit& start = test::reference_orbits[4];  // clear of the stop at 3.0
    const flow::System there = base.at_omega(start.omega);
    branch::Departure departure;
    departure.motion = orbit::motion_of(there, orbit::polish_orbit(there, start.state, 1));
    departure.parameter = start.omega;
    departure.direction = -1.0;
    branch::TraceOptions options;
    options.from = 3.0;
    options.to = 1.6;
    const Branch branch = branch::trace(family, departure, options);
    REQUIRE(branch.end == End::range);
    check_consistency(branch);
    check_orbits(family, branch, 3);
    for (const int which : {0, 1, 2, 3}) {
        const test::ReferenceOrbit& known = test::reference_orbits[at(which)];
        CAPTURE(known.name);
        const flow::System system = base.at_omega(known.omega);
        const orbit::Motion motion = orbit::motion_of(system, orbit::polish_orbit(system, known.state, 1));
        const branch::Look seen = branch::look(family, motion, known.omega);
        REQUIRE(seen.ok());
        CHECK(seen.point.peak_force == doctest::Approx(known.peak_force).epsilon(1e-9));
        CHECK(seen.point.amplitude() == relative(known.amplitude, 1e-10));
        CHECK(std::abs(seen.point.max_multiplier() - known.max_multiplier) < 2.0 * known.max_multiplier_error);
        CHECK(test::distance(branch::state_at_zero(system, seen.point), known.state, 4) < 3e-12);
        CHECK(branch::passes_through(family, branch, seen.point, options.size));
    }
    // So are motions beside a grazing point, in either form, and between a fold and the points next to it.
    for (const double omega : {reference::grazing_upper + 1e-3, reference::grazing_upper + 1e-6}) {
        const flow::System clear = base.at_omega(omega);
        const auto settled = orbit::settle(clear, integrator->rest_state(clear.parameters), 60, flow::StopMode::off);
        orbit::Motion motion;
        motion.state = settled.value();
        const auto free = orbit::solve(clear, motion);
        REQUIRE(free.has_value());
        const branch::Look seen = branch::look(family, *free, omega);
        REQUIRE(seen.ok());
        CHECK(branch::passes_through(family, branch, seen.point, options.size));
    }
    const BoundaryPoint& tip = nearest(branch, Kind::fold, reference::fold_upper);
    for (const Point* side : {&branch.points[tip.after], &branch.points[tip.after + 1]}) {
        const double omega = side->omega + 0.9 * (tip.point.omega - side->omega);
        const numerics::Vector from = orbit::pack(base, tip.point.motion);
        const numerics::Vector to = orbit::pack(base, side->motion);
        const auto near =
            orbit::solve(base.at_omega(omega), orbit::unpack(base, from + std::sqrt(0.1) * (to - from), side->motion));
        REQUIRE(near.has_value());
        const branch::Look seen = branch::look(family, *near, omega);
        REQUIRE(seen.ok());
        CHECK(branch::passes_through(family, branch, seen.point, options.size));
    }
    // The motion of three cycles is on no branch of one.
    const test::ReferenceOrbit& third = test::reference_orbits[5];
    const flow::System system = base.at_omega(third.omega);
    const orbit::Motion motion = orbit::motion_of(system, orbit::polish_orbit(system, third.state, 3));
    const branch::Look seen = branch::look(family, motion, third.omega);
    REQUIRE(seen.ok());
    CHECK_FALSE(branch::passes_through(family, branch, seen.point, options.size));
}

TEST_CASE("published oscillators") {
    const auto duffing = verbs::run_branch(test::shipped_problem("duffing"), {}, {}, {});
    const Branch& cubic = duffing.branches.at(0);
    CHECK(duffing.ending == verbs::Ending::verified);
    check_consistency(cubic);
    REQUIRE(kinds(cubic) == std::vector<Kind>{Kind::fold, Kind::fold});
    CHECK(std::abs(nearest(cubic, Kind::fold, 1.1).point.omega - 1.11570025177) < 6e-12);
    CHECK(std::abs(nearest(cubic, Kind::fold, 1.3).point.omega - 1.26960195555) < 6e-12);

    const auto soft = verbs::run_branch(test::shipped_problem("soft-impact"), {}, {}, {});
    const Branch& bilinear = soft.branches.at(0);
    CHECK(soft.ending == verbs::Ending::verified);
    check_consistency(bilinear);
    REQUIRE(kinds(bilinear) == std::vector<Kind>{Kind::grazing, Kind::fold, Kind::fold, Kind::grazing});
    namespace known = test::soft_impact;
    CHECK(std::abs(bilinear.boundaries[0].point.omega - known::grazing_upper) < 1e-12);
    CHECK(std::abs(bilinear.boundaries[1].point.omega - known::fold_near_grazing) < 6e-12);
    CHECK(bilinear.boundaries[1].partner == 0);
    const BoundaryPoint& upper = bilinear.boundaries[2];
    CHECK(std::abs(upper.point.omega - known::fold_upper) < 6e-10);
    CHECK(std::abs(upper.point.motion.sequence.contacts.at(0).duration / upper.point.omega -
                   known::fold_upper_contact_time) < 6e-9);
    CHECK(std::abs(bilinear.boundaries[3].point.omega - known::grazing_lower) < 1e-12);
}

TEST_CASE("a stop that cannot pull grazes where the free motion does") {
    // Designs in which the release without force has a second root, at a negative duration.
    verbs::StudyProblem problem = paper();
    model::Specification& spec = problem.design.actuator;
    spec.set(percuss::model::membrane::key::nd_stiffness, 70220.0);
    spec.set(percuss::model::membrane::key::nd_gap, 0.0319);
    spec.set(percuss::model::membrane::key::nd_voltage, 0.2246);
    spec.set(percuss::model::membrane::key::nd_layers, 6.0);
    spec.set(percuss::model::membrane::key::nd_delta_a, 0.02335);
    spec.set(percuss::model::membrane::key::nd_delta_b, 5.248);
    spec.set(percuss::model::membrane::key::nd_damping, 19.65);
    std::vector<double> lower;
    std::vector<double> upper;
    for (const auto law : {model::ContactLaw::kelvin_voigt, model::ContactLaw::no_tension}) {
        spec.law = law;
        const auto result = verbs::run_branch(problem, {}, {}, {});
        CHECK(result.ending == verbs::Ending::verified);
        lower.push_back(nearest(result.branches.at(0), Kind::grazing, 3.95).point.omega);
        upper.push_back(nearest(result.branches.at(0), Kind::grazing, 4.8).point.omega);
    }
    CHECK(lower[0] == relative(lower[1], 1e-11));
    CHECK(upper[0] == relative(upper[1], 1e-11));
}

TEST_CASE("the motion of three cycles lives on an isola") {
    const auto integrator = test::membranes();
    const flow::System base{integrator.get(), test::paper_defaults, nullptr};
    const flow::ParameterFamily family =
        flow::along_frequency(base, integrator->linear_resonance(test::paper_defaults));
    const test::ReferenceOrbit& known = test::reference_orbits[5];
    const flow::System there = base.at_omega(known.omega);
    branch::Departure departure;
    departure.motion = orbit::motion_of(there, orbit::polish_orbit(there, known.state, 3));
    departure.parameter = known.omega;
    branch::TraceOptions options;
    options.from = 1.2;
    options.to = 4.0;
    for (const double direction : {1.0, -1.0}) {
        CAPTURE(direction);
        departure.direction = direction;
        const Branch isola = branch::trace_both_ways(family, departure, options);
        CHECK(isola.period == 3);
        CHECK(isola.end == End::closed);
        CHECK(isola.points.size() < 120);
        CHECK(isola.points.back().parameter == isola.points.front().parameter);
        CHECK(isola.points.back().peak_force == isola.points.front().peak_force);
        // All the way round, whatever the place, a motion of the isola is known for one.
        for (std::size_t i = 0; i + 1 < isola.points.size(); ++i) {
            const Point& a = isola.points[i];
            const Point& b = isola.points[i + 1];
            CAPTURE(a.omega);
            CAPTURE(b.omega);
            if (a.motion.contacts() != b.motion.contacts()) { continue; }
            const double omega = 0.3 * a.omega + 0.7 * b.omega;
            const auto middle = orbit::solve(family.at(omega), a.motion);
            if (!middle) { continue; }
            const branch::Look seen = branch::look(family, *middle, omega);
            // Not one beyond grazing, which is no motion.
            if (seen.ok() && !branch::contact_leaving(*middle)) {
                CHECK(branch::passes_through(family, isola, seen.point, options.size));
            }
        }
        check_consistency(isola);
        CHECK(isola.boundaries.size() == 4);
        const BoundaryPoint& low = nearest(isola, Kind::grazing, 1.75);
        CHECK(std::abs(low.point.omega - 1.7525492493) < 6e-11);
        CHECK(nearest(isola, Kind::fold, 1.75).partner >= 0);
        CHECK(std::abs(nearest(isola, Kind::fold, 1.86).point.omega - 1.8613474958) < 6e-11);
        CHECK(std::abs(nearest(isola, Kind::grazing, 1.86).point.omega - 1.8613422725) < 6e-11);
        // Every point lies between the two ends.
        for (const Point& p : isola.points) {
            CHECK(p.omega > 1.75254924);
            CHECK(p.omega < 1.86134750);
        }
    }
}

TEST_CASE("twice the period leaves at the flip and comes back to the branch it left") {
    verbs::BranchOptions study;
    study.period = 2;
    study.starts = 0;  // no search for other motions
    study.from = 4.0;
    study.to = 1.2;
    const auto result = map_of(paper(), study);
    CHECK(result.ending == verbs::Ending::verified);
    REQUIRE(result.branches.size() == 2);
    const Branch& twice = result.branches[1];
    CHECK(twice.period == 2);
    CHECK(twice.from_branch == 0);
    CHECK(twice.end == End::joined);
    check_consistency(twice);
    for (const Point& p : twice.points) {
        CHECK(p.omega < reference::flip);
        CHECK(p.omega > reference::grazing_lower - 1e-9);
    }
    CHECK(std::abs(twice.boundaries.back().point.omega - reference::grazing_lower) < 1e-9);
}

TEST_CASE("along a design variable: an S-curve in the voltage, and orbits solved one by one") {
    verbs::StudyProblem problem = paper();
    problem.design.actuator.set(Key::nd_omega, 1.9);
    verbs::BranchOptions study;
    study.along = Key::nd_voltage;
    study.from = 0.1;
    study.to = 0.6;
    const auto result = map_of(problem, study);
    CHECK(result.ending == verbs::Ending::verified);
    CHECK_FALSE(result.along_frequency);
    const Branch& s = result.branches.at(0);
    check_consistency(s);
    CHECK(s.begin == End::range);
    CHECK(s.end == End::range);
    REQUIRE(kinds(s) == std::vector<Kind>{Kind::grazing, Kind::fold, Kind::fold});
    CHECK(s.boundaries[0].partner == 1);
    // The boundaries in the voltage at this frequency are those in the frequency at this voltage.
    for (const BoundaryPoint& found : s.boundaries) {
        CAPTURE(boundary::to_string(found.kind));
        verbs::StudyProblem there = paper();
        there.design.actuator.set(Key::nd_voltage, found.point.parameter);
        const auto across = map_of(there, 3.0, 1.7);
        CHECK(nearest(across.branches.at(0), found.kind, 1.9).point.omega == relative(1.9, 1e-10));
    }

    for (const Key key : {percuss::model::membrane::key::nd_gap, percuss::model::membrane::key::nd_stiffness,
                          percuss::model::membrane::key::nd_damping, percuss::model::membrane::key::nd_delta_b}) {
        CAPTURE(model::key_info(key).name);
        verbs::BranchOptions other;
        other.along = key;
        const double value = problem.design.actuator.value(key);
        other.from = 0.5 * value;
        other.to = 1.3 * value;
        const auto along = map_of(problem, other);
        CHECK(along.ending == verbs::Ending::verified);
        const Branch& b = along.branches.at(0);
        check_consistency(b);
        REQUIRE(b.points.size() >= 3);
        CHECK(b.points.front().parameter == relative(0.5 * value, 1e-12));
        CHECK(b.points.back().parameter == relative(1.3 * value, 1e-12));
        for (const std::size_t i : {std::size_t{0}, b.points.size() / 2, b.points.size() - 1}) {
            verbs::StudyProblem alone = problem;
            alone.design.actuator.set(key, b.points[i].parameter);
            const auto orbit = verbs::run_orbit(alone, verbs::OrbitOptions{});
            const double force = orbit.evaluation.value(design::Quantity::peak_force);
            CHECK(b.points[i].peak_force == relative(force, 1e-9));
        }
    }
}

TEST_CASE("without damping there are no torus points and no stable motions") {
    for (const char* name : {"duffing", "soft-impact"}) {
        CAPTURE(name);
        study::StudyProblem problem = test::shipped_problem(name);
        problem.design.actuator.set(Key::sm_damping, 0.0);
        study::BranchStudy study;
        study.max_points = 300;
        const Branch branch = map_of(problem, study).branches.at(0);
        CHECK(branch.neutral());
        for (const BoundaryPoint& found : branch.boundaries) { CHECK(found.kind != Kind::torus); }
        for (const Point& point : branch.points) { CHECK_FALSE(point.stable()); }
        // With damping the same motions are told.
        const Branch damped = map_of(test::shipped_problem(name), study).branches.at(0);
        CHECK_FALSE(damped.neutral());
        CHECK(damped.points.front().stable());
    }
}

TEST_CASE("far below resonance, among folds less than a step apart, near is not closed") {
    study::StudyProblem problem = test::shipped_problem("soft-impact");
    model::Specification& spec = problem.design.actuator;
    spec.set(Key::sm_mass, 5e-3);
    spec.set(Key::sm_stiffness, 1263.0);
    spec.set(Key::sm_damping, 0.05);
    spec.set(Key::sm_force, 0.2);
    spec.set(Key::stop_gap, 1e-4);
    spec.set(Key::stop_stiffness, 5e5);
    spec.set(Key::stop_damping, 0.5);
    study::BranchStudy study;
    study.from = 10.0;
    study.max_points = 400;
    // The branch sets out at an end of the range: a closed one would have had to leave it. Up to its 191st point it
    // only comes near its first.
    const auto result = map_of(problem, study);
    CHECK(result.branches.at(0).end == End::budget);
    CHECK(result.ending == study::Ending::budget);
}

TEST_CASE("what ends a branch, and what cannot be begun") {
    verbs::BranchOptions few;
    few.max_points = 10;
    const auto result = map_of(paper(), few);
    CHECK(result.ending == verbs::Ending::budget);
    CHECK(result.branches.at(0).end == End::budget);
    CHECK(result.branches.at(0).points.size() == 10);
    CHECK_FALSE(result.reason.empty());

    int asked = 0;
    const auto stopped = verbs::run_branch(paper(), {}, {}, [&] { return ++asked > 5; });
    CHECK(stopped.ending == verbs::Ending::interrupted);
    CHECK(stopped.branches.at(0).points.size() < 20);

    verbs::BranchOptions empty;
    empty.from = 2.0;
    empty.to = 2.0;
    CHECK_THROWS_AS(map_of(paper(), empty), std::invalid_argument);
    verbs::BranchOptions no_range;
    no_range.along = Key::nd_gap;
    CHECK_THROWS_AS(map_of(paper(), no_range), std::invalid_argument);
    verbs::BranchOptions foreign;
    foreign.along = Key::sm_force;
    foreign.from = 0.1;
    foreign.to = 0.2;
    CHECK_THROWS_AS(map_of(paper(), foreign), std::invalid_argument);
    CHECK(Branch{}.end == End::not_run);
    CHECK(verbs::BranchResult{}.ending == verbs::Ending::not_run);
}
