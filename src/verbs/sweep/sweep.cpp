#include "verbs/sweep/sweep.hpp"

#include "design/integrators.hpp"
#include "model/number_text.hpp"
#include "orbit/frequency_sweep.hpp"
#include "verbs/limits.hpp"
#include "verbs/sweep/sweep_findings.hpp"

#include <algorithm>
#include <array>
#include <atomic>
#include <chrono>
#include <cmath>
#include <future>
#include <mutex>
#include <stdexcept>

namespace percuss::verbs {
namespace {

// The range reaches from well below the resonance of the free motion to twice it, where a linear spring with a hard
// stop at its rest position would resonate.
constexpr double default_from = 0.6;  // of the linear resonance
constexpr double default_to = 2.0;
/// The longest sweep that options allow must fit, at the 10 to 20 steps of the Taylor integrator a drive cycle.
constexpr double steps_per_cycle = 50.0;

/// What both directions share.
struct Sweep {
    Sweep(const design::Problem& problem, const SweepOptions& how, const Observer& watcher,
          const numerics::CancelRequest& request)
        : study(how),
          observer(watcher),
          cancelled(request),
          scaled(model::scale(problem.actuator)),
          integrators(design::make_integrators(problem)) {}

    const SweepOptions& study;
    const Observer& observer;
    const numerics::CancelRequest& cancelled;
    model::Scaled scaled;
    design::Integrators integrators;
    double from = 0.0;  ///< omega
    double to = 0.0;
    std::atomic<long> points_done = 0;
    std::mutex mutex;  ///< of the observer

    [[nodiscard]] long points_in_all() const {
        return 2L * (study.mode == SweepMode::steps ? study.steps + 1 : study.chirp_cycles);
    }
    /// Most drive cycles of one direction.
    [[nodiscard]] double cycles_in_all() const {
        return study.mode == SweepMode::steps ? (study.steps + 1.0) * study.max_cycles
                                              : static_cast<double>(study.chirp_cycles) + study.max_cycles;
    }
    /// False when the sweep must end.
    bool report(const std::string& line) {
        const long done = ++points_done;
        if (observer) {
            const std::lock_guard lock(mutex);
            observer(static_cast<double>(done) / static_cast<double>(points_in_all()), line);
        }
        return !(cancelled && cancelled());
    }
};

/// What was seen of a motion; omega stays nondimensional. Extremes stay absent where the flow was lost.
SweepPoint in_user_units(double omega, const orbit::Extremes& extremes, const model::Scales& scales) {
    SweepPoint point;
    point.omega = omega;
    point.drive_frequency = design::drive_frequency(omega, scales);
    if (extremes.status != flow::Status::ok) { return point; }
    point.x_max = scales.length * extremes.x_max;
    point.x_min = scales.length * extremes.x_min;
    point.amplitude = scales.length * extremes.amplitude();
    point.peak_force = scales.force * extremes.peak_force;
    point.contacts = extremes.contacts;
    return point;
}

/// The same with how it settled; without a settled motion the period is 0.
SweepPoint in_user_units(const orbit::SweptPoint& swept, const model::Scales& scales, int states) {
    SweepPoint point = in_user_units(swept.omega, swept.extremes, scales);
    point.cycles = swept.settling.cycles;
    point.settled = swept.settling.settled && swept.extremes.status == flow::Status::ok;
    point.period = point.settled ? swept.settling.period : 0;
    point.strobed_change = swept.settling.change;
    point.remaining_error = swept.settling.remaining_error;
    point.state = design::to_user(swept.settling.state, scales, states);
    return point;
}

/// A point that a limit cut short is none: nothing was found out there.
bool is_cut_short(flow::Status status) {
    return status == flow::Status::cancelled || status == flow::Status::budget_spent;
}

std::string lost(flow::Status status, double omega) {
    return "the motion was lost at omega = " + std::to_string(omega) + ": " + std::string(flow::to_string(status));
}

orbit::SettlingOptions settling_options(const SweepOptions& study) {
    orbit::SettlingOptions options;
    options.tolerance = study.tolerance;
    options.max_cycles = study.max_cycles;
    options.longest_period = study.longest_period;
    return options;
}

/// Frequencies omega in the order in which they are visited. Both directions take them from one formula, so that points
/// can be compared by equal omega.
std::vector<double> frequencies(const Sweep& sweep, bool forward) {
    std::vector<double> omegas;
    const int steps = sweep.study.steps;
    for (int i = 0; i <= steps; ++i) {
        // The last one exactly: rounding would move the end of the range.
        omegas.push_back(i == steps ? sweep.to : sweep.from + (sweep.to - sweep.from) * i / steps);
    }
    if (!forward) { std::reverse(omegas.begin(), omegas.end()); }
    return omegas;
}

/// A step sweep in one direction: each frequency starts from where the one before settled.
void step(Sweep& sweep, const flow::System& system, const flow::State& rest, SweepDirection& direction) {
    orbit::step_sweep(system, frequencies(sweep, direction.forward), rest, settling_options(sweep.study),
                      [&](const orbit::SweptPoint& swept) {
                          const auto status =
                              swept.settling.status != flow::Status::ok ? swept.settling.status : swept.extremes.status;
                          if (is_cut_short(status)) { return false; }
                          direction.points.push_back(in_user_units(swept, sweep.scaled.scales, system.states()));
                          if (status != flow::Status::ok) { direction.trouble = lost(status, swept.omega); }
                          return sweep.report("step sweep");
                      });
    direction.jumps = find_jumps(direction.points);
}

/// A chirp in one direction, from the motion settled on at its first frequency.
void chirp(Sweep& sweep, const flow::System& system, const flow::State& rest, SweepDirection& direction) {
    const double from = direction.forward ? sweep.from : sweep.to;
    const double to = direction.forward ? sweep.to : sweep.from;
    const auto settled = orbit::settle_until_repeating(system.at_omega(from), rest, settling_options(sweep.study));
    if (settled.status != flow::Status::ok) {
        direction.trouble = lost(settled.status, from);
        return;
    }
    orbit::chirp(system, from, to, sweep.study.chirp_cycles, settled.state, [&](const orbit::ChirpCycle& cycle) {
        if (is_cut_short(cycle.extremes.status)) { return false; }
        direction.points.push_back(in_user_units(cycle.omega, cycle.extremes, sweep.scaled.scales));
        direction.points.back().cycles = 1;
        if (cycle.extremes.status != flow::Status::ok) { direction.trouble = lost(cycle.extremes.status, cycle.omega); }
        return sweep.report("chirp");
    });
    direction.jumps = find_chirp_jumps(direction.points);
}

/// One direction, from rest. It has its own cost, so a limit ends each by itself.
SweepDirection go(Sweep& sweep, bool forward) {
    SweepDirection direction;
    direction.forward = forward;
    // One cost per direction: they may run at the same time, and a cost belongs to one thread.
    flow::Cost cost = limited_cost(sweep.cancelled, sweep.cycles_in_all(), steps_per_cycle);
    flow::System system{sweep.integrators.own.get(), sweep.scaled.parameters, &cost};
    const flow::State rest = system.integrator->rest_state(system.parameters);
    (sweep.study.mode == SweepMode::steps ? step : chirp)(sweep, system, rest, direction);
    direction.periods = cost.periods();
    direction.limit = cost.allowance();
    if (direction.limit != flow::Status::ok) { direction.trouble = design::reason_of_limit(cost); }
    return direction;
}

std::vector<SweepDirection> go_both_ways(Sweep& sweep, int jobs) {
    std::vector<SweepDirection> directions;
    // The directions are independent, so the points are the same either way.
    if (jobs > 1) {
        auto backward = std::async(std::launch::async, [&] { return go(sweep, false); });
        directions.push_back(go(sweep, true));
        directions.push_back(backward.get());
    } else {
        for (const bool forward : {true, false}) { directions.push_back(go(sweep, forward)); }
    }
    return directions;
}

/// Ends of the sweep as nondimensional omega. Throws std::invalid_argument for an empty range.
void set_range(Sweep& sweep) {
    const double resonance = sweep.integrators.own->linear_resonance(sweep.scaled.parameters);
    const double unit = sweep.scaled.scales.time;
    sweep.from = sweep.study.from ? unit * *sweep.study.from : default_from * resonance;
    sweep.to = sweep.study.to ? unit * *sweep.study.to : default_to * resonance;
    if (!(sweep.from > 0.0 && sweep.from < sweep.to)) {
        throw std::invalid_argument(
            "sweep.from (here omega = " + model::number_text(sweep.from) +
            ") must be above 0 and below sweep.to (here omega = " + model::number_text(sweep.to) + ")");
    }
}

void check(const SweepOptions& study) {
    if (study.steps < 1) { throw std::invalid_argument("sweep.steps: allowed is at least 1"); }
    if (study.chirp_cycles < 1) { throw std::invalid_argument("sweep.chirp_cycles: allowed is at least 1"); }
}

/// The header of the table: states as far as the problem has them.
std::vector<Column> columns(const StudyProblem& problem, SweepMode mode) {
    const bool plain = problem.design.actuator.type->nondimensional;
    const auto unit = [&](const char* name) { return plain ? std::string() : std::string(name); };
    std::vector<Column> header = {{"omega", unit("rad/s")}, {"drive_frequency", unit("Hz")}, {"direction", ""}};
    if (mode == SweepMode::steps) {
        for (const char* name : {"cycles", "settled", "period", "strobed_change", "remaining_error"}) {
            header.push_back({name, ""});
        }
    }
    for (const char* name : {"amplitude", "x_max", "x_min"}) { header.push_back({name, unit("m")}); }
    header.push_back({"peak_force", unit("N")});
    header.push_back({"contacts", ""});
    if (mode == SweepMode::chirp) { return header; }
    for (const model::StateInfo& state : problem.design.actuator.type->states) {
        header.push_back({std::string(state.name), plain ? std::string() : std::string(state.unit)});
    }
    return header;
}

/// `time`: the unit of time [s], 1 for a nondimensional problem.
std::vector<double> row_of(const SweepPoint& point, bool forward, SweepMode mode, std::size_t width, double time) {
    std::vector<double> row = {point.omega / time, point.drive_frequency, forward ? 1.0 : -1.0};
    if (mode == SweepMode::steps) {
        row.insert(row.end(), {static_cast<double>(point.cycles), point.settled ? 1.0 : 0.0,
                               static_cast<double>(point.period), point.strobed_change, point.remaining_error});
    }
    row.insert(row.end(), {point.amplitude, point.x_max, point.x_min, point.peak_force,
                           std::isnan(point.amplitude) ? design::absent : static_cast<double>(point.contacts)});
    row.insert(row.end(), point.state.begin(), point.state.end());
    row.resize(width, design::absent);
    return row;
}

void write(const SweepResult& result, const StudyProblem& problem, SweepMode mode, RowSink& rows) {
    const std::vector<Column> header = columns(problem, mode);
    rows.header(header);
    const model::Specification& spec = problem.design.actuator;
    const double time = spec.type->nondimensional ? 1.0 : model::scale(spec).scales.time;
    for (const SweepDirection& direction : result.directions) {
        for (const SweepPoint& point : direction.points) {
            rows.row(row_of(point, direction.forward, mode, header.size(), time));
        }
    }
}

/// An interruption is told before a trouble, and of two troubles the first.
void conclude(const Sweep& sweep, SweepResult& result) {
    long points = 0;
    for (const SweepDirection& direction : result.directions) {
        points += static_cast<long>(direction.points.size());
        if (direction.limit == flow::Status::cancelled) {
            result.ending = Ending::interrupted;
            result.reason = "stopped before the end";
        } else if (!direction.trouble.empty() && result.reason.empty()) {
            result.ending = direction.limit == flow::Status::ok ? Ending::some_failed : Ending::budget;
            result.reason = (direction.forward ? "forward: " : "backward: ") + direction.trouble;
        }
    }
    if (result.ending != Ending::not_run) { return; }
    // Without trouble in either direction, points are missing only where the sweep was cancelled between two of them.
    result.ending = points == sweep.points_in_all() ? Ending::verified : Ending::interrupted;
    if (result.ending == Ending::interrupted) { result.reason = "stopped before the end"; }
}

}  // namespace

SweepResult run_sweep(const StudyProblem& problem, const SweepOptions& study, RowSink* rows, const Observer& observer,
                      const numerics::CancelRequest& cancelled) {
    const auto start = std::chrono::steady_clock::now();
    check(study);
    Sweep sweep(problem.design, study, observer, cancelled);
    set_range(sweep);

    SweepResult result;
    result.from_omega = sweep.from;
    result.to_omega = sweep.to;
    result.from = design::drive_frequency(sweep.from, sweep.scaled.scales);
    result.to = design::drive_frequency(sweep.to, sweep.scaled.scales);
    result.directions = go_both_ways(sweep, problem.jobs);
    conclude(sweep, result);
    if (study.mode == SweepMode::steps) {
        result.comparison = compare(result.directions[0].points, result.directions[1].points, study.tolerance);
    }
    if (rows != nullptr) { write(result, problem, study.mode, *rows); }
    result.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
    return result;
}

}  // namespace percuss::verbs
