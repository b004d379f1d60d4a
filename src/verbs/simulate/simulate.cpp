#include "verbs/simulate/simulate.hpp"

#include "design/evaluate.hpp"
#include "design/integrators.hpp"
#include "design/operating_point.hpp"
#include "orbit/polish.hpp"
#include "verbs/limits.hpp"
#include "verbs/simulate/time_series.hpp"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <deque>
#include <numbers>
#include <stdexcept>

namespace percuss::verbs {
namespace {

using std::numbers::pi;

/// A membrane that strikes takes 10 to 20 steps of the Taylor integrator a drive cycle, some 20 times as many of
/// ARKODE.
constexpr double steps_per_cycle = 2000.0;

/// The actuator at its operating point, at the start of the series.
struct Scenario {
    model::Scaled scaled;
    design::Integrators integrators;
    flow::Cost cost;
    flow::System system;
    flow::State start{};
    orbit::Orbit edge_orbit;  ///< not ok without one
};

void check(const SimulateOptions& study) {
    if (study.cycles < 1) { throw std::invalid_argument("simulate.cycles: allowed is at least 1"); }
    if (study.samples < 1) { throw std::invalid_argument("simulate.samples: allowed is at least 1"); }
    if (study.kick && !(study.kick->at >= 0.0 && study.kick->end() <= study.cycles)) {
        throw std::invalid_argument("simulate.kick: must lie within the " + std::to_string(study.cycles) +
                                    " cycles of the series");
    }
}

/// False when there is no frequency to run at; the result says why.
bool choose_frequency(const StudyProblem& problem, Scenario& at, SimulateResult& result) {
    const flow::System scout{at.integrators.scout.get(), at.scaled.parameters, &at.cost};
    design::OperationOptions options;
    options.margin = problem.design.margin;
    const design::Operation operation =
        design::operate({problem.design.actuator, at.scaled, at.system, scout}, options);
    result.operating_point = operation.point;
    if (!operation.found()) {
        const bool no_impact = operation.status == design::OperationStatus::no_impact;
        result.ending = no_impact ? Ending::infeasible : Ending::some_failed;
        result.reason = "there is no edge to operate at: " + operation.reason;
        return false;
    }
    at.system = operation.system;
    if (operation.edge) { at.edge_orbit = design::reach_motion(operation).orbit; }
    return true;
}

/// The orbit to start on, at phase 0; nothing, with the reason in the result, when there is none.
std::optional<flow::State> orbit_at_zero(const StudyProblem& problem, const SimulateOptions& study, const Scenario& at,
                                         SimulateResult& result) {
    orbit::Orbit found;
    if (study.orbit_start) {
        const flow::State guess = design::from_user(*study.orbit_start, "orbit.start", *problem.design.actuator.type,
                                                    at.scaled.scales, at.system.states());
        found = orbit::polish_orbit(at.system, guess, study.orbit_period);
        result.reason = "no orbit to start on: Newton's method from orbit.start did not converge";
    } else if (result.operating_point.edge_kind == design::EdgeKind::given) {
        const design::Evaluator evaluator(problem.design);
        design::Demand demand;
        demand.cancelled = at.cost.cancelled;
        // As the verb orbit finds it, so that both tell the same motion.
        const auto orbit = evaluator.orbit(problem.design.actuator, std::nullopt, study.orbit_period, demand).orbit;
        if (!orbit.state.empty()) {
            return design::from_user(orbit.state, "orbit", *problem.design.actuator.type, at.scaled.scales,
                                     at.system.states());
        }
        result.reason = "no orbit to start on: the motion from rest does not settle on one of " +
                        std::to_string(study.orbit_period) + " drive cycles";
    } else {
        if (study.orbit_period != 1) {
            throw std::invalid_argument("orbit.period = " + std::to_string(study.orbit_period) +
                                        ": at an edge the motion has period 1; give orbit.start, or a frequency");
        }
        found = at.edge_orbit;
        result.reason = "no orbit to start on below the edge";
    }
    if (!found.ok()) {
        result.ending = Ending::some_failed;
        return std::nullopt;
    }
    result.reason.clear();
    return orbit::state_at_zero(at.system, found);
}

/// The state at phase 0 that the series starts from; false when there is none, with the reason in the result.
bool choose_start(const StudyProblem& problem, const SimulateOptions& study, Scenario& at, SimulateResult& result) {
    std::optional<flow::State> start;
    switch (study.from) {
        case SimulationStart::rest: start = at.system.integrator->rest_state(at.system.parameters); break;
        case SimulationStart::state:
            start = design::from_user(study.start, "simulate.start", *problem.design.actuator.type, at.scaled.scales,
                                      at.system.states());
            break;
        case SimulationStart::orbit: start = orbit_at_zero(problem, study, at, result); break;
    }
    if (!start) {
        result.ending = Ending::some_failed;
        return false;
    }
    at.start = *start;
    result.start = design::to_user(at.start, at.scaled.scales, at.system.states());
    return true;
}

/// The last strobed states, oldest first.
/// One more than the longest period that settling recognises: the change over such a period needs both of its ends.
constexpr std::size_t remembered = 13;
using Strobes = std::deque<flow::State>;

/// What the series leaves behind for judging the motion.
struct Course {
    std::optional<flow::State> at_kick;  ///< just before the kick
    Strobes before_kick;
};

/// Follows the series cycle by cycle, sample by sample, with the kick where it belongs.
class SeriesWriter {
public:
    SeriesWriter(const SimulateOptions& study, const model::Scales& scales, TimeSeries& series)
        : study_(study),
          series_(series),
          kick_speed_(study.kick ? study.kick->velocity * scales.time / scales.length : 0.0) {}

    [[nodiscard]] const Course& course() const { return course_; }

    void begin() {
        strobes_.push_back(series_.state());
        series_.write_row();
        kick_if_due();
    }

    /// One drive cycle; false when the flow was lost.
    bool cycle(int number) {
        for (const double position : stations(number)) {
            if (!series_.advance(position)) { return false; }
            if (position == number + 1) { remember(series_.state()); }
            kick_if_due();
        }
        return true;
    }

private:
    /// Where the series halts in a drive cycle: at its samples, and at the beginning and end of the kick, which take
    /// the place of a sample that rounding alone keeps apart from them.
    [[nodiscard]] std::vector<double> stations(int number) const {
        // In drive cycles. A sample at 50 + 7/20 and a kick at 50.35 may differ in the last digit: one place, not two
        // rows.
        constexpr double apart = 1e-9;
        std::vector<double> stations;
        for (int i = 1; i <= study_.samples; ++i) {
            stations.push_back(number + static_cast<double>(i) / study_.samples);
        }
        if (study_.kick) {
            for (const double position : {study_.kick->at, study_.kick->end()}) {
                if (!(position > number && position <= number + 1)) { continue; }
                // The end of the cycle stays: it is compared exactly when states at phase 0 are remembered.
                std::erase_if(stations, [&](double s) { return s < number + 1 && std::abs(s - position) < apart; });
                stations.push_back(position);
            }
        }
        std::sort(stations.begin(), stations.end());
        stations.erase(std::unique(stations.begin(), stations.end()), stations.end());
        return stations;
    }

    void remember(const flow::State& strobe) {
        strobes_.push_back(strobe);
        if (strobes_.size() > remembered) { strobes_.pop_front(); }
    }

    void kick_if_due() {
        if (!study_.kick) { return; }
        const Kick& kick = *study_.kick;
        const bool begins = series_.position() == kick.at;
        const bool ends = kick.kind == Kick::Kind::drive && series_.position() == kick.end();
        if (!begins && !ends) { return; }
        if (begins) {
            course_.at_kick = series_.state();
            course_.before_kick = strobes_;
        }
        if (kick.kind == Kick::Kind::velocity) {
            series_.add_velocity(kick_speed_);
        } else {
            series_.scale_drive(ends ? 1.0 : kick.share);
        }
        series_.write_row();
    }

    const SimulateOptions& study_;
    TimeSeries& series_;
    double kick_speed_;
    Strobes strobes_;
    Course course_;
};

/// The motion that would have gone on without the kick, from the next phase 0.
SettledMotion undisturbed(const Scenario& at, const Course& course, double kick_at) {
    flow::State state = *course.at_kick;
    const double rest_of_cycle = std::ceil(kick_at) - kick_at;
    if (rest_of_cycle > 0.0) {
        flow::Request request;
        request.state = state;
        request.theta = 2.0 * pi * (kick_at - std::floor(kick_at));
        request.duration = 2.0 * pi * rest_of_cycle;
        // As in TimeSeries::advance().
        request.max_events = 1024;
        flow::Result result;
        at.system.run(request, result);
        if (result.status != flow::Status::ok) {
            SettledMotion lost;
            lost.status = result.status;
            return lost;
        }
        state = result.state;
    }
    return identify_motion(at.system, state, at.scaled.scales);
}

/// Relative change of the state at phase 0 over the last period of the series; absent where the series is shorter.
double change_over(const flow::System& system, const Strobes& strobes, int period) {
    const auto back = static_cast<std::size_t>(period);
    if (period < 1 || strobes.size() <= back) { return design::absent; }
    return orbit::relative_distance(system, strobes[strobes.size() - 1 - back], strobes.back());
}

/// fell or rose: to a motion with the smaller or larger peak force.
KickOutcome outcome_of(const flow::System& system, const SettledMotion& before, const SettledMotion& after) {
    if (!before.settled || !after.settled) { return KickOutcome::undecided; }
    if (same_motion(system, before, after)) { return KickOutcome::recovered; }
    // Two motions that do not strike differ in amplitude alone.
    const bool strikes = before.peak_force > 0.0 || after.peak_force > 0.0;
    const bool weaker = strikes ? after.peak_force < before.peak_force : after.amplitude < before.amplitude;
    return weaker ? KickOutcome::fell : KickOutcome::rose;
}

void judge(const SimulateOptions& study, const Scenario& at, const Course& course, const TimeSeries& series,
           SimulateResult& result) {
    result.after = identify_motion(at.system, series.state(), at.scaled.scales);
    if (!study.kick) { return; }
    result.before = undisturbed(at, course, study.kick->at);
    result.change_before = change_over(at.system, course.before_kick, result.before->period);
    result.outcome = outcome_of(at.system, *result.before, *result.after);
}

/// The series itself; false when it did not reach its end.
bool follow(const SimulateOptions& study, SeriesWriter& writer, const TimeSeries& series, const Observer& observer,
            SimulateResult& result) {
    writer.begin();
    for (int cycle = 0; cycle < study.cycles; ++cycle) {
        if (!writer.cycle(cycle)) {
            result.ending = Ending::some_failed;
            result.reason = "the motion was lost in drive cycle " + std::to_string(cycle + 1) + ": " +
                            std::string(flow::to_string(series.status()));
            return false;
        }
        if (observer) { observer(static_cast<double>(cycle + 1) / study.cycles, "time series"); }
    }
    return true;
}

void simulate(const StudyProblem& problem, const SimulateOptions& study, Scenario& at, RowSink* rows, RowSink* contacts,
              const Observer& observer, SimulateResult& result) {
    if (!choose_frequency(problem, at, result) || !choose_start(problem, study, at, result)) { return; }
    TimeSeries series(at.system, problem.design.actuator, at.scaled.scales, at.start, rows, contacts);
    SeriesWriter writer(study, at.scaled.scales, series);
    const bool complete = follow(study, writer, series, observer, result);
    series.finish();
    result.cycles = series.position();
    result.contacts = series.contacts_met();
    result.peak_force = at.scaled.scales.force * series.peak_force();
    result.end_state = design::to_user(series.state(), at.scaled.scales, at.system.states());
    if (!complete) { return; }
    judge(study, at, writer.course(), series, result);
    if (!cut_short(at.cost, result)) { result.ending = Ending::verified; }
}

}  // namespace

std::string_view to_string(KickOutcome outcome) {
    switch (outcome) {
        case KickOutcome::none: return "none";
        case KickOutcome::recovered: return "recovered";
        case KickOutcome::fell: return "fell";
        case KickOutcome::rose: return "rose";
        case KickOutcome::undecided: return "undecided";
    }
    return "unknown";
}

SimulateResult run_simulate(const StudyProblem& problem, const SimulateOptions& study, RowSink* series,
                            RowSink* contacts, const Observer& observer, const numerics::CancelRequest& cancelled) {
    const auto begun = std::chrono::steady_clock::now();
    check(study);
    SimulateResult result;
    Scenario at{model::scale(problem.design.actuator),
                design::make_integrators(problem.design),
                limited_cost(cancelled, study.cycles, steps_per_cycle),
                {},
                {},
                {}};
    at.system = {at.integrators.own.get(), at.scaled.parameters, &at.cost};
    simulate(problem, study, at, series, contacts, observer, result);
    // A frequency or start that was not found because of a limit is told as the limit.
    if (result.ending != Ending::verified) { (void)cut_short(at.cost, result); }
    result.periods = at.cost.periods();
    result.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - begun).count();
    return result;
}

}  // namespace percuss::verbs
