// Verb attractors as a user runs it.

#include "program_run.hpp"

#include <doctest/doctest.h>
#include <nlohmann/json.hpp>

#include <cmath>

namespace {

namespace fs = std::filesystem;
using percuss::tests::has;
using percuss::tests::lines;
using percuss::tests::Outcome;
using percuss::tests::read_file;
using percuss::tests::results_of;
using percuss::tests::run;
using percuss::tests::ScratchFolder;
using percuss::tests::shipped;
using Json = nlohmann::json;

const Json* with_period(const Json& document, int period) {
    for (const Json& motion : document.at("attractors")) {
        if (motion.at("period") == period) { return &motion; }
    }
    return nullptr;
}

/// What must not depend on how the work was done.
Json without_time(Json document) {
    document.at("cost").erase("seconds");
    return document;
}

}  // namespace

TEST_CASE("three motions at 1.78: document, tables, report, the same for any number of threads") {
    const ScratchFolder folder;
    const std::vector<std::string> arguments = {
        "attractors", shipped("wu2022-nondimensional.ini"), "--nondimensional.omega", "1.78", "--seed", "1"};
    auto with_json = arguments;
    with_json.insert(with_json.end(), {"--json", "--jobs", "2"});
    const Outcome outcome = run(folder, with_json);
    CAPTURE(outcome.err);
    REQUIRE(outcome.exit_code == 0);
    const Json document = Json::parse(outcome.out);
    CHECK(document.at("schema") == "percuss/attractors/1");
    CHECK(document.at("units") == "nondimensional");
    CHECK(document.at("status") == "done");
    CHECK(document.at("operating_point").at("omega") == 1.78);
    CHECK(document.at("operating_point").at("edge_kind") == "given");
    CHECK(document.at("operating_point").at("edge_omega").is_null());
    CHECK(document.at("starts") == 512);
    CHECK(document.at("seed") == 1);
    CHECK(document.at("unclassified") == 0);
    CHECK(document.at("missed_share_bound").get<double>() < 3.0 / 512.0);
    CHECK(document.at("box").at("upper").at(0).get<double>() == doctest::Approx(0.5));
    CHECK(document.at("box").at("lower").at(2) == 1.1);
    REQUIRE(document.at("attractors").size() == 3);
    const Json* first = with_period(document, 1);
    const Json* third = with_period(document, 3);
    const Json* other = with_period(document, 4);
    REQUIRE(first != nullptr);
    REQUIRE(third != nullptr);
    REQUIRE(other != nullptr);
    CHECK(first->at("peak_force").get<double>() == doctest::Approx(3.04).epsilon(2e-3));
    CHECK(std::abs(third->at("peak_force").get<double>() - 5.40627738) < 5.5e-9);
    CHECK(other->at("peak_force").get<double>() > 7.0);
    const double state[] = {0.29736803916883, 0.00169336011957, 1.18102762349808, 1.19292177583379};
    for (std::size_t k = 0; k < 4; ++k) { CHECK(std::abs(third->at("state").at(k).get<double>() - state[k]) < 1e-11); }
    CHECK(third->at("kind") == "periodic");
    CHECK(third->at("contacts") == 2);
    CHECK(third->at("max_multiplier").get<double>() == doctest::Approx(0.67176820).epsilon(1e-8));
    CHECK(third->at("multipliers").size() == 4);
    double shares = 0.0;
    for (const Json& motion : document.at("attractors")) {
        const double share = motion.at("share").get<double>();
        shares += share;
        CHECK(motion.at("share_lower").get<double>() < share);
        CHECK(motion.at("share_upper").get<double>() > share);
        CHECK(motion.at("lyapunov").at("value").get<double>() < 0.0);
        CHECK(share * 512.0 == doctest::Approx(motion.at("starts").get<double>()));
    }
    CHECK(shares == doctest::Approx(1.0));

    const fs::path results = results_of(folder, "wu2022-nondimensional-attractors");
    CHECK(read_file(results / "result.json") == outcome.out);
    const std::string table = read_file(results / "attractors.csv");
    CHECK(lines(table) == 4);
    CHECK(has(table, "period [drive cycles]"));
    CHECK(has(table, "\nperiodic,3,"));
    CHECK(has(read_file(results / "report.html"), "Stable motions"));
    CHECK(Json::parse(read_file(results / "manifest.json")).at("state") == "finished");

    auto alone = arguments;
    alone.insert(alone.end(), {"--json", "--jobs", "1", "--out", "none"});
    CHECK(without_time(Json::parse(run(folder, alone).out)) == without_time(document));

    auto printed = arguments;
    printed.insert(printed.end(), {"--out", "none", "--starts", "100"});
    const Outcome text = run(folder, printed);
    CHECK(text.exit_code == 0);
    for (const char* part : {"Stable motions", "share of the box", "5.40628", "Box of the starts",
                             "100 starts (seed 1)", "95 % confidence"}) {
        CAPTURE(part);
        CHECK(has(text.out, part));
    }
}

TEST_CASE("at the edge, in SI units") {
    const ScratchFolder folder;
    const Outcome outcome = run(folder, {"attractors", shipped("wu2022-actuator.ini"), "--starts", "64", "--json"});
    CAPTURE(outcome.err);
    REQUIRE(outcome.exit_code == 0);
    const Json document = Json::parse(outcome.out);
    CHECK(document.at("units") == "si");
    const Json& point = document.at("operating_point");
    CHECK(point.at("edge_kind") == "grazing");
    CHECK(point.at("omega").get<double>() == doctest::Approx(0.99 * point.at("edge_omega").get<double>()));
    CHECK(point.at("drive_frequency").get<double>() == doctest::Approx(59.5).epsilon(0.01));  // Hz
    const Json* motion = with_period(document, 1);
    REQUIRE(motion != nullptr);
    CHECK(motion->at("peak_force").get<double>() == doctest::Approx(1.27).epsilon(0.01));    // N
    CHECK(motion->at("amplitude").get<double>() == doctest::Approx(0.66e-3).epsilon(0.01));  // m
    CHECK(document.at("box").at("upper").at(0).get<double>() == doctest::Approx(2.5e-3 + 0.6e-3));
    CHECK(has(read_file(results_of(folder, "wu2022-actuator-attractors") / "attractors.csv"), "x' [m/s]"));
}

TEST_CASE("duffing at 1.2 has two motions, and a box of the user's own finds what lies in it") {
    const ScratchFolder folder;
    const std::string duffing = shipped("duffing.ini");
    const Outcome both = run(folder, {"attractors", duffing, "--starts", "64", "--json"});
    REQUIRE(both.exit_code == 0);
    const Json document = Json::parse(both.out);
    CHECK(document.at("attractors").size() == 2);
    CHECK(document.at("attractors").at(0).at("state").size() == 2);

    const Outcome narrow = run(folder, {"attractors", duffing, "--attractors.starts", "64", "--attractors.lower",
                                        "-0.5 -0.1", "--attractors.upper", "-0.3 0.2", "--json", "--out", "none"});
    REQUIRE(narrow.exit_code == 0);
    const Json own = Json::parse(narrow.out);
    REQUIRE(own.at("attractors").size() == 1);
    CHECK(own.at("box").at("lower").at(0).get<double>() == doctest::Approx(-0.5));
    CHECK(own.at("box").at("upper").at(1).get<double>() == doctest::Approx(0.2));
    CHECK(own.at("attractors").at(0).at("amplitude").get<double>() == doctest::Approx(0.41767).epsilon(1e-4));
}

TEST_CASE("chaos is told with its exponent") {
    const ScratchFolder folder;
    const fs::path ueda = folder.write("ueda.ini", "[spring-mass]\nmass = 1\ndamping = 0.05\nstiffness = 0\n"
                                                   "cubic = 1\nforce = 7.5\nomega = 1\n[stop]\nlaw = none\n");
    const std::vector<std::string> arguments = {"attractors", ueda.string(),         "--starts",
                                                "32",         "--attractors.cycles", "300"};
    auto with_json = arguments;
    with_json.emplace_back("--json");
    const Outcome outcome = run(folder, with_json);
    CAPTURE(outcome.err);
    REQUIRE(outcome.exit_code == 0);
    const Json document = Json::parse(outcome.out);
    REQUIRE(document.at("attractors").size() == 1);
    const Json& chaos = document.at("attractors").at(0);
    CHECK(chaos.at("kind") == "chaotic");
    CHECK(chaos.at("period") == 0);
    CHECK(chaos.at("share") == 1.0);
    CHECK(chaos.at("contacts").is_null());
    CHECK(chaos.at("max_multiplier").is_null());
    const double two_pi = 2.0 * std::acos(-1.0);  // a cycle of omega = 1
    const double value = chaos.at("lyapunov").at("value").get<double>() / two_pi;
    const double error = chaos.at("lyapunov").at("error").get<double>() / two_pi;
    // Per second, as the problem is in SI units; omega = 1 rad/s makes a cycle 2 pi seconds.
    CHECK(chaos.at("lyapunov_per_time").at("value").get<double>() == doctest::Approx(value));
    CHECK(std::abs(value - 0.1034) < 1.5 * error);  // Sprott, Chaos and Time-Series Analysis, appendix A
    CHECK(error < 0.006);
    const Outcome text = run(folder, arguments);
    CHECK(has(text.out, "Lyapunov exponent"));
    CHECK(has(text.out, "chaotic"));
}

TEST_CASE("what ends early, and what cannot be done") {
    const struct {
        std::string prefix;
        std::vector<std::string> options;
        int exit_code;
        std::string state;
    } cases[] = {
        {"", {"--time-limit", "2"}, 4, "finished"},
        {"timeout --preserve-status --signal=INT 2", {}, 130, "interrupted"},
    };
    for (const auto& each : cases) {
        const ScratchFolder folder;
        std::vector<std::string> arguments = {
            "attractors", shipped("wu2022-nondimensional.ini"), "--nondimensional.omega", "1.78", "--starts", "1000000",
            "--quiet"};
        arguments.insert(arguments.end(), each.options.begin(), each.options.end());
        const Outcome outcome = run(folder, arguments, each.prefix);
        CAPTURE(outcome.err);
        CHECK(outcome.exit_code == each.exit_code);
        const fs::path results = results_of(folder, "wu2022-nondimensional-attractors");
        CHECK(Json::parse(read_file(results / "manifest.json")).at("state") == each.state);
        const Json document = Json::parse(read_file(results / "result.json"));
        CHECK(document.at("status") == "stopped");
        CHECK(document.at("starts").get<long>() < 1000000);
        CHECK(document.at("starts").get<long>() % 64 == 0);
        // What was kept is what so many starts give, however many the machine had time for.
        REQUIRE(document.at("starts").get<long>() > 0);
        const Outcome whole = run(folder, {"attractors", shipped("wu2022-nondimensional.ini"), "--nondimensional.omega",
                                           "1.78", "--starts", std::to_string(document.at("starts").get<long>()),
                                           "--json", "--quiet", "--out", "none"});
        CHECK(Json::parse(whole.out).at("attractors") == document.at("attractors"));
    }

    const ScratchFolder folder;
    const std::string paper = shipped("wu2022-nondimensional.ini");
    const Outcome weak =
        run(folder, {"attractors", paper, "--nondimensional.phi_pp", "0.1", "--json", "--out", "none"});
    CHECK(weak.exit_code == 3);
    CHECK(Json::parse(weak.out).at("status") == "no-impact");
    const Outcome short_budget = run(folder, {"attractors", paper, "--nondimensional.omega", "1.9", "--starts", "64",
                                              "--attractors.cycles", "2", "--json", "--out", "none"});
    CHECK(short_budget.exit_code == 4);
    const Json document = Json::parse(short_budget.out);
    CHECK(document.at("status") == "unclassified");
    CHECK(document.at("unclassified").get<int>() > 32);
    CHECK(document.at("missed_share_bound").get<double>() > 0.5);

    const struct {
        std::vector<std::string> options;
        std::string part;
    } wrong[] = {
        {{"--starts", "0"}, "attractors.starts"},
        {{"--attractors.cycles", "-1"}, "attractors.cycles"},
        {{"--attractors.lower", "0.2 -0.3 1.1 1.1"}, "attractors.upper is missing"},
        {{"--attractors.lower", "0.2 -0.3"}, "attractors.lower"},
        {{"--attractors.lower", "0.2 0.3 1.1 1.1", "--attractors.upper", "0.5 -0.3 1.3 1.3"}, "entry 2"},
        {{"--attractors.lower", "0.2 0.3 0 1.1", "--attractors.upper", "0.5 0.3 1.3 1.3"}, "positive"},
        {{"--period", "2"}, "--period"},
    };
    for (const auto& each : wrong) {
        std::vector<std::string> arguments = {"attractors", paper, "--nondimensional.omega", "1.9"};
        arguments.insert(arguments.end(), each.options.begin(), each.options.end());
        const Outcome outcome = run(folder, arguments);
        CAPTURE(outcome.err);
        CAPTURE(each.part);
        CHECK(outcome.exit_code == 2);
        CHECK(lines(outcome.err) == 1);
        CHECK(has(outcome.err, each.part));
    }
    CHECK_FALSE(fs::exists(folder.path() / "results"));
}
