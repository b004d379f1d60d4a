// The branch of the soft-impact problem over its upper fold, against AUTO-07p.
//
// Criterion: wall time for the same branch and fold at equal error, as a ratio. There is no bar; exit status 1 only
// when a branch or fold is not found. Where AUTO or gfortran is absent this says so and ends with status 0.
//
// What runs: x'' + 0.02 x' + x + 29 max(x - 1, 0) = 0.152380952381 cos(w t). The impacting motion of one contact per
// drive cycle is followed from w = 1.1 (stable, large) over the fold at 1.572209937 and back down to 1.1 (unstable,
// small). Both programs begin with the same exact motion.
//
//   percuss  branch::trace along the drive frequency
//   AUTO     a boundary value problem of two segments, contact and flight (bench/auto), by orthogonal collocation with
//            Jacobians given, fold detection on, all else that costs time off
//
// Both are tuned to each target. AUTO: of all combinations of NCOL, NTST, EPSL, EPSS, NWTN and DSMAX below, the
// quickest that reaches the target and does so on the next finer mesh too, so that no lucky hit counts. percuss: the
// loosest tolerance at which it and all tighter ones down to a factor of 1000 reach the target, and steps that give at
// least as many points as AUTO has. AUTO's own step control makes do with few points; further targets therefore ask
// AUTO for as many as percuss takes at its default steps.
//
// Error: of the fold's frequency, and of the curve: largest distance in (w, entry phase, entry speed, contact time) of
// a branch's points from the exact curve. Both against soft_impact_exact.hpp, which solves the closed form in long
// double. AUTO writes eleven digits: errors below 1e-10 are not told apart.
//
// Fairness: compiling and the start of a process are not counted: AUTO's time is its own "Total Time", percuss' that of
// branch::trace, in a fresh process each. AUTO's includes the result files it writes, which at this size is little. One
// thread each: AUTO with more is slower on a problem this small (printed too). percuss also computes multipliers and
// follows the whole cycle with the hybrid flow at every point to make sure of the contacts, for which AUTO is not
// asked. The branch ends short of the fold beside grazing and of grazing itself, which percuss treats specially and
// AUTO would need tiny steps for.
//
// Machine: any x86-64. Wall times, minima over interleaved rounds.

#include "auto_program.hpp"
#include "soft_impact_branch.hpp"

#include <cstdio>
#include <cstring>

namespace {

using namespace percuss;
using namespace percuss::bench;

// ---- AUTO

struct Setting {
    int mesh = 0;               ///< NTST
    int order = 0;              ///< NCOL
    double newton = 0.0;        ///< EPSL, EPSU
    double special = 0.0;       ///< EPSS
    int full_newton = 0;        ///< NWTN: full Newton steps before the chord method
    double largest_step = 0.0;  ///< DSMAX

    [[nodiscard]] std::string text() const {
        char line[200];
        std::snprintf(line, sizeof line,
                      "NTST = %d, NCOL = %d\nEPSL = %.0e, EPSU = %.0e, EPSS = %.0e, NWTN = %d\n"
                      "DS = 0.1, DSMIN = 1e-5, DSMAX = %g",
                      mesh, order, newton, newton, special, full_newton, largest_step);
        return line;
    }
    [[nodiscard]] std::string name() const {
        char line[100];
        std::snprintf(line, sizeof line, "%d x %d, %.0e, %.0e, %d, %g", mesh, order, newton, special, full_newton,
                      largest_step);
        return line;
    }
};

struct TheirEntry {
    Setting setting;
    bool confirms = false;  ///< whether the one before it in the list is the same on a coarser mesh
    Achieved achieved;
    double seconds = never;
    double process = never;

    void take(const AutoRun& run) {
        seconds = std::min(seconds, run.solver_seconds);
        process = std::min(process, run.process_seconds);
    }
};

/// Columns of fort.7: w, norm, maxima of four states, then entry phase, contact time and entry speed.
Achieved measure(const AutoRun& run, const Reference& reference) {
    Achieved achieved;
    double fold = never;
    for (const AutoRow& row : run.rows) {
        if (row.columns.size() < 4) { return {}; }
        const double* last = row.columns.data() + row.columns.size() - 1;
        const double w = row.columns.front();
        if (w < from - 1e-9) { continue; }  // one step beyond the end
        reference.add_point(achieved, {w, *(last - 2), *last, *(last - 1)});
        if (row.type == 5) { fold = std::min(fold, std::abs(w - reference.fold)); }
    }
    const bool complete = run.ok && run.rows.back().columns.front() < from;
    if (!complete) { return {}; }
    achieved.fold = fold;
    return achieved;
}

std::vector<Setting> all_but_meshes() {
    std::vector<Setting> list;
    for (const double largest_step : {0.25, 1.0}) {
        for (const double special : {1e-3, 1e-4}) {
            for (const double newton : {1e-5, 1e-6, 1e-7}) {
                for (const int full_newton : {1, 3}) {
                    for (const int order : {3, 4, 5, 6}) {
                        list.push_back({0, order, newton, special, full_newton, largest_step});
                    }
                }
            }
        }
    }
    return list;
}

std::vector<TheirEntry> search(const AutoProgram& program, const Reference& reference) {
    std::vector<TheirEntry> entries;
    for (const Setting& like : all_but_meshes()) {
        bool first = true;
        for (const int mesh : {3, 4, 5, 6, 8}) {
            TheirEntry entry{like, !first, {}};
            entry.setting.mesh = mesh;
            const AutoRun run = program.run(entry.setting.text());
            entry.take(run);
            entry.achieved = measure(run, reference);
            entries.push_back(entry);
            first = false;
        }
    }
    return entries;
}

/// The quickest that reach the limit for good, at most `count`.
std::vector<std::size_t> quickest(const std::vector<TheirEntry>& entries, const Limit& limit, std::size_t count) {
    std::vector<std::size_t> reaching;
    for (std::size_t i = 0; i + 1 < entries.size(); ++i) {
        if (entries[i + 1].confirms && limit.holds(entries[i].achieved) && limit.holds(entries[i + 1].achieved)) {
            reaching.push_back(i);
        }
    }
    std::sort(reaching.begin(), reaching.end(),
              [&](std::size_t a, std::size_t b) { return entries[a].seconds < entries[b].seconds; });
    reaching.resize(std::min(count, reaching.size()));
    return reaching;
}

// ---- one against the other

/// This program run once more for one branch of percuss, in a process of its own as AUTO is.
constexpr const char* once = "--once";

double seconds_once(const AutoProgram& program, const Ours& ours) {
    char tolerance[40];
    char coarseness[40];
    std::snprintf(tolerance, sizeof tolerance, "%.17g", ours.tolerance());
    std::snprintf(coarseness, sizeof coarseness, "%.17g", ours.coarseness());
    const auto answer = program.run_other("/proc/self/exe", {once, tolerance, coarseness});
    return answer ? std::atof(answer->c_str()) : never;
}

int run_once(double tolerance, double coarseness) {
    const Reference reference;
    std::printf("%.9f\n", Ours(tolerance, coarseness, reference).run().seconds);
    return 0;
}

/// The quickest of AUTO's settings by a few more runs of those that seemed quickest; null when none reaches the limit.
const TheirEntry* choose(const AutoProgram& program, std::vector<TheirEntry>& theirs, const Limit& limit) {
    const auto candidates = quickest(theirs, limit, 12);
    for (int round = 0; round < 8; ++round) {
        for (const std::size_t i : candidates) { theirs[i].take(program.run(theirs[i].setting.text())); }
    }
    const auto final = quickest(theirs, limit, 1);
    return final.empty() ? nullptr : &theirs[final.front()];
}

/// Prints one line; false when the target is missed by either.
bool compare(const AutoProgram& program, const Limit& target, std::vector<TheirEntry>& theirs, const OurTable& ours) {
    std::printf("%-6.0e %-6.0e | ", target.fold, target.curve);
    const TheirEntry* chosen = choose(program, theirs, target);
    if (chosen == nullptr) {
        std::printf("not reached by AUTO\n");
        return false;
    }
    Limit limit = target;
    limit.least_points = chosen->achieved.points;
    const OurEntry* mine = choose(ours, limit);
    if (mine == nullptr) {
        std::printf("not reached by percuss\n");
        return false;
    }
    TheirEntry rival = *chosen;
    double own_process = never;
    double by_default = never;
    for (int round = 0; round < 50; ++round) {
        rival.take(program.run(rival.setting.text()));
        own_process = std::min(own_process, seconds_once(program, *mine->ours));
        by_default = std::min(by_default, seconds_once(program, *defaults(ours).ours));
    }
    std::printf("%-28s %3zu %7.1e %7.1e %6.2f | %5.0e, %-4g %3zu %7.1e %7.1e %6.2f %6.2f | %5.1f %6.1f %8.1f\n",
                rival.setting.name().c_str(), rival.achieved.points, rival.achieved.fold, rival.achieved.curve,
                1e3 * rival.seconds, mine->ours->tolerance(), mine->ours->coarseness(), mine->achieved.points,
                mine->achieved.fold, mine->achieved.curve, 1e3 * own_process, 1e3 * mine->seconds,
                rival.seconds / own_process, rival.seconds / mine->seconds, rival.seconds / by_default);
    return true;
}

/// What AUTO makes of more threads, and what starting it costs.
void describe(const AutoProgram& program, const Setting& setting) {
    TheirEntry one;
    TheirEntry all;
    for (int round = 0; round < 10; ++round) {
        one.take(program.run(setting.text(), 1));
        all.take(program.run(setting.text(), 0));
    }
    std::printf("AUTO at %s: %.2f ms in one thread (process %.2f ms), %.2f ms in as many as it takes by itself.\n",
                setting.name().c_str(), 1e3 * one.seconds, 1e3 * one.process, 1e3 * all.seconds);
}

bool run(const std::filesystem::path& auto_folder) {
    const Reference reference;
    const AutoProgram program(auto_folder, PERCUSS_BENCH_DATA "/auto", "soft_impact");
    OurTable ours = our_table(reference);
    time_all(ours);
    std::vector<TheirEntry> theirs = search(program, reference);
    const Achieved& own = defaults(ours).achieved;
    std::printf(
        "Branch from w = %g over the fold at w = %.12f and back.\n"
        "AUTO: NTST x NCOL, EPSL = EPSU, EPSS, NWTN, DSMAX; %zu settings tried. percuss: tolerance, steps in units of\n"
        "the default ones; kernels %s. Errors of the fold and of the curve. Times in ms by the program's own clock in\n"
        "a process of its own, percuss also repeated in one process (warm). Ratios: AUTO's time in units of percuss',\n"
        "of its warm run, and of percuss at its defaults (tolerance 1e-13: %zu points, errors %.1e and %.1e, %.2f ms\n"
        "warm).\n\n"
        "target        | AUTO                         pts fold    curve     time | percuss     pts fold    curve     "
        "time   warm | ratio   warm defaults\n",
        from, reference.fold, theirs.size(), std::string(kernels::instruction_set_in_use("auto")).c_str(), own.points,
        own.fold, own.curve, 1e3 * defaults(ours).seconds);
    bool all = true;
    for (const std::size_t points : {std::size_t{0}, own.points}) {
        if (points > 0) { std::printf("AUTO with at least %zu points:\n", points); }
        for (const double fold : {1e-6, 1e-8, 1e-9}) {
            all = compare(program, {fold, never, points}, theirs, ours) && all;
        }
        all = compare(program, {1e-9, 1e-7, points}, theirs, ours) && all;
    }
    std::printf("\n");
    if (all) { describe(program, choose(program, theirs, {1e-9, never, 0})->setting); }
    std::printf("%s\n", all ? "PASS: the same branch and fold by both" : "FAIL: a target was not reached");
    return all;
}

}  // namespace

int main(int argc, char** argv) {
    if (argc == 4 && std::strcmp(argv[1], once) == 0) { return run_once(std::atof(argv[2]), std::atof(argv[3])); }
    std::string missing;
    const auto auto_folder = AutoProgram::find(missing);
    if (!auto_folder) {
        std::printf("skipped: %s\n", missing.c_str());
        return 0;
    }
    try {
        return run(*auto_folder) ? 0 : 1;
    } catch (const std::exception& error) {
        std::printf("FAIL: %s\n", error.what());
        return 1;
    }
}
