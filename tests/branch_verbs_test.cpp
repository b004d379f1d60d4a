// Verbs branch and locus as a user runs them.

#include "program_run.hpp"
#include "reference_values.hpp"
#include "relative.hpp"

#include <doctest/doctest.h>
#include <nlohmann/json.hpp>

#include <cmath>
#include <sstream>

namespace {

namespace fs = std::filesystem;
using percuss::test::relative;
using percuss::tests::has;
using percuss::tests::lines;
using percuss::tests::Outcome;
using percuss::tests::read_file;
using percuss::tests::results_of;
using percuss::tests::run;
using percuss::tests::ScratchFolder;
using percuss::tests::shipped;
using Json = nlohmann::json;
namespace reference = percuss::test::boundary_reference;

Json parsed(const Outcome& outcome, int exit_code = 0) {
    CAPTURE(outcome.err);
    REQUIRE(outcome.exit_code == exit_code);
    return Json::parse(outcome.out);
}

const Json* nearest(const Json& document, const std::string& kind, double omega, const std::string& by = "omega") {
    const Json* best = nullptr;
    for (const Json& found : document.at("boundaries")) {
        if (found.at("kind") != kind) { continue; }
        const double distance = std::abs(found.at(by).get<double>() - omega);
        if (best == nullptr || distance < std::abs(best->at(by).get<double>() - omega)) { best = &found; }
    }
    return best;
}

}  // namespace

TEST_CASE("the hysteresis map: document, tables, report, print") {
    const ScratchFolder folder;
    const std::vector<std::string> arguments = {"branch", shipped("wu2022-nondimensional.ini"), "--from", "4", "--to",
                                                "1.2"};
    auto with_json = arguments;
    with_json.emplace_back("--json");
    const Outcome outcome = run(folder, with_json);
    const Json document = parsed(outcome);
    CHECK(document.at("schema") == "percuss/branch/1");
    CHECK(document.at("units") == "nondimensional");
    CHECK(document.at("along") == "nondimensional.omega");
    CHECK(document.at("from") == 4.0);
    CHECK(document.at("to") == 1.2);
    CHECK(document.at("cost").at("orbit_solves").get<int>() < 400);
    REQUIRE(document.at("branches").size() == 1);
    const Json& main = document.at("branches").at(0);
    CHECK(main.at("id") == 0);
    CHECK(main.at("period") == 1);
    CHECK(main.at("begin") == "start");
    CHECK(main.at("end") == "range");
    const Json& points = main.at("points");
    CHECK(points.size() > 40);
    for (const char* name : {"omega", "drive_frequency", "amplitude", "x_max", "x_min", "peak_force", "contacts",
                             "max_multiplier", "stable"}) {
        CAPTURE(name);
        CHECK(points.at(0).contains(name));
    }
    CHECK(points.at(0).at("drive_frequency").get<double>() == relative(4.0 / (2.0 * std::acos(-1.0)), 1e-14));
    CHECK(points.at(0).at("stable") == true);
    CHECK(points.at(0).at("peak_force") == 0.0);

    REQUIRE(document.at("boundaries").size() == 6);
    const auto omega_of = [&](const char* kind, double near) {
        const Json* found = nearest(document, kind, near);
        REQUIRE(found != nullptr);
        return found->at("omega").get<double>();
    };
    CHECK(std::abs(omega_of("grazing", 1.9) - reference::grazing_upper) < 1e-9);
    CHECK(std::abs(omega_of("grazing", 1.6) - reference::grazing_lower) < 1e-9);
    CHECK(std::abs(omega_of("fold", 2.6) - reference::fold_upper) < 1e-9);
    CHECK(std::abs(omega_of("flip", 1.75) - reference::flip) < 1e-9);
    CHECK(nearest(document, "fold", 2.6)->at("peak_force").get<double>() ==
          relative(reference::fold_upper_peak_force, 1e-9));
    CHECK(nearest(document, "fold", 2.6)->at("state").size() == 4);
    CHECK(omega_of("grazing", 1.9) - omega_of("fold", 1.9) == relative(reference::fold_offset_upper, 0.02));
    REQUIRE(document.at("jumps").size() == 1);
    CHECK(document.at("jumps").at(0).at("boundaries") == Json::array({0, 1}));
    CHECK(document.at("jumps").at(0).at("distance").get<double>() == relative(reference::fold_offset_upper, 0.02));
    CHECK(document.at("boundaries").at(0).at("jump_with") == 1);
    CHECK(document.at("boundaries").at(2).at("jump_with").is_null());

    const fs::path results = results_of(folder, "wu2022-nondimensional-branch");
    CHECK(read_file(results / "result.json") == outcome.out);
    const std::string table = read_file(results / "branch.csv");
    CHECK(lines(table) == 1 + static_cast<long>(points.size()));
    CHECK(has(table, "branch,period [drive cycles],omega,drive_frequency,amplitude"));
    CHECK(lines(read_file(results / "boundaries.csv")) == 7);
    CHECK(has(read_file(results / "report.html"), "Boundaries"));
    CHECK(Json::parse(read_file(results / "manifest.json")).at("state") == "finished");

    auto printed = arguments;
    printed.insert(printed.end(), {"--out", "none"});
    const Outcome text = run(folder, printed);
    CHECK(text.exit_code == 0);
    for (const char* part : {"1.93541550079", "2.58604625053", "1.74587244992", "19.6493", "one jump with the fold",
                             "start of the range"}) {
        CAPTURE(part);
        CHECK(has(text.out, part));
    }
}

TEST_CASE("gradients of boundaries in the user's keys") {
    const ScratchFolder folder;
    const std::vector<std::string> common = {
        "branch", shipped("wu2022-actuator.ini"), "--json", "--out", "none", "--from", "110 Hz", "--to", "40 Hz"};
    auto arguments = common;
    arguments.emplace_back("--gradients");
    const Json document = parsed(run(folder, arguments));
    CHECK(document.at("units") == "si");
    const struct {
        const char* key;
        double value;
        double step;
    } keys[] = {{"stop.gap", 0.6e-3, 1e-6}, {"drive.voltage", 3300.0, 3.0}, {"material.kelvin_viscosity", 220.0, 0.2}};
    for (const char* kind : {"grazing", "fold"}) {
        const Json* found = nearest(document, kind, 100.0);  // the highest
        REQUIRE(found != nullptr);
        const double omega = found->at("omega").get<double>();
        for (const auto& each : keys) {
            CAPTURE(kind);
            CAPTURE(each.key);
            const double exact = found->at("gradients").at("omega").at(each.key).get<double>();
            double moved[2];
            for (const int side : {0, 1}) {
                auto there = common;
                std::ostringstream value;
                value.precision(17);
                value << each.value + (side == 0 ? -each.step : each.step);
                there.insert(there.end(), {std::string("--") + each.key, value.str()});
                moved[side] = nearest(parsed(run(folder, there)), kind, omega)->at("omega").get<double>();
            }
            // Central difference with a thousandth of the value: six digits.
            CHECK(exact == relative((moved[1] - moved[0]) / (2.0 * each.step), 2e-5));
        }
        // At a given frequency nothing depends on the frequency.
        CHECK_FALSE(found->at("gradients").at("omega").contains("drive.frequency"));
    }
}

TEST_CASE("along a key, in its unit") {
    const ScratchFolder folder;
    const Outcome outcome = run(folder, {"branch", shipped("wu2022-actuator.ini"), "--along", "stop.gap", "--from",
                                         "0.2 mm", "--to", "1.6 mm", "--drive.frequency", "65 Hz", "--json"});
    const Json document = parsed(outcome);
    CHECK(document.at("along") == "stop.gap");
    CHECK(document.at("from").get<double>() == relative(0.2e-3, 1e-14));
    const Json& points = document.at("branches").at(0).at("points");
    CHECK(points.front().at("value").get<double>() == relative(1.6e-3, 1e-12));
    CHECK(points.back().at("value").get<double>() == relative(1.6e-3, 1e-12));
    for (const Json& p : points) { CHECK(p.at("drive_frequency").get<double>() == relative(65.0, 1e-12)); }
    // Across the widest gap the actuator strikes or stays clear; the two motions are one branch that grazes where its
    // largest displacement is L/2 + G.
    const Json* grazing = nearest(document, "grazing", 0.5e-3, "value");
    REQUIRE(grazing != nullptr);
    CHECK(points.front().at("contacts").get<int>() + points.back().at("contacts").get<int>() == 1);
    const double gap = grazing->at("value").get<double>();
    bool met = false;
    for (const Json& p : points) {
        if (p.at("value") == grazing->at("value")) {
            met = true;
            CHECK(p.at("x_max").get<double>() == relative(2.5e-3 + gap, 1e-8));
        }
    }
    CHECK(met);
    const std::string table = read_file(results_of(folder, "wu2022-actuator-branch") / "branch.csv");
    CHECK(has(table, "stop.gap [m]"));
    CHECK(has(table, "peak_force [N]"));
    CHECK(has(table, "drive_frequency [Hz]"));
}

TEST_CASE("subharmonic branches: period two at the flip, period three on an isola") {
    const ScratchFolder folder;
    const Json document = parsed(run(folder, {"branch", shipped("wu2022-nondimensional.ini"), "--nondimensional.omega",
                                              "1.78", "--period", "3", "--seed", "1", "--json", "--out", "none"}));
    int isolas = 0;
    int doubled = 0;
    for (const Json& branch : document.at("branches")) {
        isolas += branch.at("period") == 3 && branch.at("end") == "closed" ? 1 : 0;
        doubled += branch.at("period") == 2 && branch.at("from_branch") == 0 ? 1 : 0;
    }
    CHECK(isolas == 1);
    CHECK(doubled == 1);
    CHECK(std::abs(nearest(document, "grazing", 1.7525)->at("omega").get<double>() - 1.7525492493) < 1e-9);
    CHECK(std::abs(nearest(document, "fold", 1.8613)->at("omega").get<double>() - 1.8613474958) < 1e-9);
    CHECK(std::abs(nearest(document, "grazing", 1.8613)->at("omega").get<double>() - 1.8613422725) < 1e-9);
}

TEST_CASE("locus: the cusp of the folds, document, table, print") {
    const ScratchFolder folder;
    const std::vector<std::string> arguments = {"locus",      shipped("wu2022-nondimensional.ini"),
                                                "--boundary", "fold",
                                                "--along",    "nondimensional.phi_pp",
                                                "--from",     "0.5",
                                                "--to",       "0.15"};
    auto with_json = arguments;
    with_json.emplace_back("--json");
    const Outcome outcome = run(folder, with_json);
    const Json document = parsed(outcome);
    CHECK(document.at("schema") == "percuss/locus/1");
    CHECK(document.at("kind") == "fold");
    CHECK(document.at("along") == "nondimensional.phi_pp");
    REQUIRE(document.at("cusps").size() == 1);
    CHECK(document.at("cusps").at(0).at("value").get<double>() == doctest::Approx(0.199895).epsilon(3e-6));
    CHECK(document.at("cusps").at(0).at("omega").get<double>() == doctest::Approx(1.79879).epsilon(3e-6));
    CHECK(document.at("curves").size() == 1);
    int at_default = 0;
    for (const Json& p : document.at("points")) {
        if (std::abs(p.at("value").get<double>() - 0.4) < 1e-12 && p.at("omega") > 2.0) {
            ++at_default;
            CHECK(std::abs(p.at("omega").get<double>() - reference::fold_upper) < 1e-9);
            CHECK(p.at("peak_force").get<double>() == relative(reference::fold_upper_peak_force, 1e-8));
        }
    }
    CHECK(at_default == 1);
    const fs::path results = results_of(folder, "wu2022-nondimensional-locus");
    CHECK(read_file(results / "result.json") == outcome.out);
    const std::string table = read_file(results / "locus.csv");
    CHECK(lines(table) == 1 + static_cast<long>(document.at("points").size()));
    CHECK(has(table, "curve,nondimensional.phi_pp,omega,drive_frequency"));
    auto printed = arguments;
    printed.insert(printed.end(), {"--out", "none"});
    CHECK(has(run(folder, printed).out, "cusp"));

    // In units: the published fold curve of the soft stop.
    const Json soft =
        parsed(run(folder, {"locus", shipped("soft-impact.ini"), "--along", "spring-mass.force", "--from",
                            "0.152380952381 N", "--to", "0.5", "--locus.steps", "35", "--json", "--out", "none"}));
    for (const auto& [force, omega] : percuss::test::soft_impact::fold_curve) {
        CAPTURE(force);
        double nearest_omega = 0.0;
        for (const Json& p : soft.at("points")) {
            if (std::abs(p.at("value").get<double>() - force) < 1e-12 && p.at("omega") > 1.5) {
                nearest_omega = p.at("omega").get<double>();
            }
        }
        CHECK(std::abs(nearest_omega - omega) < 1e-8);
    }
    // A boundary that the branch has not.
    const Outcome none = run(folder, {"locus", shipped("duffing.ini"), "--boundary", "grazing", "--along",
                                      "spring-mass.force", "--from", "0.18", "--to", "0.3", "--out", "none"});
    CHECK(none.exit_code == 3);
    CHECK(has(none.out, "no such boundary"));
}

TEST_CASE("what cannot be done is said with key, value and what is allowed") {
    const ScratchFolder folder;
    const std::string paper = shipped("wu2022-nondimensional.ini");
    const std::string actuator = shipped("wu2022-actuator.ini");
    const struct {
        std::vector<std::string> arguments;
        std::vector<std::string> parts;
    } wrong[] = {
        {{"branch", paper, "--period", "0"}, {"branch.period", "'0'", "at least 1"}},
        {{"branch", paper, "--period", "1.5"}, {"branch.period", "'1.5'", "whole number"}},
        {{"branch", paper, "--starts", "-1"}, {"branch.starts", "'-1'", "at least 0"}},
        {{"branch", paper, "--branch.max_points", "1"}, {"branch.max_points", "'1'", "at least 2"}},
        {{"branch", paper, "--along", "stop.gap"}, {"stop.gap", "nondimensional.g"}},
        {{"branch", paper, "--along", "nondimensional.layers"}, {"nondimensional.layers", "whole numbers"}},
        {{"branch", paper, "--along", "nondimensional.g"}, {"branch.from", "nondimensional.g"}},
        {{"branch", paper, "--from", "-1"}, {"branch.from", "'-1'", "above 0"}},
        {{"branch", paper, "--from", "2", "--to", "2"}, {"branch.to", "'2'", "empty"}},
        {{"branch", paper, "--from", "nan"}, {"branch.from", "nan"}},
        {{"branch", paper, "--boundary", "fold"}, {"--boundary"}},
        {{"branch", actuator, "--from", "3 mm"}, {"branch.from", "3 mm", "Hz"}},
        {{"branch", actuator, "--from", "60 rad/s"}, {"branch.from", "rad"}},
        {{"branch", actuator, "--along", "stop.gap", "--from", "0.2 mm", "--to", "1 V"}, {"branch.to", "1 V"}},
        {{"locus", paper}, {"locus.along"}},
        {{"locus", paper, "--along", "nondimensional.g"}, {"locus.from", "nondimensional.g"}},
        {{"locus", paper, "--along", "nondimensional.omega", "--from", "1", "--to", "2"},
         {"locus.along", "nondimensional.omega", "drive frequency"}},
        {{"locus", paper, "--from", "1", "--to", "2"}, {"locus.from", "locus.along"}},
        {{"locus", paper, "--boundary", "cusp", "--along", "nondimensional.g", "--from", "0.1", "--to", "0.2"},
         {"locus.boundary", "'cusp'", "fold | flip | torus | grazing"}},
        {{"locus", paper, "--along", "nondimensional.g", "--from", "-0.1", "--to", "0.2"},
         {"locus.from", "'-0.1'", "at least 0"}},
        {{"locus", paper, "--along", "nondimensional.lambda_p", "--from", "1.1", "--to", "0.5"},
         {"locus.to", "'0.5'", "at least 1"}},
        {{"locus", paper, "--along", "nondimensional.g", "--from", "0.1", "--to", "0.1"}, {"locus.to", "empty"}},
        {{"locus", paper, "--along", "nondimensional.g", "--from", "0.1", "--to", "0.2", "--locus.steps", "0"},
         {"locus.steps", "'0'", "at least 1"}},
        {{"locus", paper, "--along", "nondimensional.g", "--from", "0.1", "--to", "0.2", "--period", "2"},
         {"--period"}},
    };
    for (const auto& each : wrong) {
        const Outcome outcome = run(folder, each.arguments);
        std::string command;
        for (const std::string& word : each.arguments) { command += word + " "; }
        CAPTURE(command);
        CAPTURE(outcome.err);
        CHECK(outcome.exit_code == 2);
        CHECK(outcome.out.empty());
        CHECK(lines(outcome.err) == 1);
        for (const std::string& part : each.parts) {
            CAPTURE(part);
            CHECK(has(outcome.err, part));
        }
    }
    CHECK_FALSE(fs::exists(folder.path() / "results"));
}

TEST_CASE("a map that is cut short says so") {
    const ScratchFolder folder;
    const std::string paper = shipped("wu2022-nondimensional.ini");
    const Json few = parsed(run(folder, {"branch", paper, "--branch.max_points", "12", "--json", "--out", "none"}), 4);
    CHECK(few.at("branches").at(0).at("end") == "budget");
    CHECK(has(few.at("reason").get<std::string>(), "branch.max_points"));
    const Outcome late = run(
        folder, {"branch", paper, "--period", "8", "--starts", "100000", "--time-limit", "0.5", "--json", "--quiet"});
    const Json document = parsed(late, 4);
    CHECK(document.at("branches").size() >= 1);
    const Outcome held = run(folder, {"branch", paper, "--along", "nondimensional.k", "--from", "2000", "--to", "3000",
                                      "--nondimensional.phi_pp", "0.1", "--out", "none"});
    CHECK(held.exit_code == 2);  // no edge whose frequency could be held
    CHECK(has(held.err, "edge"));
}
