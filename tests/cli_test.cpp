#include "program_run.hpp"

#include <doctest/doctest.h>
#include <nlohmann/json.hpp>

#include <chrono>
#include <cstdio>
#include <sstream>
#include <string>
#include <thread>
#include <vector>

namespace {

namespace fs = std::filesystem;
using percuss::tests::has;
using percuss::tests::lines;
using percuss::tests::Outcome;
using percuss::tests::read_file;
using percuss::tests::run;
using percuss::tests::ScratchFolder;
using percuss::tests::shipped;

const std::string nondimensional = "[nondimensional]\nlambda_p = 1.1\nmu_ratio = 1\nalpha_A = 3\nalpha_B = 2\n"
                                   "delta_A = 0.3\ndelta_B = 60\nl = 0.8\nk = 2500\ndelta_i = 2\nphi_pp = 0.4\n";

}  // namespace

TEST_CASE("version and help") {
    const ScratchFolder folder;
    const Outcome version = run(folder, {"--version"});
    CHECK(version.exit_code == 0);
    CHECK(version.out.starts_with("percuss "));
    const Outcome help = run(folder, {"--help"});
    CHECK(help.exit_code == 0);
    for (const char* word : {"check", "simulate", "sweep", "orbit", "evaluate", "optimise", "--time-limit"}) {
        CHECK(has(help.out, word));
    }
    for (const char* verb : {"check", "simulate", "sweep", "orbit", "evaluate", "optimise", "optimize"}) {
        const Outcome verb_help = run(folder, {verb, "--help"});
        CHECK(verb_help.exit_code == 0);
        CHECK(has(verb_help.out, "stop.gap"));
        CHECK(has(verb_help.out, "nondimensional.delta_i"));
        const bool designs = std::string(verb) != "simulate" && std::string(verb) != "sweep";
        CHECK(has(verb_help.out, "design.limit") == designs);  // a verb lists the keys that it reads
        CHECK(verb_help.err.empty());
    }
    CHECK_FALSE(has(run(folder, {"orbit", "--help"}).out, "sweep.from"));
    CHECK(has(run(folder, {"orbit", "--help"}).out, "at most 64"));
    CHECK(run(folder, {"help"}).out == help.out);
    const Outcome keys = run(folder, {"help", "keys"});
    for (const char* key : {"stop.gap", "sweep.from", "optimiser.method", "design.limit"}) {
        CHECK(has(keys.out, key));
    }
    const Outcome quantities = run(folder, {"help", "quantities"});
    CHECK(quantities.exit_code == 0);
    for (const char* word : {"peak_force", "electric_field", "[nondimensional]"}) { CHECK(has(quantities.out, word)); }
    // Wrapped to 80 columns where there is no terminal.
    for (const std::string& text : {help.out, keys.out, quantities.out, run(folder, {"optimise", "--help"}).out}) {
        std::istringstream stream(text);
        for (std::string line; std::getline(stream, line);) {
            CAPTURE(line);
            CHECK(line.size() <= 80);
        }
    }
}

TEST_CASE("wrong usage is told in one line") {
    const ScratchFolder folder;
    const std::string duffing = shipped("duffing.ini");
    const struct {
        std::vector<std::string> arguments;
        std::string part;
    } cases[] = {
        {{}, "verb"},
        {{"evalute", duffing}, "nearest one is evaluate"},
        {{"explore", duffing}, "not available in this version"},
        {{"pareto", duffing}, "not available in this version"},
        {{"evaluate"}, "needs a problem file"},
        {{"evaluate", duffing, "another"}, "another"},
        {{"evaluate", duffing, "--jsn"}, "nearest known option is --json"},
        {{"evaluate", duffing, "--stop.gapp", "1"}, "nearest known option is --stop.gap"},
        {{"evaluate", duffing, "--stop.gap"}, "stop.gap"},
        {{"evaluate", duffing, "--seed", "-1"}, "--seed"},
        {{"evaluate", duffing, "--jobs", "0"}, "--jobs"},
        {{"evaluate", duffing, "--time-limit", "0"}, "--time-limit"},
        {{"evaluate", duffing, "--json", "--json"}, "twice"},
        {{"evaluate", duffing, "--out", ""}, "--out"},
        {{"optimise", duffing, "--gradients"}, "unknown option --gradients"},
        {{"--verbose"}, "--verbose"},
        {{"evaluate", duffing, "-x"}, "-x"},
    };
    for (const auto& each : cases) {
        const Outcome outcome = run(folder, each.arguments);
        CAPTURE(outcome.err);
        CAPTURE(each.part);
        CHECK(outcome.exit_code == 2);
        CHECK(lines(outcome.err) == 1);
        CHECK(has(outcome.err, each.part));
        CHECK(outcome.out.empty());
    }
    CHECK(fs::is_empty(folder.path()));
}

TEST_CASE("bad input ends with status 2, one line and no results folder") {
    const std::string gap = "g = 0.1\n";
    const struct {
        std::string text;
        std::vector<std::string> options;
        std::string part;
    } cases[] = {
        {nondimensional + gap + "gg = 3\n", {}, "nondimensional.gg"},             // unknown key
        {nondimensional, {}, "nondimensional.g is missing"},                      // missing key
        {nondimensional + gap, {"--nondimensional.omega", "60 Hz"}, "60 Hz"},     // unit where none is allowed
        {nondimensional + gap, {"--nondimensional.omega", "nan"}, "nan"},         // NaN
        {nondimensional + gap, {"--nondimensional.omega", "0"}, "omega = 0"},     // frequency 0
        {nondimensional + "g = -0.1\n", {}, "nondimensional.g = -0.1"},           // gap below zero
        {nondimensional + gap, {"--nondimensional.k", "-1"}, "k = -1"},           // negative stiffness
        {nondimensional + gap, {"--solver.tolerance", "0"}, "solver.tolerance"},  // tolerance 0
        {nondimensional + gap, {"--optimiser.tolerance", "0"}, "optimiser.tolerance"},
        {nondimensional + gap, {"--design.variable", "nondimensional.g in 0.2 .. 0.1"}, "reversed"},
        {nondimensional + gap + "line without meaning\n", {}, "line without meaning"},
        {nondimensional + gap, {"--design.maximise", "apparent_power"}, "apparent_power"},
        {nondimensional + gap, {"--stop.law", "none"}, "stop.law"},
        {"", {}, "no actuator"},
    };
    for (const char* verb : {"evaluate", "optimise", "check"}) {
        for (const auto& each : cases) {
            const ScratchFolder folder;
            const fs::path file = folder.write("bad.ini", each.text);
            std::vector<std::string> arguments = {verb, file.string()};
            arguments.insert(arguments.end(), each.options.begin(), each.options.end());
            const Outcome outcome = run(folder, arguments);
            CAPTURE(verb);
            CAPTURE(each.text);
            CAPTURE(outcome.err);
            CHECK(outcome.exit_code == 2);
            CHECK(lines(outcome.err) == 1);
            CHECK(has(outcome.err, each.part));
            CHECK_FALSE(fs::exists(folder.path() / "results"));
        }
    }
}

TEST_CASE("bad values for the shipped actuator") {
    const struct {
        std::string option;
        std::string value;
        std::string part;
    } cases[] = {
        {"actuator.moving_mass", "-2 g", "actuator.moving_mass = -0.002 kg"},
        {"stop.stiffness", "-1 N/mm", "stop.stiffness = -1000 N/m"},
        {"stop.gap", "-0.1 mm", "stop.gap = -0.0001 m"},
        {"stop.gap", "5 kg", "dimension of m"},
        {"drive.frequency", "0 Hz", "drive.frequency = 0 Hz"},
        {"drive.frequency", "3600 rpm", "angle"},
        {"actuator.outer_radius", "3 mm", "inner_radius"},
        {"design.limit", "amplitude <= 1 kg", "dimension of m"},
        {"nondimensional.omega", "1.9", "nondimensional.omega"},
        {"drive.voltage", "1e400 V", "1e400 V"},
    };
    for (const auto& each : cases) {
        const ScratchFolder folder;
        const Outcome outcome =
            run(folder, {"evaluate", shipped("wu2022-actuator.ini"), "--" + each.option, each.value});
        CAPTURE(outcome.err);
        CAPTURE(each.part);
        CHECK(outcome.exit_code == 2);
        CHECK(lines(outcome.err) == 1);
        CHECK(has(outcome.err, each.option));
        CHECK(has(outcome.err, each.part));
        CHECK(fs::is_empty(folder.path()));
    }
    const ScratchFolder folder;
    CHECK(run(folder, {"evaluate", "absent.ini"}).exit_code == 2);
    CHECK(run(folder, {"evaluate", folder.path().string()}).exit_code == 2);
    CHECK(run(folder, {"orbit", shipped("wu2022-actuator.ini")}).exit_code == 2);     // no frequency
    CHECK(run(folder, {"optimise", shipped("wu2022-actuator.ini")}).exit_code == 2);  // nothing to optimise
    CHECK(fs::is_empty(folder.path()));
}

TEST_CASE("check prints every shipped problem and leaves nothing behind") {
    for (const char* name :
         {"wu2022-nondimensional.ini", "wu2022-actuator.ini", "crawler.ini", "soft-impact.ini", "duffing.ini"}) {
        const ScratchFolder folder;
        const Outcome plain = run(folder, {"check", shipped(name)});
        CAPTURE(plain.err);
        CHECK(plain.exit_code == 0);
        CHECK(plain.err.empty());
        CHECK(has(plain.out, "Nothing is missing"));
        const Outcome json = run(folder, {"check", shipped(name), "--json"});
        const auto document = nlohmann::json::parse(json.out);
        CHECK(document.at("schema") == "percuss/check/1");
        CHECK(document.at("troubles").empty());
        CHECK(fs::is_empty(folder.path()));
    }
}

TEST_CASE("check marks options, defaults and troubles") {
    const ScratchFolder folder;
    const Outcome outcome = run(
        folder, {"check", shipped("wu2022-actuator.ini"), "--stop.gap", "-1 mm", "--drive.voltage", "2 kV", "--json"});
    CHECK(outcome.exit_code == 2);
    CHECK(lines(outcome.err) == 1);
    const auto settings = nlohmann::json::parse(outcome.out).at("settings");
    CHECK(settings.at("drive.voltage").at("value") == 2000.0);
    CHECK(settings.at("drive.voltage").at("origin") == "option");
    CHECK(settings.at("stop.stiffness").at("origin") == "file");
    CHECK(settings.at("solver.integrator").at("origin") == "default");
    CHECK(has(settings.at("stop.gap").at("trouble"), "out of range"));
}

TEST_CASE("orbit writes a results folder and one document") {
    const ScratchFolder folder;
    const Outcome outcome = run(folder, {"orbit", shipped("duffing.ini"), "--json", "--seed", "7"});
    CAPTURE(outcome.err);
    REQUIRE(outcome.exit_code == 0);
    const auto document = nlohmann::json::parse(outcome.out);
    CHECK(document.at("schema") == "percuss/orbit/1");
    CHECK(document.at("units") == "si");
    CHECK(document.at("orbit").at("state").size() == 2);
    CHECK_FALSE(document.at("operating_point").contains("edge_omega"));
    CHECK(document.at("quantities").contains("rig_force"));
    CHECK_FALSE(document.at("quantities").contains("electric_field"));

    const fs::path results = folder.path() / "results" / "duffing-orbit";
    CHECK(read_file(results / "result.json") == outcome.out);
    const auto manifest = nlohmann::json::parse(read_file(results / "manifest.json"));
    CHECK(manifest.at("state") == "finished");
    CHECK(manifest.at("verb") == "orbit");
    CHECK(manifest.at("seed") == 7);
    CHECK(manifest.at("problem").at("name") == "duffing");
    CHECK(manifest.at("problem").at("hash").get<std::string>().size() == 16);
    CHECK_FALSE(manifest.at("instruction_set").get<std::string>().empty());
    for (const auto& file : manifest.at("files")) { CHECK(fs::exists(results / file.get<std::string>())); }
    CHECK(has(read_file(results / "quantities.csv"), "amplitude [m]"));
    CHECK(has(read_file(results / "report.html"), "</html>"));
    for (const auto& entry : fs::directory_iterator(results)) { CHECK(entry.path().extension() != ".partial"); }
}

TEST_CASE("results folders are replaced only when they may be") {
    const ScratchFolder folder;
    const std::string duffing = shipped("duffing.ini");
    const fs::path results = folder.path() / "here";
    const std::vector<std::string> again = {"orbit", duffing, "--out", "here", "--quiet"};
    REQUIRE(run(folder, again).exit_code == 0);

    // A finished run of the same verb and problem: replaced, foreign files stay.
    folder.write("here/notes.txt", "mine");
    const Outcome replaced = run(folder, again);
    CHECK(replaced.exit_code == 0);
    CHECK(replaced.err.empty());
    CHECK(read_file(results / "notes.txt") == "mine");

    // The same folder for another verb.
    const Outcome other = run(folder, {"evaluate", duffing, "--out", "here"});
    CHECK(other.exit_code == 2);
    CHECK(lines(other.err) == 1);
    CHECK(has(other.err, "left alone"));

    // An unfinished run.
    std::string manifest = read_file(results / "manifest.json");
    manifest.replace(manifest.find("finished"), 8, "started");
    folder.write("here/manifest.json", manifest);
    const Outcome unfinished = run(folder, again);
    CHECK(unfinished.exit_code == 2);
    CHECK(has(unfinished.err, "--force"));
    CHECK(read_file(results / "manifest.json") == manifest);
    auto forced = again;
    forced.emplace_back("--force");
    CHECK(run(folder, forced).exit_code == 0);
    CHECK(has(read_file(results / "manifest.json"), "\"finished\""));

    // Folders and files that are not ours.
    fs::create_directory(folder.path() / "foreign");
    folder.write("foreign/data.txt", "data");
    const Outcome foreign = run(folder, {"orbit", duffing, "--out", "foreign", "--force"});
    CHECK(foreign.exit_code == 2);
    CHECK(has(foreign.err, "not a results folder"));
    CHECK(read_file(folder.path() / "foreign" / "data.txt") == "data");
    folder.write("plain", "file");
    CHECK(run(folder, {"orbit", duffing, "--out", "plain"}).exit_code == 2);
    CHECK(read_file(folder.path() / "plain") == "file");

    // An empty folder is as good as none; "none" writes nothing.
    fs::create_directory(folder.path() / "empty");
    CHECK(run(folder, {"orbit", duffing, "--out", "empty"}).exit_code == 0);
    const ScratchFolder clean;
    CHECK(run(clean, {"orbit", duffing, "--out", "none"}).exit_code == 0);
    CHECK(fs::is_empty(clean.path()));
}

TEST_CASE("results of another problem are replaced only on demand, and have a folder of their own by default") {
    const ScratchFolder folder;
    const std::string duffing = shipped("duffing.ini");
    const fs::path results = folder.path() / "results";
    REQUIRE(run(folder, {"orbit", duffing, "--quiet"}).exit_code == 0);
    const std::string first = read_file(results / "duffing-orbit" / "result.json");

    // An option that changes the problem: beside the first, six digits of the hash in the name.
    const Outcome changed = run(folder, {"orbit", duffing, "--spring-mass.force", "0.01 N", "--json"});
    REQUIRE(changed.exit_code == 0);
    CHECK(read_file(results / "duffing-orbit" / "result.json") == first);
    const std::string hash =
        nlohmann::json::parse(run(folder, {"check", duffing, "--spring-mass.force", "0.01 N", "--json"}).out)
            .at("hash");
    CHECK(read_file(results / ("duffing-orbit-" + hash.substr(0, 6)) / "result.json") == changed.out);

    // The same folder for another problem: refused, and replaced with --force.
    const std::vector<std::string> other = {
        "orbit", duffing, "--spring-mass.force", "0.01 N", "--out", "results/duffing-orbit", "--quiet"};
    const Outcome refused = run(folder, other);
    CHECK(refused.exit_code == 2);
    CHECK(lines(refused.err) == 1);
    CHECK(has(refused.err, "--force"));
    CHECK(read_file(results / "duffing-orbit" / "result.json") == first);
    auto forced = other;
    forced.emplace_back("--force");
    CHECK(run(folder, forced).exit_code == 0);
    CHECK(read_file(results / "duffing-orbit" / "result.json") != first);
}

TEST_CASE("a folder that another run writes into is refused, forced or not") {
    const ScratchFolder folder;
    const std::string paper = shipped("wu2022-nondimensional.ini");
    const std::vector<std::string> endless = {
        "attractors", paper, "--nondimensional.omega", "1.9", "--starts", "10000000", "--out", "here", "--quiet"};
    // A long run in the background, ended by its time limit; the second comes while it runs.
    const std::string first =
        "{ ( \"$PERCUSS_BIN\" attractors '" + paper +
        "' --nondimensional.omega 1.9 --starts 10000000 --out here --quiet --time-limit 6 "
        ">first.out 2>first.err; echo $? >first.code ) & } ; while ! test -e here/manifest.json; do "
        "sleep 0.1; done; ";
    for (const bool force : {false, true}) {
        std::vector<std::string> arguments = endless;
        if (force) { arguments.emplace_back("--force"); }
        const Outcome second = run(folder, arguments, force ? "" : first);
        CHECK(second.exit_code == 2);
        CHECK(lines(second.err) == 1);
        CHECK(has(second.err, "another run"));
    }
    for (int i = 0; i < 200 && !fs::exists(folder.path() / "first.code"); ++i) {
        std::this_thread::sleep_for(std::chrono::milliseconds(100));
    }
    CHECK(read_file(folder.path() / "first.code") == "4\n");
    CHECK(has(read_file(folder.path() / "here" / "manifest.json"), "\"finished\""));
    CHECK_FALSE(fs::exists(folder.path() / "here" / ".percuss-lock"));

    // The lock of a run that was killed is no lock.
    folder.write("here/.percuss-lock", "");
    std::vector<std::string> again = endless;
    again.insert(again.end(), {"--time-limit", "0.2"});
    CHECK(run(folder, again).exit_code == 4);
}

TEST_CASE("a failing exit code says why in one line, with --json too") {
    const ScratchFolder folder;
    for (const bool json : {false, true}) {
        std::vector<std::string> arguments = {
            "evaluate", shipped("wu2022-nondimensional.ini"), "--nondimensional.omega", "6", "--out", "none"};
        if (json) { arguments.emplace_back("--json"); }
        const Outcome none = run(folder, arguments);
        CAPTURE(none.err);
        CHECK(none.exit_code == 3);
        CHECK(lines(none.err) == 1);
        CHECK(has(none.err, "no-impact"));
    }
}

TEST_CASE("documents in SI tell angular frequencies in rad/s and the nondimensional ones beside them") {
    const ScratchFolder folder;
    const Outcome outcome =
        run(folder, {"evaluate", shipped("wu2022-actuator.ini"), "--gradients", "--json", "--out", "none"});
    REQUIRE(outcome.exit_code == 0);
    const auto document = nlohmann::json::parse(outcome.out);
    const auto& point = document.at("operating_point");
    const double hertz = point.at("drive_frequency");
    const double omega = point.at("omega");
    const double plain = point.at("omega_nondimensional");
    CHECK(omega == doctest::Approx(2.0 * 3.14159265358979323846 * hertz).epsilon(1e-14));
    CHECK(plain < 10.0);
    const double edge = point.at("edge_omega");
    CHECK(edge / omega == doctest::Approx(point.at("edge_omega_nondimensional").get<double>() / plain).epsilon(1e-14));

    // Gradients are those of the numbers told: against a central difference in a key that the time unit depends on.
    const double mass = document.at("design").at("actuator.moving_mass");
    const auto at = [&](double m) {
        char text[32];
        std::snprintf(text, sizeof text, "%.17g", m);
        const Outcome there = run(folder, {"evaluate", shipped("wu2022-actuator.ini"), "--actuator.moving_mass", text,
                                           "--json", "--out", "none"});
        REQUIRE(there.exit_code == 0);
        return nlohmann::json::parse(there.out).at("operating_point");
    };
    const double step = 1e-4 * mass;  // truncation 1e-8, rounding of the edge 1e-12 / 1e-4
    const auto above = at(mass + step);
    const auto below = at(mass - step);
    for (const char* name : {"omega", "edge_omega", "omega_nondimensional", "drive_frequency"}) {
        CAPTURE(name);
        const double difference = (above.at(name).get<double>() - below.at(name).get<double>()) / (2.0 * step);
        const double exact =
            document.at("gradients").at(std::string("operating_point.") + name).at("actuator.moving_mass");
        CHECK(exact == doctest::Approx(difference).epsilon(1e-6));
    }
}

TEST_CASE("readable output names quantities, units and how uniqueness was checked") {
    const ScratchFolder folder;
    const Outcome outcome = run(folder, {"orbit", shipped("duffing.ini"), "--gradients"});
    CHECK(outcome.exit_code == 0);
    CHECK(has(outcome.out, "amplitude"));
    CHECK(has(outcome.out, "multiplier"));
    CHECK(has(outcome.out, "uniqueness: "));
    CHECK(has(outcome.out, "Gradients"));
    CHECK(has(outcome.err, "results/duffing-orbit"));
    CHECK(has(read_file(folder.path() / "results" / "duffing-orbit" / "gradients.csv"), "d(amplitude)"));
}

TEST_CASE("optimise that is cut short keeps its results so far") {
    const struct {
        std::string prefix;
        std::vector<std::string> options;
        int exit_code;
        std::string state;
    } cases[] = {
        {"", {"--time-limit", "0.3"}, 4, "finished"},
        {"timeout --preserve-status --signal=INT 1", {}, 130, "interrupted"},
    };
    for (const auto& each : cases) {
        const ScratchFolder folder;
        std::vector<std::string> arguments = {"optimise", shipped("crawler.ini"), "--json"};
        arguments.insert(arguments.end(), each.options.begin(), each.options.end());
        const Outcome outcome = run(folder, arguments, each.prefix);
        CAPTURE(outcome.err);
        CAPTURE(each.state);
        CHECK(outcome.exit_code == each.exit_code);
        CHECK(nlohmann::json::parse(outcome.out).at("schema") == "percuss/optimise/1");
        const fs::path results = folder.path() / "results" / "crawler-optimise";
        const auto manifest = nlohmann::json::parse(read_file(results / "manifest.json"));
        CHECK(manifest.at("state") == each.state);
        CHECK(has(read_file(results / "evaluations.csv"), "stop.gap [m]"));
        CHECK(fs::exists(results / "report.html"));
    }
}
