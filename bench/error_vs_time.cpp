// Run time against achieved error: Taylor, ARKODE (explicit Runge-Kutta 13-7-8) and CVODE (BDF) over one drive period
// of four motions, at tolerances 1e-6 to 1e-15. CSV on stdout, one row per integrator, scene and tolerance:
//
//   integrator, scene, tolerance, achieved_error, relative_time, steps
//
// Criterion: for a given achieved error (the x axis of a plot; the tolerance only labels the points) the lowest time
// wins. relative_time is in units of the Taylor integrator at tolerance 1e-12 on the same scene.
//
// Reference: the state at the end of the period by the Taylor method in 80-bit long double at order 30 (reference.hpp);
// achieved_error is the largest difference over the state. Below about 2e-15 it is rounding.
//
// Scenes: the actuator at the defaults of the paper and omega = 1.9, one blow; the same with a stop forty times as
// stiff; a stop damped three times critically on which the mass lies for a quarter of the period, which is stiff; the
// soft-impact oscillator of published results.
//
// Fairness: ARKODE and CVODE run as percuss ships them, with the printed equations as right-hand side; orbit_cost.cpp
// tells what a faster right-hand side would gain them (up to a factor of two).
//
// Machine: any x86-64. Processor time of one thread, minima over interleaved rounds in one process.

#include "reference.hpp"
#include "scenes.hpp"
#include "timing.hpp"

#include <cstdio>

namespace {

using namespace percuss;
using namespace percuss::bench;

struct Scene {
    const char* name;
    SceneKind kind;
    flow::ParameterVector parameters;
    flow::Request request;
};

flow::Request period_from(const flow::State& state, double phase) {
    flow::Request request = cycles_from(state);
    request.theta = phase;
    return request;
}

std::vector<Scene> scenes() {
    using namespace model::membrane;
    const flow::ParameterVector stiff = with(paper_defaults, stiffness, 1e5);
    flow::ParameterVector damped = with(with(with(stiff, damping, 2000.0), omega, 0.5), gap, 0.01);
    return {
        {"default", {}, paper_defaults, period_from(paper_orbit, 0.0)},
        {"stiff-stop", {}, stiff, period_from({0.286154798506, -0.042051850882, 1.177952197235, 1.196265365907}, 0.0)},
        {"overdamped-stop",
         {},
         damped,
         period_from({0.380528594717, 0.002989136824, 1.183539778580, 1.186091079761}, 0.0)},
        {"soft-impact",
         {&model::spring::scene},
         soft_impact,
         period_from({-1.150752085546, 0.011476584513, 0.0, 0.0}, 3.30939)},
    };
}

struct Entry {
    std::string integrator;
    double tolerance = 0.0;
    std::unique_ptr<flow::Integrator> flow;
    flow::Result result;
};

void print_scene(const Scene& scene) {
    const flow::State exact = reference_end(scene.kind, scene.parameters, scene.request);
    std::vector<Entry> entries;
    std::size_t unit = 0;
    for (const char* integrator : {"taylor", "erk", "cvode"}) {
        for (double tolerance : tolerances(1e-6, 1e-15, 1)) {
            if (entries.size() < 10 && std::abs(std::log10(tolerance) + 12.0) < 0.5) { unit = entries.size(); }
            entries.push_back({integrator, tolerance, make(scene.kind, integrator, tolerance), {}});
        }
    }
    std::vector<Contestant> contestants;
    for (Entry& entry : entries) {
        contestants.push_back(
            {entry.integrator, [&entry, &scene] { entry.flow->run(scene.parameters, scene.request, entry.result); }});
    }
    const Times times = interleave(contestants, {.rounds = 10});
    for (std::size_t i = 0; i < entries.size(); ++i) {
        const Entry& entry = entries[i];
        if (entry.result.status != flow::Status::ok) { continue; }
        std::printf("%s,%s,%.0e,%.3e,%.4g,%ld\n", entry.integrator.c_str(), scene.name, entry.tolerance,
                    distance(entry.result.state, exact), times.ratio_of_minima(i, unit), entry.result.steps);
    }
    std::fflush(stdout);
}

}  // namespace

int main() {
    std::printf("integrator,scene,tolerance,achieved_error,relative_time,steps\n");
    for (const Scene& scene : scenes()) { print_scene(scene); }
    return 0;
}
