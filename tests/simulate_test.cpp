#include "verbs/simulate/simulate.hpp"

#include "design/integrators.hpp"
#include "memory_table.hpp"
#include "model/membrane/membrane.hpp"
#include "orbit/polish.hpp"
#include "program_run.hpp"
#include "reference_values.hpp"
#include "shipped_problem.hpp"

#include <doctest/doctest.h>
#include <nlohmann/json.hpp>

#include <cmath>
#include <numbers>

using namespace percuss;
using verbs::Kick;
using verbs::KickOutcome;
using verbs::SimulateOptions;

namespace {

using std::numbers::pi;

verbs::StudyProblem at_omega(double omega) {
    verbs::StudyProblem problem = test::shipped_problem("wu2022-nondimensional");
    problem.design.actuator.set(model::Key::nd_omega, omega);
    return problem;
}

SimulateOptions from_state(const flow::State& state, int cycles = 100) {
    SimulateOptions study;
    study.from = verbs::SimulationStart::state;
    study.start.assign(state.begin(), state.end());
    study.cycles = cycles;
    return study;
}

Kick drive_kick(double share, double cycles, double at) {
    Kick kick;
    kick.kind = Kick::Kind::drive;
    kick.share = share;
    kick.duration = cycles;
    kick.at = at;
    return kick;
}

Kick velocity_kick(double velocity, double at) {
    Kick kick;
    kick.velocity = velocity;
    kick.at = at;
    return kick;
}

verbs::SimulateResult simulated(const verbs::StudyProblem& problem, const SimulateOptions& study,
                                test::MemoryTable* series = nullptr, test::MemoryTable* contacts = nullptr) {
    return verbs::run_simulate(problem, study, series, contacts, {}, {});
}

const flow::State& upper_branch = test::reference_orbits[1].state;  // at omega = 2.2
const flow::State& orbit_at_1_9 = test::reference_orbits[0].state;

}  // namespace

TEST_CASE("a kick throws the device off the upper branch where a lower one stands beside it, and only there") {
    const Kick kicks[] = {drive_kick(0.0, 3.0, 50.0), drive_kick(0.5, 5.0, 50.0), velocity_kick(0.2, 50.75)};
    for (const Kick& kick : kicks) {
        CAPTURE(kick.share);
        CAPTURE(kick.velocity);
        SimulateOptions study = from_state(upper_branch);
        study.kick = kick;
        const auto high = simulated(at_omega(2.2), study);
        REQUIRE(high.ending == verbs::Ending::verified);
        CHECK(high.outcome == KickOutcome::fell);
        REQUIRE(high.before);
        REQUIRE(high.after);
        CHECK(high.change_before < 1e-10);  // on the orbit all the time
        CHECK(high.before->polished);
        CHECK(high.before->peak_force == doctest::Approx(test::reference_orbits[1].peak_force).epsilon(1e-8));
        CHECK(high.before->max_multiplier == doctest::Approx(test::reference_orbits[1].max_multiplier).epsilon(1e-7));
        CHECK(high.after->polished);
        CHECK(high.after->contacts == 0);
        CHECK(high.after->peak_force == 0.0);
        CHECK(high.after->max_multiplier == doctest::Approx(test::reference_orbits[3].max_multiplier).epsilon(1e-7));
        for (std::size_t k = 0; k < 4; ++k) {
            CHECK(std::abs(high.after->state[k] - test::reference_orbits[3].state[k]) < 1e-10);
        }

        const auto low = simulated(at_omega(1.92), study);
        REQUIRE(low.ending == verbs::Ending::verified);
        CHECK(low.outcome == KickOutcome::recovered);
        CHECK(low.after->peak_force == doctest::Approx(low.before->peak_force).epsilon(1e-9));
        CHECK(low.after->contacts == 1);
    }
    SimulateOptions weak = from_state(upper_branch);
    weak.kick = drive_kick(0.5, 1.0, 50.0);
    CHECK(simulated(at_omega(2.2), weak).outcome == KickOutcome::recovered);
}

TEST_CASE("a kick can lift the device, and one that does nothing is recovered from") {
    SimulateOptions study = from_state(test::reference_orbits[3].state);
    study.kick = velocity_kick(0.5, 20.0);
    study.cycles = 60;
    const auto lifted = simulated(at_omega(2.2), study);
    CAPTURE(verbs::to_string(lifted.outcome));
    CHECK(lifted.outcome == KickOutcome::rose);
    CHECK(lifted.after->contacts == 1);

    SimulateOptions nothing = from_state(upper_branch, 10);
    nothing.kick = drive_kick(1.0, 2.37, 3.14);
    const auto idle = simulated(at_omega(2.2), nothing);
    CHECK(idle.outcome == KickOutcome::recovered);
    for (std::size_t k = 0; k < 4; ++k) { CHECK(std::abs(idle.end_state[k] - upper_branch[k]) < 1e-10); }

    // A motion that never settles cannot be told from another one.
    SimulateOptions restless = from_state(orbit_at_1_9, 20);
    restless.kick = velocity_kick(0.01, 10.0);
    const auto chaos = simulated(at_omega(1.70), restless);
    CHECK(chaos.ending == verbs::Ending::verified);
    CHECK(chaos.outcome == KickOutcome::undecided);
    CHECK_FALSE(chaos.after->settled);
    CHECK_FALSE(chaos.after->polished);
}

TEST_CASE("rows and contacts of a known orbit") {
    test::MemoryTable series;
    test::MemoryTable contacts;
    SimulateOptions study = from_state(orbit_at_1_9, 3);
    const auto result = simulated(at_omega(1.9), study, &series, &contacts);
    REQUIRE(result.ending == verbs::Ending::verified);
    REQUIRE(series.rows().size() == 3 * 64 + 1);
    REQUIRE(contacts.rows().size() == 3);
    CHECK(result.contacts == 3);
    CHECK(result.peak_force == doctest::Approx(test::reference_orbits[0].peak_force).epsilon(1e-9));
    const double cycle = 2.0 * pi / 1.9;
    for (std::size_t i = 0; i < 3; ++i) {
        using namespace test::at_1_9;
        CHECK(contacts.at(i, "entry_time") ==
              doctest::Approx(entry_tau + cycle * static_cast<double>(i)).epsilon(1e-9));
        CHECK(contacts.at(i, "entry_phase") == doctest::Approx(1.9 * entry_tau).epsilon(1e-8));
        CHECK(contacts.at(i, "impact_velocity") == doctest::Approx(entry_velocity).epsilon(1e-9));
        CHECK(contacts.at(i, "contact_time") == doctest::Approx(exit_tau - entry_tau).epsilon(1e-8));
        CHECK(contacts.at(i, "peak_force") == doctest::Approx(test::reference_orbits[0].peak_force).epsilon(1e-9));
    }
    double highest = 0.0;
    for (std::size_t i = 0; i < series.rows().size(); ++i) {
        CHECK(series.at(i, "time") == doctest::Approx(cycle * static_cast<double>(i) / 64.0));
        CHECK(series.at(i, "phi_I") + series.at(i, "phi_II") == doctest::Approx(0.4));
        const double overlap = series.at(i, "x") - 0.5;
        const double force = overlap >= 0.0 ? 2500.0 * overlap + 2.0 * series.at(i, "x'") : 0.0;
        CHECK(series.at(i, "stop_force") == doctest::Approx(force));
        highest = std::max(highest, series.at(i, "stop_force"));
    }
    CHECK(highest > 3.0);
    CHECK(series.at(32, "phi_I") == doctest::Approx(0.4));
    CHECK(series.unit("x").empty());
    for (std::size_t k = 0; k < 4; ++k) { CHECK(std::abs(result.end_state[k] - orbit_at_1_9[k]) < 1e-11); }
}

TEST_CASE("sampling changes neither the motion nor its contacts") {
    test::MemoryTable coarse;
    test::MemoryTable fine;
    SimulateOptions study;  // from rest
    study.cycles = 12;
    study.samples = 1;
    const auto once = simulated(at_omega(1.75), study, nullptr, &coarse);
    study.samples = 997;  // a contact is cut into a dozen pieces
    const auto often = simulated(at_omega(1.75), study, nullptr, &fine);
    for (std::size_t k = 0; k < 4; ++k) { CHECK(std::abs(once.end_state[k] - often.end_state[k]) < 1e-9); }
    REQUIRE(coarse.rows().size() > 5);
    REQUIRE(coarse.rows().size() == fine.rows().size());
    CHECK(once.contacts == often.contacts);
    for (std::size_t i = 0; i < coarse.rows().size(); ++i) {
        for (const char* name : {"entry_time", "impact_velocity", "peak_force", "contact_time", "exit_phase"}) {
            CAPTURE(name);
            CHECK(coarse.at(i, name) == doctest::Approx(fine.at(i, name)).epsilon(1e-8));
        }
    }
}

TEST_CASE("kicks are where they were asked for") {
    test::MemoryTable series;
    SimulateOptions study = from_state(orbit_at_1_9, 4);
    study.samples = 8;
    study.kick = velocity_kick(0.03, 1.3);
    static_cast<void>(simulated(at_omega(1.9), study, &series));
    REQUIRE(series.rows().size() == 4 * 8 + 1 + 2);
    int jumps = 0;
    for (std::size_t i = 1; i < series.rows().size(); ++i) {
        if (series.at(i, "cycle") != series.at(i - 1, "cycle")) { continue; }
        ++jumps;
        CHECK(series.at(i, "cycle") == 1.3);
        CHECK(series.at(i, "x'") - series.at(i - 1, "x'") == doctest::Approx(0.03));
        CHECK(series.at(i, "x") == series.at(i - 1, "x"));
    }
    CHECK(jumps == 1);

    test::MemoryTable dimmed;
    study.kick = drive_kick(0.25, 1.5, 1.0);
    static_cast<void>(simulated(at_omega(1.9), study, &dimmed));
    REQUIRE(dimmed.rows().size() == 4 * 8 + 1 + 2);
    for (std::size_t i = 0; i < dimmed.rows().size(); ++i) {
        const double cycle = dimmed.at(i, "cycle");
        const double swing = dimmed.at(i, "phi_I") + dimmed.at(i, "phi_II");
        if (cycle > 1.0 && cycle < 2.5) {
            CHECK(swing == doctest::Approx(0.1));
        } else if (cycle < 1.0 || cycle > 2.5) {
            CHECK(swing == doctest::Approx(0.4));
        }
    }

    study.kick = drive_kick(0.5, 1.0, 3.5);
    CHECK_THROWS_AS(simulated(at_omega(1.9), study), std::invalid_argument);
}

TEST_CASE("the motion without the kick goes on from the phase of the kick") {
    for (const double at : {1.0, 1.25, 1.5, 1.75}) {
        CAPTURE(at);
        SimulateOptions study = from_state(upper_branch, 3);
        study.kick = velocity_kick(0.0, at);
        const auto result = simulated(at_omega(2.2), study);
        REQUIRE(result.before);
        CHECK(result.outcome == KickOutcome::recovered);
        CHECK(result.before->cycles < 20);  // it stands on the orbit already
    }
}

TEST_CASE("a motion of several cycles is the same from each of its strobed states") {
    const verbs::StudyProblem problem = at_omega(1.78);
    const design::Scene scene = design::make_scene(problem.design);
    const model::Scaled scaled = model::scale(problem.design.actuator);
    const flow::System system{scene.own.get(), scaled.parameters, nullptr};
    const flow::State first = test::reference_orbits[5].state;
    const auto later = orbit::settle(system, first, 1);
    REQUIRE(later);
    const verbs::Motion one = verbs::identify_motion(system, first, scaled.scales);
    const verbs::Motion two = verbs::identify_motion(system, *later, scaled.scales);
    REQUIRE(one.period == 3);
    CHECK(one.polished);
    CHECK(one.peak_force == doctest::Approx(test::reference_orbits[5].peak_force).epsilon(1e-8));
    CHECK(orbit::relative_distance(system, one.own_state, two.own_state) > 1e-3);
    CHECK(verbs::same_motion(system, one, two));
    CHECK(verbs::same_motion(system, two, one));
    const orbit::Orbit single = orbit::polish_orbit(system, orbit_at_1_9, 1);
    REQUIRE(single.ok());
    const verbs::Motion other = verbs::identify_motion(system, orbit::state_at_zero(system, single), scaled.scales);
    REQUIRE(other.settled);
    CHECK(other.period == 1);
    CHECK_FALSE(verbs::same_motion(system, one, other));
}

TEST_CASE("starts: an orbit at the edge, a given one, rest; no edge without impact") {
    verbs::StudyProblem problem = test::shipped_problem("wu2022-nondimensional");
    SimulateOptions study;
    study.cycles = 2;
    study.from = verbs::SimulationStart::orbit;
    const auto edge = simulated(problem, study);
    REQUIRE(edge.ending == verbs::Ending::verified);
    CHECK(edge.operating_point.edge_kind == design::EdgeKind::grazing);
    CHECK(edge.operating_point.omega == doctest::Approx(0.99 * test::edge_reference::omega).epsilon(1e-9));
    for (std::size_t k = 0; k < 4; ++k) { CHECK(std::abs(edge.end_state[k] - edge.start[k]) < 1e-10); }
    CHECK(edge.contacts == 2);

    study.orbit_start = std::vector<double>(upper_branch.begin(), upper_branch.end());
    (*study.orbit_start)[0] += 1e-4;
    const auto polished = simulated(at_omega(2.2), study);
    REQUIRE(polished.ending == verbs::Ending::verified);
    for (std::size_t k = 0; k < 4; ++k) { CHECK(std::abs(polished.start[k] - upper_branch[k]) < 1e-10); }

    problem.design.actuator.set(model::Key::nd_voltage, 0.1);
    const auto weak = simulated(problem, SimulateOptions{});
    CHECK(weak.ending == verbs::Ending::infeasible);
    CHECK_FALSE(weak.reason.empty());
}

namespace program {
using namespace percuss::tests;

TEST_CASE("the program simulates, with units, and tells what a kick did") {
    const ScratchFolder folder;
    const Outcome si = run(folder, {"simulate", shipped("wu2022-actuator.ini"), "--cycles", "40", "--kick",
                                    "velocity  50 mm/s at cycle 20", "--json"});
    CAPTURE(si.err);
    REQUIRE(si.exit_code == 0);
    const auto document = nlohmann::json::parse(si.out);
    CHECK(document.at("schema") == "percuss/simulate/1");
    CHECK(document.at("kick").at("text") == "velocity 0.05 m/s at cycle 20");
    CHECK(document.at("outcome") == "recovered");
    CHECK(document.at("after").at("polished") == true);
    CHECK(document.at("after").at("state").size() == 4);
    const auto results = folder.path() / "results" / "wu2022-actuator-simulate";
    const std::string series = read_file(results / "series.csv");
    CHECK(series.starts_with("time [s],cycle,phase [rad],x [m],x' [m/s],xi_I,xi_II,stop_force [N],voltage_I [V],"
                             "voltage_II [V]\n0,0,0,0.0025,0,"));
    CHECK(lines(series) == 40 * 64 + 3);
    CHECK(has(series, ",0,3300\n"));
    CHECK(read_file(results / "contacts.csv")
              .starts_with("entry_time [s],entry_cycle,entry_phase [rad],impact_velocity [m/s],peak_force [N],"));

    const std::string start = "0.24433288829767,-0.09712338303067,1.16699726842616,1.21157473484297";
    const Outcome fell =
        run(folder, {"simulate", shipped("wu2022-nondimensional.ini"), "--nondimensional.omega", "2.2", "--start",
                     start, "--kick", "voltage 0 for 3 cycles at cycle 50", "--out", "none"});
    CHECK(fell.exit_code == 0);
    CHECK(has(fell.out, "outcome: the device fell"));
    const auto file = folder.write("kicked.ini", read_file(shipped("duffing.ini")) +
                                                     "\n[simulate]\nkick = force 200 % for 2.5 cycles at cycle 10\n");
    const Outcome spring = run(folder, {"simulate", file.string(), "--json", "--out", "none"});
    CHECK(spring.exit_code == 0);
    CHECK(nlohmann::json::parse(spring.out).at("kick").at("share") == 2.0);
    const Outcome weak = run(folder, {"simulate", shipped("wu2022-nondimensional.ini"), "--nondimensional.phi_pp",
                                      "0.1", "--json", "--out", "none"});
    CHECK(weak.exit_code == 3);
    CHECK(nlohmann::json::parse(weak.out).at("status") == "no-impact");
    const Outcome late = run(
        folder, {"simulate", shipped("duffing.ini"), "--cycles", "100000000", "--time-limit", "0.2", "--out", "none"});
    CHECK(late.exit_code == 4);
}

TEST_CASE("a kick that cannot be understood is told with what is allowed") {
    const struct {
        std::string file;
        std::vector<std::string> options;
        std::string part;
    } cases[] = {
        {"wu2022-actuator.ini", {"--kick", ""}, "at cycle"},
        {"wu2022-actuator.ini", {"--kick", "hard"}, "--simulate.kick 'hard': it does not say 'at cycle N'"},
        {"wu2022-actuator.ini", {"--kick", "velocity at cycle 5"}, "velocity"},
        {"wu2022-actuator.ini", {"--kick", "velocity 3 kV at cycle 5"}, "dimension of m/s"},
        {"wu2022-actuator.ini", {"--kick", "velocity 0.1 m/s at cycle -1"}, "at least 0"},
        {"wu2022-actuator.ini", {"--kick", "velocity 0.1 m/s at cycle nan"}, "'nan'"},
        {"wu2022-actuator.ini", {"--kick", "velocity 0.1 m/s at cycle 101"}, "after the series (cycles = 100)"},
        {"wu2022-actuator.ini", {"--kick", "voltage 50 % at cycle 5"}, "for N cycles"},
        {"wu2022-actuator.ini", {"--kick", "voltage 50 % for 0 cycles at cycle 5"}, "above 0"},
        {"wu2022-actuator.ini", {"--kick", "voltage -1 for 2 cycles at cycle 5"}, "at least 0, at most 10"},
        {"wu2022-actuator.ini", {"--kick", "voltage 3 kV for 2 cycles at cycle 5"}, "share"},
        {"wu2022-actuator.ini", {"--kick", "voltage 0 for 2 cycles at cycle 99"}, "ends at cycle 101"},
        {"wu2022-actuator.ini", {"--kick", "push 1 at cycle 5"}, "'push' is not a kind of kick"},
        {"wu2022-nondimensional.ini", {"--kick", "velocity 0.1 m/s at cycle 5"}, "velocity 0.05 at cycle 50"},
        {"duffing.ini", {"--kick", "voltage 50 % for 1 cycle at cycle 5"}, "force SHARE for N cycles"},
        {"duffing.ini", {"--start", "1 2 3"}, "2 numbers"},
        {"duffing.ini", {"--start", "somewhere"}, "must be rest, orbit or 2 numbers"},
        {"duffing.ini", {"--cycles", "0"}, "--simulate.cycles"},
        {"wu2022-nondimensional.ini", {"--start", "0.4 0 -1 1"}, "must be positive"},
    };
    for (const auto& each : cases) {
        const ScratchFolder folder;
        std::vector<std::string> arguments = {"simulate", shipped(each.file)};
        arguments.insert(arguments.end(), each.options.begin(), each.options.end());
        const Outcome outcome = run(folder, arguments);
        CAPTURE(each.options[1]);
        CAPTURE(outcome.err);
        CHECK(outcome.exit_code == 2);
        CHECK(lines(outcome.err) == 1);
        CHECK(has(outcome.err, each.part));
        CHECK((std::filesystem::is_empty(folder.path()) || std::filesystem::is_empty(folder.path() / "results")));
    }
}

}  // namespace program
