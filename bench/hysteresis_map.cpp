// The whole hysteresis map, against the sweeps that the field makes instead.
//
// Criterion: the map of the default actuator from omega = 1.2 to 4.0 by continuation is at least 30 times faster than
// forward and backward sweeps with the same integrator, and finds the edge (the upper grazing point) to 1e-9 where the
// sweeps find it to one step of frequency. Exit status 0 when it does, 1 when it does not.
//
// The sweeps are those of C. Wu, A. Cai, X. Gao, C. Cao, "Nonlinear Dynamics of a Resonant-Impact Dielectric Elastomer
// Actuator", Appl. Syst. Innov. 2022, 5, 122, section 3: 400 frequencies each way, at each of them the motion is
// followed from the state before until its strobed state changes by less than 1e-6 from one repeat to the next, 500
// drive cycles at most, and then watched for one repeat. They see stable motions only, one at a time. The map is
// verbs::run_branch over the same range: stable and unstable motions, multipliers at every point, all grazing points,
// folds and flips.
//
// The bar applies to the same integrator at the same tolerance, that of the program. The sweeps alone could do with
// less accuracy: the other lines tell what that gains them.
//
// Error of the edge: distance from 1.93541550079 (reference/dea.json of the project, 11 decimals); by the sweeps the
// frequency at which the upward one starts and the downward one ceases to lie on a motion clear of the stop.
//
// Machine: any x86-64; the numbers in commit messages and reports are from two shared cores of an AMD EPYC (Zen 4).
// Times are processor time of one thread, contestants take turns in one process, ratios of minima count.

#include "orbit/frequency_sweep.hpp"
#include "scenes.hpp"
#include "timing.hpp"
#include "verbs/branch/branch.hpp"
#include "verbs/verbs.hpp"

#include <cstdio>
#include <limits>
#include <utility>

namespace {

using namespace percuss;
using namespace percuss::bench;

constexpr double lowest = 1.2;
constexpr double highest = 4.0;
constexpr int frequencies = 400;
constexpr double map_tolerance = 1e-13;  // that of the program
constexpr double bar = 30.0;
constexpr double edge_bar = 1e-9;
constexpr double edge = 1.93541550079;

/// The map as the program makes it, from a motion reached from rest at the upper end of the range.
branch::Branch hysteresis_map(const verbs::StudyProblem& problem) {
    verbs::BranchOptions study;
    study.from = highest;
    study.to = lowest;
    verbs::BranchResult result = verbs::run_branch(problem, study, {}, {});
    return result.branches.empty() ? branch::Branch{} : std::move(result.branches.front());
}

verbs::StudyProblem paper_problem() {
    verbs::StudyProblem problem =
        verbs::study_problem(verbs::read_problem(PERCUSS_BENCH_DATA "/../problems/wu2022-nondimensional.ini", {}));
    problem.design.solver.tolerance = map_tolerance;
    return problem;
}

struct Sweeps {
    std::vector<orbit::SweptPoint> up;
    std::vector<orbit::SweptPoint> down;
};

/// Both sweeps in turn, the downward one on from where the upward one has ended.
Sweeps sweep_both_ways(const flow::Integrator& integrator) {
    std::vector<double> omegas;
    for (int i = 0; i < frequencies; ++i) { omegas.push_back(lowest + (highest - lowest) * i / (frequencies - 1)); }
    orbit::SettlingOptions options;
    options.tolerance = 1e-6;
    options.rule = orbit::SettlingRule::strobed_change;
    options.max_cycles = 500;
    const flow::System system{&integrator, paper_defaults, nullptr};
    Sweeps sweeps;
    sweeps.up = orbit::step_sweep(system, omegas, integrator.rest_state(system.parameters), options);
    std::reverse(omegas.begin(), omegas.end());
    sweeps.down = orbit::step_sweep(system, omegas, sweeps.up.back().extremes.state, options);
    return sweeps;
}

/// The edge as the downward sweep sees it: between the last frequency without contact and the one after.
double swept_edge(const Sweeps& sweeps) {
    for (std::size_t i = 1; i < sweeps.down.size(); ++i) {
        if (sweeps.down[i].extremes.contacts > 0) { return 0.5 * (sweeps.down[i].omega + sweeps.down[i - 1].omega); }
    }
    return std::numeric_limits<double>::quiet_NaN();
}

long cycles_of(const Sweeps& sweeps) {
    long cycles = 0;
    for (const auto* sweep : {&sweeps.up, &sweeps.down}) {
        for (const orbit::SweptPoint& point : *sweep) {
            cycles += point.settling.cycles +
                      (point.settling.settled ? point.settling.period : orbit::SettlingOptions{}.longest_period);
        }
    }
    return cycles;
}

long unsettled(const Sweeps& sweeps) {
    long count = 0;
    for (const auto* sweep : {&sweeps.up, &sweeps.down}) {
        count += std::count_if(sweep->begin(), sweep->end(), [](const auto& point) { return !point.settling.settled; });
    }
    return count;
}

/// The grazing point of the map that is nearest to the edge.
double mapped_edge(const branch::Branch& map) {
    double nearest = std::numeric_limits<double>::infinity();
    for (const branch::BoundaryPoint& found : map.boundaries) {
        if (found.kind == boundary::Kind::grazing && std::abs(found.point.omega - edge) < std::abs(nearest - edge)) {
            nearest = found.point.omega;
        }
    }
    return nearest;
}

bool complete(const branch::Branch& map) {
    const auto count = [&](boundary::Kind kind) {
        return std::count_if(map.boundaries.begin(), map.boundaries.end(),
                             [&](const auto& found) { return found.kind == kind; });
    };
    return map.end == branch::End::range && count(boundary::Kind::grazing) == 2 && count(boundary::Kind::fold) == 2 &&
           count(boundary::Kind::flip) >= 1;
}

}  // namespace

int main() {
    const verbs::StudyProblem problem = paper_problem();
    const branch::Branch map = hysteresis_map(problem);
    const std::array<double, 4> sweep_tolerances = {1e-13, 1e-10, 1e-8, 1e-6};

    std::vector<std::unique_ptr<flow::Integrator>> integrators;
    std::vector<Contestant> contestants = {{"map", [&problem] { hysteresis_map(problem); }}};
    for (const double tolerance : sweep_tolerances) {
        integrators.push_back(make({}, "taylor", tolerance));
        const flow::Integrator* integrator = integrators.back().get();
        contestants.push_back({"sweeps", [integrator] { sweep_both_ways(*integrator); }});
    }
    RoundOptions rounds;
    rounds.rounds = 7;
    const Times times = interleave(contestants, rounds);

    std::printf(
        "Hysteresis map from omega = %g to %g; kernels %s. Ratios: time in units of the map's; ratio of minima,\n"
        "median and lowest of single rounds.\n\n",
        highest, lowest, std::string(kernels::instruction_set_in_use("auto")).c_str());
    std::printf("  %-8s %10s %12s %10s %10s %13s %9s %9s %9s\n", "", "tolerance", "milliseconds", "cycles", "unsettled",
                "error of edge", "ratio", "median", "lowest");
    const double map_error = std::abs(mapped_edge(map) - edge);
    std::printf("  %-8s %10.0e %12.2f %10s %10s %13.1e %9.2f %9.2f %9.2f   %zu points, %zu boundaries, %ld solves\n",
                "map", map_tolerance, 1e3 * times.lowest(0), "", "", map_error, 1.0, 1.0, 1.0, map.points.size(),
                map.boundaries.size(), map.solves);
    double faster = 0.0;
    double sweep_error = 0.0;
    for (std::size_t i = 0; i < sweep_tolerances.size(); ++i) {
        const Sweeps sweeps = sweep_both_ways(*integrators[i]);
        const double error = std::abs(swept_edge(sweeps) - edge);
        const double ratio = times.ratio_of_minima(i + 1, 0);
        std::printf("  %-8s %10.0e %12.2f %10ld %10ld %13.1e %9.2f %9.2f %9.2f\n", "sweeps", sweep_tolerances[i],
                    1e3 * times.lowest(i + 1), cycles_of(sweeps), unsettled(sweeps), error, ratio,
                    times.median_ratio(i + 1, 0), times.lowest_ratio(i + 1, 0));
        if (sweep_tolerances[i] == map_tolerance) {
            faster = ratio;
            sweep_error = error;
        }
    }
    const bool pass = complete(map) && map_error <= edge_bar && faster >= bar;
    std::printf("\n  %s: %.1f times faster, asked for %.0f; edge to %.1e, asked for %.0e (sweeps: %.1e, their\n"
                "  step is %.1e)%s\n",
                pass ? "PASS" : "FAIL", faster, bar, map_error, edge_bar, sweep_error,
                (highest - lowest) / (frequencies - 1), complete(map) ? "" : "; the map is not complete");
    return pass ? 0 : 1;
}
