// Many starts of one actuator followed at once, eight as the lanes of SIMD vectors (Integrator::run_ensemble of the
// Taylor integrator), against one run after another: 64 starts over 4 drive cycles, for each instruction set. One row
// per scene, tolerance and set:
//
//   microseconds per simulated drive cycle and start, one by one and in lanes; their ratio; the largest error of both
//   at the end of the last cycle; the difference between them; contacts of all starts together.
//
// Criterion: in lanes at least 2.5 times the throughput on v4 (AVX-512), twice on v3, and no set slower than one by
// one, at an error of the same size. A run by itself is no scalar code: it works on both membranes at once, in the two
// doubles of its registers, which is why the actuator gains less than the oscillator. Exit status 1 when that fails.
//
// Reference: the state at the end by the Taylor method in 80-bit long double at order 30 (reference.hpp), for the first
// 8 starts.
//
// Scenes: the dielectric elastomer actuator at the defaults of the paper, at omega = 1.78 where it impacts and at 3.0
// where it soon stays clear of the stop; the soft-impact oscillator of published results. The starts are a box around
// rest: what a search for attractors starts from.
//
// Machine: any x86-64; sets that it lacks are left out. Processor time of one thread, ratios of minima over interleaved
// rounds in one process.

#include "reference.hpp"
#include "scenes.hpp"
#include "timing.hpp"

#include <cstdio>

namespace {

using namespace percuss;
using namespace percuss::bench;

constexpr int cycles = 4;
constexpr std::size_t start_count = 64;
constexpr std::size_t checked = 8;

struct Scene {
    const char* name;
    SceneKind kind;
    flow::ParameterVector parameters;
    flow::State centre;
    flow::State spread;  ///< half widths of the box
};

std::vector<Scene> scenes() {
    const flow::State rest = {0.4, 0.0, 1.185, 1.185};
    const flow::State spread = {0.09, 0.2, 0.02, 0.02};
    return {{"impacting", {}, with(paper_defaults, model::membrane::omega, 1.78), rest, spread},
            {"free", {}, with(paper_defaults, model::membrane::omega, clear_omega), rest, spread},
            {"soft-impact", {&model::spring::scene}, soft_impact, {0.0, 0.0}, {1.5, 1.5}}};
}

/// Points that fill the box evenly: an additive recurrence with the powers of the root of g^5 = g + 1.
std::vector<flow::State> starts(const Scene& scene) {
    constexpr double g = 1.1673039782614187;
    std::vector<flow::State> list(start_count);
    for (std::size_t i = 0; i < start_count; ++i) {
        double step = 1.0;
        for (std::size_t k = 0; k < list[i].size(); ++k) {
            step /= g;
            const double position = 0.5 + step * static_cast<double>(i + 1);
            list[i][k] = scene.centre[k] + scene.spread[k] * (2.0 * (position - std::floor(position)) - 1.0);
        }
    }
    return list;
}

struct Way {
    std::unique_ptr<flow::Integrator> integrator;
    bool in_lanes = false;
    std::vector<flow::EnsembleMember> members;
};

double largest_error(const std::vector<flow::EnsembleMember>& members, const std::vector<flow::State>& exact) {
    double largest = 0.0;
    for (std::size_t i = 0; i < exact.size(); ++i) {
        largest = std::max(largest, distance(members[i].state, exact[i]));
    }
    return largest;
}

bool print_scene(const Scene& scene, double tolerance, const std::vector<flow::State>& exact) {
    const auto sets = kernels::instruction_sets();
    const std::vector<flow::State> list = starts(scene);
    flow::EnsembleRequest request;
    request.states = list;
    request.duration = two_pi * cycles;
    std::vector<Way> ways;
    for (std::string_view set : sets) {
        for (bool in_lanes : {false, true}) {
            ways.push_back(
                {make(scene.kind, "taylor", tolerance, set), in_lanes, std::vector<flow::EnsembleMember>(start_count)});
        }
    }
    std::vector<Contestant> contestants;
    for (Way& way : ways) {
        contestants.push_back({"", [&] {
                                   if (way.in_lanes) {
                                       way.integrator->run_ensemble(scene.parameters, request, way.members);
                                   } else {
                                       way.integrator->flow::Integrator::run_ensemble(scene.parameters, request,
                                                                                      way.members);
                                   }
                               }});
    }
    const Times times = interleave(contestants, {.rounds = 15});

    bool pass = true;
    for (std::size_t i = 0; i < ways.size(); i += 2) {
        const std::vector<flow::EnsembleMember>& one = ways[i].members;
        const std::vector<flow::EnsembleMember>& many = ways[i + 1].members;
        double apart = 0.0;
        int contacts = 0;
        for (std::size_t k = 0; k < start_count; ++k) {
            apart = std::max(apart, distance(one[k].state, many[k].state));
            contacts += many[k].contacts;
            pass = pass && one[k].status == flow::Status::ok && many[k].status == flow::Status::ok &&
                   one[k].contacts == many[k].contacts;
        }
        const std::string_view set = sets[i / 2];
        const double ratio = times.ratio_of_minima(i, i + 1);
        constexpr double unit = 1.0 / (cycles * static_cast<double>(start_count));
        std::printf("%-12s %7.0e %-8s %10.3f %10.3f %8.2f %10.1e %10.1e %10.1e %9d\n", scene.name, tolerance,
                    std::string(set).c_str(), times.microseconds(i) * unit, times.microseconds(i + 1) * unit, ratio,
                    largest_error(one, exact), largest_error(many, exact), apart, contacts);
        const double least = set == "v4" ? 2.5 : set == "v3" ? 2.0 : 1.0;
        pass = pass && ratio >= least && largest_error(many, exact) <= 2.0 * largest_error(one, exact);
    }
    return pass;
}

}  // namespace

int main() {
    bool pass = true;
    std::printf("%-12s %7s %-8s %10s %10s %8s %10s %10s %10s %9s\n", "scene", "tol", "set", "one by one", "lanes",
                "ratio", "error one", "error lane", "apart", "contacts");
    for (const Scene& scene : scenes()) {
        std::vector<flow::State> exact;
        for (const flow::State& state : starts(scene)) {
            if (exact.size() == checked) { break; }
            exact.push_back(reference_end(scene.kind, scene.parameters, cycles_from(state, cycles)));
        }
        for (double tolerance : {1e-13, 1e-8}) { pass = print_scene(scene, tolerance, exact) && pass; }
    }
    std::printf("%s\n", pass ? "PASS" : "FAIL");
    return pass ? 0 : 1;
}
