// The Taylor kernels of the x86-64 levels v2, v3 and v4 against each other, for 0, 4 and 8 sensitivities, one drive
// period of the impacting orbit of the dielectric elastomer actuator at omega = 1.9, tolerance 1e-13.
//
// Criterion: no level is slower than the one below it, and with sensitivities, which are the lanes that the wider
// registers hold, every level gains. Exit status 1 when a level is more than 5 % slower than the one below it.
//
// Reference: v2 (SSE4.2, two doubles per register) with the same number of sensitivities; the states at the end agree
// to the error that is printed, not to the bit, because v3 and v4 contract multiplications and additions.
//
// Machine: one that has all levels; those that it lacks are left out. Processor time of one thread, ratios of minima
// over interleaved rounds in one process.

#include "scenes.hpp"
#include "timing.hpp"

#include <cstdio>

namespace {

using namespace percuss;
using namespace percuss::bench;

struct Kernel {
    std::string set;
    int lanes = 0;
    std::unique_ptr<flow::Integrator> integrator;
    std::vector<flow::Direction> directions;
    flow::Request request;
    flow::Result result;
};

}  // namespace

int main() {
    constexpr double tolerated = 1.05;
    const auto sets = kernels::instruction_sets();
    constexpr std::array<int, 3> lane_counts = {0, 4, 8};
    std::vector<Kernel> all;
    for (int lanes : lane_counts) {
        for (std::string_view set : sets) {
            Kernel kernel{std::string(set),         lanes, make({}, "taylor", 1e-13, set), directions(4, lanes),
                          cycles_from(paper_orbit), {}};
            all.push_back(std::move(kernel));
        }
    }
    std::vector<Contestant> contestants;
    for (Kernel& kernel : all) {
        kernel.request.directions = kernel.directions;
        contestants.push_back(
            {kernel.set, [&kernel] { kernel.integrator->run(paper_defaults, kernel.request, kernel.result); }});
    }
    const Times times = interleave(contestants, {.rounds = 100});

    bool pass = true;
    std::printf("%-6s %5s %14s %20s %14s %10s %12s\n", "set", "lanes", "time / lowest", "time / same, 0 lanes",
                "microseconds", "steps", "error");
    for (std::size_t i = 0; i < all.size(); ++i) {
        const std::size_t level = i % sets.size();
        const std::size_t weakest = i - level;
        std::printf("%-6s %5d %14.3f %20.3f %14.2f %10ld %12.1e\n", all[i].set.c_str(), all[i].lanes,
                    times.ratio_of_minima(i, weakest), times.ratio_of_minima(i, level), times.microseconds(i),
                    all[i].result.steps, distance(all[i].result.state, paper_orbit));
        pass = pass && (level == 0 || times.ratio_of_minima(i, i - 1) <= tolerated);
    }
    std::printf("%s\n", pass ? "PASS" : "FAIL");
    return pass ? 0 : 1;
}
