// Suspensions without the mirror symmetry: a constant bias, two wells, a stop that presses on the rest position.

#include "program_run.hpp"
#include "relative.hpp"

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include <nlohmann/json.hpp>

using percuss::test::relative;
using percuss::tests::has;
using percuss::tests::Outcome;
using percuss::tests::run;
using percuss::tests::ScratchFolder;
using percuss::tests::shipped;
using Json = nlohmann::json;

namespace {

/// x'' + 0.15 x' - x + x^3 = 0.2 cos t.
constexpr const char* two_wells = "[actuator]\ntype = spring-mass\n"
                                  "[spring-mass]\nmass = 1\ndamping = 0.15\nstiffness = -1\ncubic = 1\nforce = 0.2\n"
                                  "omega = 1\n[stop]\nlaw = none\n";

Outcome answer_of(const ScratchFolder& folder, std::vector<std::string> arguments) {
    arguments.insert(arguments.end(), {"--json", "--quiet", "--out", "none"});
    return run(folder, arguments);
}

Json answer(const std::string& verb, const std::string& file, const std::vector<std::string>& options = {}) {
    const ScratchFolder folder;
    folder.write("problem.ini", file);
    std::vector<std::string> arguments = {verb, "problem.ini"};
    arguments.insert(arguments.end(), options.begin(), options.end());
    const Outcome outcome = answer_of(folder, arguments);
    CAPTURE(outcome.err);
    REQUIRE_FALSE(outcome.out.empty());
    return Json::parse(outcome.out);
}

std::string spring_with_stop(double bias, double gap, const std::string& frequency) {
    return "[actuator]\ntype = spring-mass\n[spring-mass]\nmass = 1\ndamping = 0.1\nstiffness = 1\nforce = 0.3\n"
           "bias = " +
           std::to_string(bias) + "\n[stop]\nlaw = kelvin-voigt\ngap = " + std::to_string(gap) +
           "\nstiffness = 30\ndamping = 0.5\n[drive]\nfrequency = " + frequency + "\n";
}

}  // namespace

TEST_CASE("two wells hold two motions that are mirror images, and the starts find both") {
    const Json document = answer("attractors", two_wells, {"--starts", "512"});
    const Json& motions = document.at("attractors");
    REQUIRE(motions.size() == 2);
    double total = 0.0;
    for (const Json& motion : motions) {
        CHECK(motion.at("period") == 1);
        total += motion.at("share").get<double>();
    }
    CHECK(document.at("unclassified") == 0);
    CHECK(total == relative(1.0, 1e-12));
    // x -> -x, theta -> theta + pi maps one on the other: the extremes change places.
    CHECK(motions[0].at("x_max").get<double>() == relative(-motions[1].at("x_min").get<double>(), 1e-9));
    CHECK(motions[0].at("x_min").get<double>() == relative(-motions[1].at("x_max").get<double>(), 1e-9));
    CHECK(motions[0].at("amplitude").get<double>() == relative(motions[1].at("amplitude").get<double>(), 1e-9));
}

TEST_CASE("a pressed stop has its orbit at a given frequency, and no edge") {
    const Json orbit = answer("orbit", spring_with_stop(0.0, -0.05, "0.1 Hz"));
    CHECK(orbit.at("orbit").at("residual").get<double>() < 1e-10);
    CHECK(orbit.at("orbit").at("contacts").get<int>() >= 1);
    const ScratchFolder folder;
    folder.write("problem.ini", spring_with_stop(0.0, -0.05, "edge"));
    const Outcome edge = answer_of(folder, {"evaluate", "problem.ini"});
    CHECK(edge.exit_code == 2);
    CHECK(has(edge.err, "drive.frequency"));
    CHECK(has(edge.err, "rest"));
}

TEST_CASE("a bias of zero gives the digits of none") {
    for (const char* verb : {"evaluate", "branch"}) {
        CAPTURE(verb);
        const ScratchFolder folder;
        const auto without = answer_of(folder, {verb, shipped("soft-impact.ini")});
        const auto with = answer_of(folder, {verb, shipped("soft-impact.ini"), "--spring-mass.bias", "0 N"});
        Json a = Json::parse(without.out);
        Json b = Json::parse(with.out);
        a.erase("cost");
        b.erase("cost");
        CHECK(a == b);
    }
}

TEST_CASE("with a bias the edge of the linear oscillator has its closed form") {
    // The free motion swings about bias / k1; it grazes when its amplitude is the gap less that.
    const double bias = 0.2;
    const double gap = 1.0;
    const double room = gap - bias;
    const Json document = answer("evaluate", spring_with_stop(bias, gap, "edge"), {"--drive.margin", "0 %"});
    // F^2 = A^2 ((1 - w^2)^2 + c^2 w^2): the upper root in w^2.
    const double c = 0.1;
    const double force = 0.3;
    const double p = 1.0 - 0.5 * c * c;
    const double w2 = p + std::sqrt(p * p - 1.0 + force * force / (room * room));
    CHECK(document.at("operating_point").at("edge_kind") == "grazing");
    CHECK(document.at("operating_point").at("edge_omega").get<double>() == relative(std::sqrt(w2), 1e-11));
}

TEST_CASE("a bias of either sign is felt by gradients") {
    const std::string file = spring_with_stop(0.1, 0.8, "edge");
    const Json exact = answer("evaluate", file, {"--gradients"});
    const double h = 1e-5;
    const auto moved = [&](double bias) {
        const Json document = answer("evaluate", file, {"--spring-mass.bias", std::to_string(bias)});
        return document.at("quantities").at("peak_force").get<double>();
    };
    const double difference =
        (8.0 * (moved(0.1 + h) - moved(0.1 - h)) - (moved(0.1 + 2.0 * h) - moved(0.1 - 2.0 * h))) / (12.0 * h);
    CHECK(exact.at("gradients").at("peak_force").at("spring-mass.bias").get<double>() == relative(difference, 1e-6));
}

TEST_CASE("a search that comes upon designs pressed at rest goes on") {
    const std::string file = spring_with_stop(0.0, 0.5, "edge") +
                             "[design]\nvariable = stop.gap in -0.3 .. 0.9\nmaximise = peak_force\n"
                             "limit = amplitude <= 0.6\n[optimiser]\nsamples = 24\nmethod = slsqp\n";
    const Json document = answer("optimise", file);
    CHECK(document.at("status") == "optimal");
    CHECK(document.at("design").at("stop.gap").get<double>() > 0.0);
}
