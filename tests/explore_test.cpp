// Verbs explore and merge as a user runs them.

#include "program_run.hpp"
#include "verbs/explore/exploration_text.hpp"
#include "verbs/explore/explore_options.hpp"
#include "verbs/verbs.hpp"

#include <doctest/doctest.h>
#include <nlohmann/json.hpp>

#include <cmath>
#include <fstream>
#include <map>
#include <random>
#include <sstream>

namespace {

namespace fs = std::filesystem;
using percuss::tests::has;
using percuss::tests::lines;
using percuss::tests::Outcome;
using percuss::tests::read_file;
using percuss::tests::run;
using percuss::tests::ScratchFolder;
using percuss::tests::shipped;
using Json = nlohmann::json;

/// Cheap to evaluate (a millisecond), with a logarithmic and an integer variable, and no impact at the largest gaps.
const std::string small_problem =
    "[spring-mass]\nmass = 1\ndamping = 0.05\nstiffness = 1\nforce = 0.5\n"
    "[stop]\nlaw = kelvin-voigt\ngap = 1\nstiffness = 20\ndamping = 0.1\n"
    "[drive]\nfrequency = edge\n"
    "[design]\nvariable = stop.gap in 0.5 .. 18\nvariable = stop.stiffness in 5 .. 50 log\n"
    "variable = spring-mass.mass in 1 .. 3 integer\n"
    "maximise = peak_force\nlimit = amplitude <= 4\nlimit = contact_time >= 0.2\n";

std::string write_problem(const ScratchFolder& folder) { return folder.write("small.ini", small_problem).string(); }

Outcome explore(const ScratchFolder& folder, const std::string& out, const std::vector<std::string>& options,
                const std::string& prefix = "") {
    std::vector<std::string> arguments = {"explore", write_problem(folder), "--out", out, "--quiet"};
    arguments.insert(arguments.end(), options.begin(), options.end());
    return run(folder, arguments, prefix);
}

/// The tables that must not depend on how the work was done.
std::string tables(const ScratchFolder& folder, const std::string& out) {
    return read_file(folder.path() / out / "designs.csv") + read_file(folder.path() / out / "sensitivities.csv");
}

std::string state_of(const ScratchFolder& folder, const std::string& out) {
    return Json::parse(read_file(folder.path() / out / "manifest.json")).at("state");
}

/// All files of a folder by name.
std::map<std::string, std::string> contents(const fs::path& folder) {
    std::map<std::string, std::string> files;
    for (const auto& entry : fs::directory_iterator(folder)) {
        files[entry.path().filename().string()] = read_file(entry.path());
    }
    return files;
}

std::vector<std::vector<std::string>> cells(const std::string& csv) {
    std::vector<std::vector<std::string>> rows;
    std::istringstream stream(csv);
    for (std::string line; std::getline(stream, line);) {
        std::istringstream words(line);
        auto& row = rows.emplace_back();
        for (std::string word; std::getline(words, word, ',');) { row.push_back(word); }
    }
    return rows;
}

}  // namespace

TEST_CASE("table, sensitivities, summary; the same bytes for any number of threads") {
    const ScratchFolder folder;
    const Outcome outcome = explore(folder, "two", {"--samples", "300", "--jobs", "2", "--json"});
    CAPTURE(outcome.err);
    REQUIRE(outcome.exit_code == 0);
    const Json document = Json::parse(outcome.out);
    CHECK(document.at("schema") == "percuss/explore/1");
    CHECK(document.at("samples") == 300);
    CHECK(document.at("status") == "done");
    int counted = 0;
    for (const auto& [status, times] : document.at("statuses").items()) { counted += times.get<int>(); }
    CHECK(counted == 300);
    CHECK(document.at("statuses").at("no-impact").get<int>() > 10);
    CHECK(document.at("designs_per_second").get<double>() > 0.0);

    const auto rows = cells(read_file(folder.path() / "two" / "designs.csv"));
    REQUIRE(rows.size() == 301);
    CHECK(rows[0] == std::vector<std::string>{"row", "stop.gap [m]", "stop.stiffness [N/m]", "spring-mass.mass [kg]",
                                              "peak_force [N]", "amplitude [m]", "contact_time [s]",
                                              "drive_frequency [Hz]", "status", "cause"});
    // The best design by the table itself; log and integer variables where they belong.
    double best = 0.0;
    std::string best_row;
    int below_geometric_mean = 0;
    std::map<std::string, int> masses;
    for (std::size_t i = 1; i < rows.size(); ++i) {
        CHECK(rows[i][0] == std::to_string(i - 1));
        const double stiffness = std::stod(rows[i][2]);
        CHECK((stiffness >= 5.0 && stiffness <= 50.0));
        below_geometric_mean += stiffness < std::sqrt(5.0 * 50.0) ? 1 : 0;
        ++masses[rows[i][3]];
        if (rows[i][8] != "ok") {
            CHECK(rows[i][4].empty());
            CHECK(rows[i].size() >= 10);  // with a cause, which may have commas in it
            continue;
        }
        const bool feasible = std::stod(rows[i][5]) <= 4.0 && std::stod(rows[i][6]) >= 0.2;
        if (feasible && std::stod(rows[i][4]) > best) {
            best = std::stod(rows[i][4]);
            best_row = rows[i][0];
        }
    }
    CHECK(std::abs(below_geometric_mean - 150) <= 2);  // a Sobol sequence is that even
    REQUIRE(masses.size() == 3);
    for (const char* mass : {"1", "2", "3"}) { CHECK(std::abs(masses[mass] - 100) <= 3); }
    CHECK(std::to_string(document.at("best").at("row").get<int>()) == best_row);
    CHECK(document.at("best").at("quantities").at("peak_force").get<double>() == best);
    REQUIRE(document.at("best").at("limits").size() == 2);
    for (const Json& limit : document.at("best").at("limits")) { CHECK(limit.at("distance").get<double>() >= 0.0); }
    CHECK(document.at("limits").at(0).at("violated").get<int>() >= document.at("limits").at(0).at("alone").get<int>());

    // What grazes at the edge is the free motion: its frequency depends on the mass above all and on the stop's
    // stiffness not at all.
    const auto of = [&](const char* quantity, const char* variable) -> const Json& {
        for (const Json& each : document.at("sensitivities")) {
            const bool all = each.at("edge_kind") == "all";
            if (all && each.at("quantity") == quantity && each.at("variable") == variable) { return each; }
        }
        throw std::runtime_error("no such sensitivity");
    };
    CHECK(of("drive_frequency", "spring-mass.mass").at("first_order").get<double>() > 0.3);
    CHECK(of("drive_frequency", "stop.stiffness").at("first_order").get<double>() < 0.03);
    CHECK(of("drive_frequency", "stop.stiffness").at("dgsm_bound").get<double>() < 1e-12);
    CHECK(of("drive_frequency", "stop.gap").at("dgsm_bound").get<double>() > 0.0);
    CHECK(of("drive_frequency", "spring-mass.mass").at("dgsm_bound").is_null());
    CHECK(of("not_ok", "stop.gap").at("first_order").get<double>() > 0.3);
    CHECK(of("not_ok", "stop.gap").at("used") == 300);
    CHECK(of("peak_force", "stop.gap").at("used") == document.at("statuses").at("ok"));

    const Outcome text = explore(folder, "one", {"--samples", "300", "--jobs", "1"});
    CHECK(text.exit_code == 0);
    for (const char* part : {"300 of 300 designs", "Best feasible design", "Limits", "Which variables matter"}) {
        CAPTURE(part);
        CHECK(has(text.out, part));
    }
    CHECK(tables(folder, "one") == tables(folder, "two"));
    CHECK(has(read_file(folder.path() / "one" / "report.html"), "Which variables matter"));

    const Outcome other_seed = explore(folder, "seed", {"--samples", "300", "--jobs", "2", "--seed", "2"});
    CHECK(other_seed.exit_code == 0);
    CHECK(tables(folder, "seed") != tables(folder, "two"));
}

TEST_CASE("gradients in the journal are the derivatives with respect to the unit cube") {
    // Against differences of the table itself: a grid over one variable, fine enough for central differences.
    const ScratchFolder folder;
    const Outcome outcome = explore(folder, "fine",
                                    {"--sampling", "grid", "--samples", "65", "--design.variable", "none",
                                     "--design.variable", "stop.stiffness in 5 .. 50 log", "--json"});
    CAPTURE(outcome.err);
    REQUIRE(outcome.exit_code == 0);
    const Json document = Json::parse(outcome.out);
    const auto rows = cells(read_file(folder.path() / "fine" / "designs.csv"));
    REQUIRE(rows.size() == 66);
    const double step = 1.0 / 64.0;
    double squares = 0.0;
    double mean = 0.0;
    for (std::size_t i = 1; i < rows.size(); ++i) { mean += std::stod(rows[i][2]) / 65.0; }
    double variance = 0.0;
    for (std::size_t i = 1; i < rows.size(); ++i) { variance += std::pow(std::stod(rows[i][2]) - mean, 2) / 64.0; }
    for (std::size_t i = 1; i < rows.size(); ++i) {
        const std::size_t low = std::max<std::size_t>(i - 1, 1);
        const std::size_t high = std::min<std::size_t>(i + 1, 65);
        squares +=
            std::pow((std::stod(rows[high][2]) - std::stod(rows[low][2])) / (step * static_cast<double>(high - low)),
                     2) /
            65.0;
    }
    const double pi = std::acos(-1.0);
    const Json& peak = document.at("sensitivities").at(0);
    CHECK(peak.at("quantity") == "peak_force");
    // One-sided differences at both ends err by a step's share of the second derivative.
    CHECK(peak.at("dgsm_bound").get<double>() == doctest::Approx(squares / (pi * pi * variance)).epsilon(0.02));
    CHECK(peak.at("first_order").get<double>() == doctest::Approx(1.0).epsilon(1e-3));
}

TEST_CASE("the problem kept in a journal reads back to the same problem") {
    using namespace percuss;
    int problems = 0;
    for (const auto& entry : fs::directory_iterator(fs::path(shipped("crawler.ini")).parent_path())) {
        if (entry.path().extension() != ".ini") { continue; }
        CAPTURE(entry.path().string());
        const std::vector<problem::Setting> options = {{"explore.samples", "100000", true},
                                                       {"explore.columns", "amplitude, status", true},
                                                       {"uniqueness.starts", "1000000", true}};
        problem::ProblemFile original = verbs::read_problem(entry.path(), options, problem::FrequencyUse::ranges);
        original.design.sampling.seed = 18446744073709551615U;
        const std::string text = verbs::exploration_text(original, "v2");
        // Not asked to operate: problems of sweeps have no frequency and no edge.
        if (!model::has_stop(original.design.actuator.law) && !model::has_frequency(original.design.actuator)) {
            continue;
        }
        const problem::ProblemFile again = verbs::parse_exploration(original.name, text, 100000);
        CHECK(verbs::exploration_text(again, "v2") == text);
        CHECK(again.design.sampling.seed == original.design.sampling.seed);
        CHECK(again.get<verbs::ExploreOptions>().samples == 100000);
        CHECK(again.design.sampling.starts == 1000000);
        ++problems;
    }
    CHECK(problems > 10);
}

TEST_CASE("killed at random moments and resumed: as if nothing had happened") {
    const ScratchFolder folder;
    REQUIRE(explore(folder, "whole", {"--samples", "1000", "--jobs", "2"}).exit_code == 0);
    std::mt19937 random(7);
    int killed = 0;
    for (int i = 0; i < 6; ++i) {
        const double seconds = 0.03 + 0.25 * static_cast<double>(random()) / 4294967296.0;
        const Outcome outcome = explore(folder, "killed", {"--samples", "1000", "--jobs", "2", "--resume"},
                                        "timeout -s KILL " + std::to_string(seconds));
        killed += outcome.exit_code == 0 ? 0 : 1;
    }
    CHECK(killed >= 3);
    // Without --resume what is there is safe.
    const Outcome again = explore(folder, "killed", {"--samples", "1000"});
    if (state_of(folder, "killed") != "finished") {
        CHECK(again.exit_code == 2);
        CHECK(has(again.err, "--resume"));
    }
    const Outcome last = explore(folder, "killed", {"--samples", "1000", "--jobs", "1", "--resume"});
    CAPTURE(last.err);
    REQUIRE(last.exit_code == 0);
    CHECK(state_of(folder, "killed") == "finished");
    CHECK(tables(folder, "killed") == tables(folder, "whole"));
    CHECK_FALSE(fs::exists(folder.path() / "killed" / "journal.sqlite-wal"));
}

TEST_CASE("Ctrl-C and the time limit keep finished blocks") {
    for (const bool by_signal : {true, false}) {
        CAPTURE(by_signal);
        // Twice the time on each try, until the machine has finished a block in it.
        long rows = 0;
        for (double seconds = 0.7; rows == 0 && seconds < 60.0; seconds *= 2.0) {
            const ScratchFolder folder;
            const std::string time = std::to_string(seconds);
            std::vector<std::string> options = {"--samples", "100000", "--jobs", "2"};
            if (!by_signal) { options.insert(options.end(), {"--time-limit", time}); }
            const std::string prefix = by_signal ? "timeout --preserve-status --signal=INT " + time : "";
            const Outcome outcome = explore(folder, "out", options, prefix);
            CAPTURE(outcome.err);
            CHECK(outcome.exit_code == (by_signal ? 130 : 4));
            CHECK(state_of(folder, "out") == "interrupted");
            const Json document = Json::parse(read_file(folder.path() / "out" / "result.json"));
            CHECK(document.at("status") == "stopped");
            rows = document.at("samples").get<long>();
            CHECK(rows % 64 == 0);
            CHECK(lines(read_file(folder.path() / "out" / "designs.csv")) == rows + 1);
            CHECK(has(outcome.err, "--resume"));
        }
        CHECK(rows > 0);
    }
}

TEST_CASE("shards merged, and a table extended, equal the one computed at once") {
    const ScratchFolder folder;
    REQUIRE(explore(folder, "whole", {"--samples", "330", "--jobs", "2"}).exit_code == 0);
    for (const char* shard : {"0/3", "1/3", "2/3"}) {
        const Outcome outcome = explore(folder, "part", {"--samples", "330", "--shard", shard});
        CAPTURE(outcome.err);
        REQUIRE(outcome.exit_code == 0);
    }
    const auto shard = [](int i) { return "part-shard-" + std::to_string(i) + "-of-3"; };
    CHECK(tables(folder, shard(1)) != tables(folder, "whole"));

    // One is missing: said, and set right by giving it.
    const Outcome partial = run(folder, {"merge", shard(2), shard(0), "--quiet", "--json"});
    CHECK(partial.exit_code == 4);
    CHECK(lines(partial.err) == 1);
    CHECK(has(partial.err, "shard 1/3"));
    CHECK(Json::parse(partial.out).at("status") == "incomplete");
    const Outcome merged = run(folder, {"merge", shard(2), shard(0), shard(1), "--quiet", "--json"});
    CAPTURE(merged.err);
    REQUIRE(merged.exit_code == 0);
    CHECK(Json::parse(merged.out).at("status") == "done");
    CHECK(tables(folder, "part") == tables(folder, "whole"));
    CHECK(state_of(folder, "part") == "finished");
    const Json manifest = Json::parse(read_file(folder.path() / "part" / "manifest.json"));
    const Json expected = Json::parse(read_file(folder.path() / "whole" / "manifest.json"));
    CHECK(manifest.at("verb") == "explore");
    CHECK(manifest.at("problem").at("hash") == expected.at("problem").at("hash"));

    // A shard that was not finished is named with what to do.
    fs::remove_all(folder.path() / shard(1));
    REQUIRE(explore(folder, "part", {"--samples", "100", "--shard", "1/3"}).exit_code == 0);
    const Outcome short_one = run(folder, {"merge", shard(0), shard(1), shard(2), "--out", "other", "--quiet"});
    CHECK(short_one.exit_code == 4);
    CHECK(has(short_one.err, shard(1)));
    CHECK(has(short_one.err, "--resume"));

    // Rows of the shorter table, its short last block completed.
    REQUIRE(explore(folder, "grown", {"--samples", "100"}).exit_code == 0);
    REQUIRE(explore(folder, "grown", {"--samples", "330", "--resume"}).exit_code == 0);
    CHECK(tables(folder, "grown") == tables(folder, "whole"));
    REQUIRE(explore(folder, "part", {"--samples", "500", "--resume"}).exit_code == 0);
    REQUIRE(explore(folder, "fresh", {"--samples", "500"}).exit_code == 0);
    CHECK(tables(folder, "part") == tables(folder, "fresh"));
    const Outcome fewer = explore(folder, "part", {"--samples", "400", "--resume"});
    CHECK(fewer.exit_code == 2);
    CHECK(lines(fewer.err) == 1);
    CHECK(has(fewer.err, "explore.samples = 400"));
}

TEST_CASE("a journal that cannot be gone on with is left as it is") {
    const ScratchFolder folder;
    REQUIRE(explore(folder, "out", {"--samples", "200"}).exit_code == 0);
    const fs::path out = folder.path() / "out";
    const fs::path journal = out / "journal.sqlite";
    const std::string sound = read_file(journal);
    const std::vector<std::string> go_on = {"--samples", "300", "--resume"};

    for (const std::string& spoilt :
         {std::string("hello\n"), sound.substr(0, sound.size() / 2),
          sound.substr(0, sound.size() / 2) + std::string(200, 'x') + sound.substr(sound.size() / 2 + 200)}) {
        std::ofstream(journal, std::ios::binary) << spoilt;
        const auto before = contents(out);
        const Outcome outcome = explore(folder, "out", go_on);
        CAPTURE(outcome.err);
        CHECK(outcome.exit_code == 2);
        CHECK(lines(outcome.err) == 1);
        CHECK(has(outcome.err, "journal.sqlite"));
        CHECK(contents(out) == before);
    }
    std::ofstream(journal, std::ios::binary) << sound;

    // Another problem: both texts.
    const auto before = contents(out);
    auto another = go_on;
    another.insert(another.end(), {"--spring-mass.damping", "0.06"});
    const Outcome outcome = explore(folder, "out", another);
    CHECK(outcome.exit_code == 2);
    CHECK(has(outcome.err, "spring-mass.damping = 0.05"));
    CHECK(has(outcome.err, "spring-mass.damping = 0.06"));
    CHECK(contents(out) == before);
    // A Latin hypercube cannot grow.
    REQUIRE(explore(folder, "lhs", {"--samples", "70", "--sampling", "lhs"}).exit_code == 0);
    const Outcome grown = explore(folder, "lhs", {"--samples", "140", "--sampling", "lhs", "--resume"});
    CHECK(grown.exit_code == 2);
    CHECK(has(grown.err, "explore.samples = 140"));
    // All is well otherwise.
    CHECK(explore(folder, "out", go_on).exit_code == 0);
}

TEST_CASE("designs that cannot be evaluated keep their row and cause") {
    const ScratchFolder folder;
    const Outcome outcome =
        run(folder, {"explore", shipped("crawler.ini"), "--samples", "32", "--jobs", "2", "--out", "out", "--quiet",
                     "--json", "--design.variable", "actuator.inner_radius in 4 mm .. 12 mm"});
    CAPTURE(outcome.err);
    CHECK(outcome.exit_code == 5);
    CHECK(lines(outcome.err) == 1);
    const Json document = Json::parse(outcome.out);
    CHECK(document.at("samples") == 32);
    const int failed = document.at("statuses").at("failed").get<int>();
    CHECK(failed >= 6);  // inner radii above the outer one: a quarter of the range
    long with_cause = 0;
    std::istringstream table(read_file(folder.path() / "out" / "designs.csv"));
    for (std::string line; std::getline(table, line);) { with_cause += has(line, ",failed,") ? 1 : 0; }
    CHECK(with_cause == failed);
    CHECK(has(read_file(folder.path() / "out" / "designs.csv"), "actuator.outer_radius"));
}

TEST_CASE("columns of the user's choice, no sensitivities, no files") {
    const ScratchFolder folder;
    const Outcome outcome =
        explore(folder, "out",
                {"--samples", "64", "--explore.columns", "impact_velocity, spring-mass.force, edge_kind",
                 "--explore.sensitivities", "off", "--json"});
    CAPTURE(outcome.err);
    REQUIRE(outcome.exit_code == 0);
    const auto rows = cells(read_file(folder.path() / "out" / "designs.csv"));
    CHECK(rows[0] == std::vector<std::string>{"row", "stop.gap [m]", "stop.stiffness [N/m]", "spring-mass.mass [kg]",
                                              "impact_velocity [m/s]", "spring-mass.force [N]", "edge_kind"});
    CHECK(rows[1][5] == "0.5");
    CHECK_FALSE(fs::exists(folder.path() / "out" / "sensitivities.csv"));
    CHECK(Json::parse(outcome.out).at("sensitivities").empty());
    CHECK(Json::parse(outcome.out).at("best").at("row").get<int>() >=
          0);  // limits and objective are known all the same

    const ScratchFolder empty;
    const Outcome none = explore(empty, "none", {"--samples", "64"});
    CHECK(none.exit_code == 0);
    CHECK_FALSE(fs::exists(empty.path() / "none"));
}

TEST_CASE("wrong options are told in one line and leave nothing") {
    const ScratchFolder folder;
    const struct {
        std::vector<std::string> options;
        std::vector<std::string> parts;
    } wrong[] = {
        {{"--explore.columns", "peak_forc"}, {"explore.columns", "peak_forc", "nearest one is peak_force"}},
        {{"--explore.columns", "peak_force,,status"}, {"explore.columns"}},
        {{"--samples", "0"}, {"explore.samples", "'0'", "at least 1"}},
        {{"--sampling", "sobl"}, {"explore.sampling", "sobl", "sobol | lhs | grid"}},
        {{"--sampling", "grid", "--samples", "5"}, {"explore.samples = 5", "too few"}},
        {{"--shard", "3/3"}, {"--shard", "3/3", "from 0 to N - 1"}},
        {{"--shard", "auto"}, {"--shard", "SLURM_ARRAY_TASK_ID"}},
        {{"--explore.sensitivities", "yes"}, {"explore.sensitivities", "on | off"}},
        {{"--resume", "--force"}, {"--resume", "--force"}},
        {{"--design.variable", "none"}, {"design.variable"}},
    };
    for (const auto& each : wrong) {
        const Outcome outcome = explore(folder, "out", each.options, "env -u SLURM_ARRAY_TASK_ID -u PMI_RANK");
        CAPTURE(outcome.err);
        CHECK(outcome.exit_code == 2);
        CHECK(lines(outcome.err) == 1);
        for (const std::string& part : each.parts) {
            CAPTURE(part);
            CHECK(has(outcome.err, part));
        }
    }
    CHECK_FALSE(fs::exists(folder.path() / "out"));
    const Outcome nothing = run(folder, {"merge"});
    CHECK(nothing.exit_code == 2);
    CHECK(has(nothing.err, "SHARD_DIR"));
    CHECK(run(folder, {"merge", "absent-shard-0-of-2"}).exit_code == 2);
    CHECK_FALSE(fs::exists(folder.path() / "absent"));
}
