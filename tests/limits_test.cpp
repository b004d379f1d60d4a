// Stiff or absurd problems end with the time limit and with Ctrl-C, inside the integrator too.

#include "program_run.hpp"

#include <chrono>
#include <doctest/doctest.h>

using namespace percuss::tests;

TEST_CASE("time limits and signals reach into the integrator") {
    const std::vector<std::string> absurd[] = {
        // stiff: 20 million steps and 20 s without an orbit
        {"orbit", shipped("wu2022-fig8.ini"), "--material.maxwell_viscosity", "1e-6", "--drive.frequency", "0.01",
         "--orbit.period", "12"},
        // starts in a stop so damped that it is stiff
        {"evaluate", shipped("wu2022-nondimensional.ini"), "--nondimensional.delta_i", "1e4", "--design.single_stable",
         "sampled", "--uniqueness.starts", "100000"},
        // more than a minute in the search for the edge
        {"simulate", shipped("soft-impact.ini"), "--spring-mass.mass", "1e-12", "--solver.integrator", "erk"}};
    const struct {
        const char* prefix;
        const char* limit;
        int code;
    } ends[] = {{"", "0.5", 4}, {"timeout --preserve-status --signal=INT 0.5", "60", 130}};
    const ScratchFolder folder;
    for (const auto& end : ends) {
        for (std::vector<std::string> arguments : absurd) {
            CAPTURE(arguments[0]);
            CAPTURE(end.code);
            arguments.insert(arguments.end(), {"--time-limit", end.limit, "--out", "none", "--quiet"});
            const auto begun = std::chrono::steady_clock::now();
            const Outcome outcome = run(folder, arguments, end.prefix);
            const std::chrono::duration<double> took = std::chrono::steady_clock::now() - begun;
            CHECK(outcome.exit_code == end.code);
            CHECK(lines(outcome.err) == 1);  // the reason
            CHECK(took.count() < 5.0);       // half a second, and what a busy or instrumented machine adds
        }
    }
}
