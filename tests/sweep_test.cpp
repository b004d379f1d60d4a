#include "design/integrators.hpp"
#include "memory_table.hpp"
#include "orbit/frequency_sweep.hpp"
#include "orbit/polish.hpp"
#include "program_run.hpp"
#include "reference_values.hpp"
#include "shipped_problem.hpp"
#include "verbs/sweep/sweep_findings.hpp"

#include <doctest/doctest.h>
#include <nlohmann/json.hpp>

#include <bit>
#include <cmath>

using namespace percuss;
using verbs::SweepDirection;
using verbs::SweepPoint;

namespace {

/// A shipped problem ready to integrate.
struct Bench {
    verbs::StudyProblem problem;
    design::Scene scene;
    flow::System system;
    explicit Bench(const std::string& name)
        : problem(test::shipped_problem(name)),
          scene(make_integrators(problem.design)) {
        system = {scene.own.get(), model::scale(problem.design.actuator).parameters, nullptr};
    }
    [[nodiscard]] flow::State rest() const { return scene.own->rest_state(system.parameters); }
};

verbs::SweepOptions paper_range(int steps = 180) {
    verbs::SweepOptions study;
    study.from = 1.2;
    study.to = 3.0;
    study.steps = steps;
    return study;
}

verbs::SweepResult swept(const verbs::SweepOptions& study, int jobs = 1, results::RowSink* rows = nullptr) {
    verbs::StudyProblem problem = test::shipped_problem("wu2022-nondimensional");
    problem.jobs = jobs;
    return verbs::run_sweep(problem, study, rows, {}, {});
}

const SweepPoint& at(const SweepDirection& direction, double omega) {
    for (const SweepPoint& point : direction.points) {
        if (std::abs(point.omega - omega) < 1e-9) { return point; }
    }
    throw std::out_of_range("no such frequency");
}

bool between(double value, double a, double b) { return value >= std::min(a, b) && value <= std::max(a, b); }

/// A settled motion of one cycle whose amplitude and force are given.
SweepPoint point(double omega, double amplitude, double force, int contacts) {
    SweepPoint p;
    p.omega = omega;
    p.settled = true;
    p.period = 1;
    p.amplitude = p.x_max = amplitude;
    p.x_min = -amplitude;
    p.peak_force = force;
    p.contacts = contacts;
    return p;
}

}  // namespace

TEST_CASE("settling stops at the distance from the orbit that it states") {
    const Bench bench("wu2022-nondimensional");
    for (const auto& reference : {test::reference_orbits[0], test::reference_orbits[4]}) {  // at 1.9 and at 3.0
        const flow::System here = bench.system.at_omega(reference.omega);
        const auto settled = orbit::settle_until_repeating(here, bench.rest(), {});
        CAPTURE(reference.name);
        REQUIRE(settled.settled);
        CHECK(settled.period == 1);
        CHECK(settled.cycles < 300);
        const double error = orbit::relative_distance(here, settled.state, reference.state);
        CHECK(settled.remaining_error <= 1e-8);
        CHECK(error == doctest::Approx(settled.remaining_error).epsilon(1e-3));
        CHECK(settled.contraction == doctest::Approx(reference.max_multiplier).epsilon(1e-4));

        // The rule usual in practice stops further away than it says.
        orbit::SettlingOptions usual;
        usual.rule = orbit::SettlingRule::strobed_change;
        usual.tolerance = 1e-6;
        const auto loose = orbit::settle_until_repeating(here, bench.rest(), usual);
        REQUIRE(loose.settled);
        CHECK(loose.change <= 1e-6);
        if (reference.omega == 1.9) { CHECK(orbit::relative_distance(here, loose.state, reference.state) > 5e-6); }
    }
}

TEST_CASE("periods: a subharmonic, a spiral that is none, a motion that never repeats, a motion that is lost") {
    const Bench bench("wu2022-nondimensional");
    const auto& third = test::reference_orbits[5];
    flow::State near = third.state;
    near[0] += 1e-5;
    const auto subharmonic = orbit::settle_until_repeating(bench.system.at_omega(third.omega), near, {});
    REQUIRE(subharmonic.settled);
    CHECK(subharmonic.period == 3);

    const auto restless = orbit::settle_until_repeating(bench.system.at_omega(1.70), bench.rest(), {});
    CHECK_FALSE(restless.settled);
    CHECK(restless.period == 0);
    CHECK(restless.cycles == 500);

    // On an unstable orbit the strobed state repeats too, for a while.
    const auto& unstable = test::reference_orbits[2];
    const auto left = orbit::settle_until_repeating(bench.system.at_omega(unstable.omega), unstable.state, {});
    REQUIRE(left.settled);
    CHECK(left.contraction < 1.0);
    CHECK(orbit::relative_distance(bench.system, left.state, unstable.state) > 1e-2);

    // Lightly damped: the motion spirals in and comes near to where it was p cycles ago for various p.
    const Bench soft("soft-impact");
    std::vector<double> omegas;
    for (int i = 0; i <= 38; ++i) { omegas.push_back(0.92 + 0.01 * i); }
    for (const auto& swept : orbit::step_sweep(soft.system, omegas, soft.rest(), {})) {
        CAPTURE(swept.omega);
        CHECK(swept.settling.settled);
        CHECK(swept.settling.period == 1);
        CHECK(swept.extremes.contacts == (swept.omega > test::soft_impact::grazing_lower ? 1 : 0));
    }

    orbit::SettlingOptions impatient;
    impatient.max_events = 0;
    const std::vector<double> two = {1.9, 2.0};
    const auto lost = orbit::step_sweep(bench.system, two, bench.rest(), impatient);
    REQUIRE(lost.size() == 1);
    CHECK(lost[0].settling.status == flow::Status::too_many_events);
    CHECK_FALSE(lost[0].settling.settled);

    orbit::SettlingOptions wrong;
    wrong.longest_period = 13;
    CHECK_THROWS_AS(orbit::settle_until_repeating(bench.system, bench.rest(), wrong), std::invalid_argument);
    wrong = {};
    wrong.tolerance = std::nan("");
    CHECK_THROWS_AS(orbit::settle_until_repeating(bench.system, bench.rest(), wrong), std::invalid_argument);
}

TEST_CASE("the paper's sweep jumps at the edges and lies on the exact orbits") {
    const Bench bench("wu2022-nondimensional");
    const auto result = swept(paper_range());
    REQUIRE(result.ending == verbs::Ending::verified);
    REQUIRE(result.directions.size() == 2);

    for (const SweepDirection& direction : result.directions) {
        const double edge = direction.forward ? test::boundary_reference::fold_upper
                                              : test::boundary_reference::fold_near_grazing_upper;
        CAPTURE(direction.forward);
        REQUIRE(direction.points.size() == 181);
        int found = 0;
        for (const verbs::SweepJump& jump : direction.jumps) {
            const SweepPoint& before = direction.points[jump.before];
            const SweepPoint& after = direction.points[jump.after];
            if (before.omega < 1.8) { continue; }  // the cascade
            ++found;
            CHECK(between(edge, before.omega, after.omega));
            CHECK(jump.contacts);
            CHECK(jump.peak_force);
            CHECK(before.contacts == (direction.forward ? 1 : 0));
        }
        CHECK(found == 1);
        CHECK(direction.points.front().omega == (direction.forward ? 1.2 : 3.0));
        CHECK(direction.points.back().omega == (direction.forward ? 3.0 : 1.2));

        for (std::size_t i = 0; i < direction.points.size(); i += 7) {
            const SweepPoint& p = direction.points[i];
            if (!p.settled) { continue; }
            CAPTURE(p.omega);
            const flow::System here = bench.system.at_omega(p.omega);
            flow::State state{};
            std::copy(p.state.begin(), p.state.end(), state.begin());
            const orbit::Orbit exact = orbit::polish_orbit(here, state, p.period);
            REQUIRE(exact.ok());
            CHECK(orbit::relative_distance(here, state, orbit::state_at_zero(here, exact)) < 1e-7);
            CHECK(orbit::max_multiplier(exact) < 1.0);
            CHECK(static_cast<int>(exact.contacts.size()) == p.contacts);
        }
    }
    // Independent numbers: the motion each direction is on at 2.2, and the common one at 1.9.
    const auto compare_with = [&](const SweepPoint& p, const test::ReferenceOrbit& reference) {
        CAPTURE(reference.name);
        CHECK(p.settled);
        CHECK(p.contacts == reference.contacts);
        CHECK(p.peak_force == doctest::Approx(reference.peak_force).epsilon(1e-6));
        CHECK(p.amplitude == doctest::Approx(reference.amplitude).epsilon(1e-6));
        for (std::size_t k = 0; k < 4; ++k) { CHECK(std::abs(p.state[k] - reference.state[k]) < 1e-7); }
    };
    compare_with(at(result.directions[0], 2.2), test::reference_orbits[1]);
    compare_with(at(result.directions[1], 2.2), test::reference_orbits[3]);
    compare_with(at(result.directions[0], 1.9), test::reference_orbits[0]);
    compare_with(at(result.directions[1], 1.9), test::reference_orbits[0]);

    const verbs::SweepComparison& comparison = result.comparison;
    CHECK_FALSE(comparison.coincide());
    REQUIRE(comparison.ranges.size() == 1);
    CHECK(comparison.ranges[0].first == doctest::Approx(1.94));
    CHECK(comparison.ranges[0].second == doctest::Approx(2.58));
}

TEST_CASE("without the stop both directions coincide") {
    verbs::StudyProblem problem = test::shipped_problem("wu2022-nondimensional");
    problem.design.actuator.law = model::StopLaw::none;
    const auto result = verbs::run_sweep(problem, paper_range(60), nullptr, {}, {});
    REQUIRE(result.ending == verbs::Ending::verified);
    CHECK(result.comparison.coincide());
    CHECK(result.comparison.compared == 61);
    CHECK(result.directions[0].jumps.empty());
    CHECK(result.directions[1].jumps.empty());
}

TEST_CASE("two threads give the same bits, and a stopped sweep keeps what it has") {
    test::MemoryTable one;
    test::MemoryTable two;
    const auto alone = swept(paper_range(40), 1, &one);
    const auto shared = swept(paper_range(40), 2, &two);
    REQUIRE(one.rows().size() == 82);
    REQUIRE(two.rows().size() == one.rows().size());
    for (std::size_t i = 0; i < one.rows().size(); ++i) {
        for (std::size_t k = 0; k < one.rows()[i].size(); ++k) {
            CHECK(std::bit_cast<std::uint64_t>(one.rows()[i][k]) == std::bit_cast<std::uint64_t>(two.rows()[i][k]));
        }
    }
    CHECK(one.at(0, "direction") == 1.0);
    CHECK(one.at(81, "direction") == -1.0);
    CHECK(alone.directions[1].periods == shared.directions[1].periods);

    int asked = 0;
    test::MemoryTable kept;
    const auto stopped = verbs::run_sweep(test::shipped_problem("wu2022-nondimensional"), paper_range(40), &kept, {},
                                          [&] { return ++asked >= 5; });
    CHECK(stopped.ending == verbs::Ending::interrupted);
    CHECK(stopped.directions[0].points.size() == 5);
    CHECK(kept.rows().size() == 6);  // the other direction ends after its first point
}

TEST_CASE("a chirp has a constant rate in time and jumps a little late") {
    verbs::SweepOptions study = paper_range();
    study.mode = verbs::SweepMode::chirp;
    study.chirp_cycles = 4000;
    const auto result = swept(study);
    REQUIRE(result.ending == verbs::Ending::verified);
    const auto& forward = result.directions[0].points;
    REQUIRE(forward.size() == 4000);
    CHECK(forward.front().omega > 1.2);
    CHECK(forward.front().omega < 1.201);
    CHECK(forward.back().omega < 3.0);
    // d(omega)/d(tau) = (change over a cycle)/(its duration)
    const auto rate = [&](std::size_t k) {
        const double middle = 0.5 * (forward[k].omega + forward[k + 1].omega);
        return (forward[k + 1].omega - forward[k].omega) * middle;
    };
    CHECK(rate(3000) == doctest::Approx(rate(10)).epsilon(1e-9));

    const auto last_jump = [&](const SweepDirection& direction, bool from_above) {
        const verbs::SweepJump jump = from_above ? direction.jumps.front() : direction.jumps.back();
        return direction.points[jump.after].omega;
    };
    REQUIRE_FALSE(result.directions[0].jumps.empty());
    REQUIRE_FALSE(result.directions[1].jumps.empty());
    const double up = last_jump(result.directions[0], false);
    CHECK(up > test::boundary_reference::fold_upper);
    CHECK(up < test::boundary_reference::fold_upper + 0.03);
    const double down = last_jump(result.directions[1], true);
    CHECK(std::abs(down - test::boundary_reference::grazing_upper) < 0.003);
}

TEST_CASE("findings on made-up sweeps") {
    std::vector<SweepPoint> line;
    for (int i = 0; i < 10; ++i) { line.push_back(point(1.0 + 0.1 * i, 1.0 + 0.01 * i, 0.0, 0)); }
    CHECK(verbs::find_jumps(line).empty());
    auto broken = line;
    for (std::size_t i = 6; i < 10; ++i) { broken[i].amplitude += 0.5; }
    auto jumps = verbs::find_jumps(broken);
    REQUIRE(jumps.size() == 1);
    CHECK(jumps[0].before == 5);
    CHECK(jumps[0].amplitude);
    CHECK_FALSE(jumps[0].peak_force);
    auto doubled = line;
    for (std::size_t i = 3; i < 10; ++i) { doubled[i].period = 2; }
    jumps = verbs::find_jumps(doubled);
    REQUIRE(jumps.size() == 1);
    CHECK(jumps[0].period);
    CHECK_FALSE(jumps[0].contacts);

    auto back = line;
    std::reverse(back.begin(), back.end());
    CHECK(verbs::compare(line, back, 1e-8).coincide());
    back[2].peak_force = 1.0;
    back[3].settled = false;
    const auto comparison = verbs::compare(line, back, 1e-8);
    CHECK(comparison.different == 1);
    CHECK(comparison.unsettled == 1);
    CHECK(comparison.compared == 9);
    REQUIRE(comparison.ranges.size() == 1);
    CHECK(comparison.ranges[0].first == line[7].omega);
    CHECK(comparison.ranges[0].second == line[7].omega);
    CHECK_FALSE(verbs::compare(line, {}, 1e-8).coincide());
}

namespace program {
using namespace percuss::tests;

TEST_CASE("the program sweeps, with units, and without an edge when there is no stop") {
    const ScratchFolder folder;
    const Outcome si = run(folder, {"sweep", shipped("wu2022-actuator.ini"), "--from", "60 Hz", "--to", "0.08 kHz",
                                    "--steps", "20", "--json", "--jobs", "2"});
    CAPTURE(si.err);
    REQUIRE(si.exit_code == 0);
    const auto document = nlohmann::json::parse(si.out);
    CHECK(document.at("schema") == "percuss/sweep/1");
    CHECK(document.at("units") == "si");
    CHECK(document.at("from").at("drive_frequency").get<double>() == doctest::Approx(60.0));
    CHECK(document.at("directions").at(1).at("points").at(0).at("drive_frequency").get<double>() ==
          doctest::Approx(80.0));
    CHECK(document.at("comparison").at("coincide") == false);
    const auto results = folder.path() / "results" / "wu2022-actuator-sweep";
    const std::string table = read_file(results / "sweep.csv");
    CHECK(table.starts_with("omega,drive_frequency [Hz],direction,cycles,settled,period,strobed_change,"
                            "remaining_error,amplitude [m],x_max [m],x_min [m],peak_force [N],contacts,x [m],"));
    CHECK(lines(table) == 43);
    CHECK(read_file(results / "result.json") == si.out);

    const Outcome free = run(folder, {"sweep", shipped("wu2022-nondimensional.ini"), "--stop.law", "none", "--steps",
                                      "10", "--out", "none"});
    CHECK(free.exit_code == 0);
    CHECK(has(free.out, "coincide at all 11"));
    const Outcome duffing =
        run(folder, {"sweep", shipped("duffing.ini"), "--from", "0.9 rad/s", "--to", "1.4 rad/s", "--out", "none"});
    CHECK(duffing.exit_code == 0);
    CHECK(has(duffing.out, "differ at 43 of 141"));  // between the folds at 1.1157 and 1.2696
    const Outcome chirp =
        run(folder, {"sweep", shipped("duffing.ini"), "--chirp", "--sweep.chirp_cycles", "30", "--out", "here"});
    CHECK(chirp.exit_code == 0);
    CHECK(lines(read_file(folder.path() / "here" / "sweep.csv")) == 61);
}

TEST_CASE("a sweep cut short keeps its points; bad input is told") {
    const struct {
        std::string prefix;
        std::vector<std::string> options;
        int exit_code;
    } cuts[] = {{"", {"--time-limit", "0.3"}, 4}, {"timeout --preserve-status --signal=INT 1", {}, 130}};
    for (const auto& cut : cuts) {
        const ScratchFolder folder;
        std::vector<std::string> arguments = {
            "sweep", shipped("wu2022-nondimensional.ini"), "--steps", "100000", "--out", "here"};
        arguments.insert(arguments.end(), cut.options.begin(), cut.options.end());
        const Outcome outcome = run(folder, arguments, cut.prefix);
        CAPTURE(outcome.err);
        CHECK(outcome.exit_code == cut.exit_code);
        CHECK(lines(read_file(folder.path() / "here" / "sweep.csv")) > 10);
        CHECK(has(outcome.out, "status: stopped"));
    }

    const struct {
        std::vector<std::string> options;
        std::string part;
    } cases[] = {
        {{"--from", "0"}, "--sweep.from '0': must be above 0"},
        {{"--from", "60 Hz"}, "--sweep.from '60 Hz'"},
        {{"--from", "nan"}, "--sweep.from 'nan'"},
        {{"--from", "3", "--to", "2"}, "--sweep.to '2': must be above sweep.from"},
        {{"--from", "50"}, "sweep.from"},
        {{"--steps", "0"}, "--sweep.steps '0': must be a whole number, at least 1"},
        {{"--sweep.mode", "stairs"}, "steps | chirp"},
        {{"--sweep.longest_period", "13"}, "at most 12"},
        {{"--sweep.tolerance", "1e-13"}, "--sweep.tolerance"},
        {{"--cycles", "5"}, "unknown option --cycles"},
    };
    for (const auto& each : cases) {
        const ScratchFolder folder;
        std::vector<std::string> arguments = {"sweep", shipped("wu2022-nondimensional.ini")};
        arguments.insert(arguments.end(), each.options.begin(), each.options.end());
        const Outcome outcome = run(folder, arguments);
        CAPTURE(each.part);
        CAPTURE(outcome.err);
        CHECK(outcome.exit_code == 2);
        CHECK(lines(outcome.err) == 1);
        CHECK(has(outcome.err, each.part));
        CHECK_FALSE(std::filesystem::exists(folder.path() / "results" / "wu2022-nondimensional-sweep"));
    }
}

}  // namespace program
