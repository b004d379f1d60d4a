#include "flow/stepwise_run.hpp"

#include "flow/bracketed_root.hpp"

#include <cmath>
#include <cstddef>
#include <limits>

namespace percuss::flow {
namespace {

constexpr std::size_t at(int i) { return static_cast<std::size_t>(i); }

/// Relative to the duration: what is left behind an event is then rounding.
constexpr double shortest_restart = 8.0 * std::numeric_limits<double>::epsilon();
/// Durations shorter than this change nothing that double precision could tell, and are beyond what SUNDIALS can do.
constexpr double shortest_duration = 1e-60;
/// Whether the run is to end early is asked every so many steps; a step takes some ten microseconds.
constexpr long steps_between_questions = 64;

/// Whether every number of the run is finite: values, lanes and integrals alike.
bool all_finite(const AugmentedSystem& system, const Extended& y) {
    for (int i = 0; i < system.size(); ++i) {
        if (!std::isfinite(y[at(i)])) { return false; }
    }
    return true;
}

}  // namespace

StepwiseRun::StepwiseRun(const AugmentedSystem& system, Stepper& stepper, const Request& request, Result& result)
    : system_(system),
      stepper_(stepper),
      request_(request),
      rules_(model::contact_rules(system.rhs().contact_law(), system.damping() != 0.0)),
      result_(result),
      observer_(system, request.observe, result) {}

bool StepwiseRun::hybrid() const { return request_.stop == StopMode::hybrid && rules_.has_stop; }

void StepwiseRun::run() {
    begin();
    while (ongoing() && advance()) {
        const Piece step = step_as_piece();
        // Turning points of the overlap cost a search per step; free runs without extrema do without.
        const bool turns_matter = hybrid() || observer_.watches_extrema();
        const TurningPoints turns = turns_matter ? turns_of(SignalKind::overlap, step) : TurningPoints{};
        const std::optional<Event> event = hybrid() ? first_event(step, turns) : std::nullopt;
        observe(step, turns, event);
        if (event) {
            cross(*event);
        } else if (stepper_.right() == limit()) {
            stepper_.everything(stepper_.right(), y_);
            t_ = stepper_.right();
            result_.status = Status::ok;
        }
    }
    finish();
}

void StepwiseRun::begin() {
    y_ = system_.initial(request_.state);
    phase_ = first_phase();
    if (request_.starts_in_contact && hybrid()) { system_.entry(y_, 0, 0) = 0.0; }
    if (!all_finite(system_, y_) || !system_.rhs().meaningful(system_.state(system_.values(y_)))) {
        result_.status = Status::diverged;
        return;
    }
    observer_.begin(t_, y_, touching());
    if (std::abs(request_.duration) < shortest_duration) {
        result_.status = Status::ok;
        return;
    }
    restart();
}

StepwiseRun::Phase StepwiseRun::first_phase() const {
    if (request_.stop == StopMode::held) { return Phase::contact; }
    if (!hybrid()) { return Phase::free; }
    const State values = system_.values(y_);
    if (request_.starts_in_contact) { return rules_.entry().next; }
    return rules_.first_phase(values[0], system_.stop_force(values));
}

void StepwiseRun::restart() {
    if (!stepper_.start(t_, y_, touching(), limit())) { result_.status = Status::diverged; }
}

bool StepwiseRun::advance() {
    if (result_.steps >= request_.max_steps) {
        result_.status = Status::too_many_steps;
        return false;
    }
    if (result_.steps % steps_between_questions == 0 && is_cancelled(request_)) {
        result_.status = Status::cancelled;
        return false;
    }
    ++result_.steps;
    if (!stepper_.advance() || !system_.rhs().meaningful(system_.state(stepper_.right_values()))) {
        result_.status = Status::diverged;
        return false;
    }
    return true;
}

Piece StepwiseRun::step_as_piece() {
    return {stepper_, stepper_.left(), stepper_.right(), stepper_.left_values(), stepper_.right_values(), touching()};
}

SignalSample StepwiseRun::sample_at(SignalKind kind, double t, const State& values) const {
    return kind == SignalKind::overlap ? overlap_sample(system_, values)
                                       : sample(system_, {kind}, motion_point(system_, t, values, touching()));
}

TurningPoints StepwiseRun::turns_of(SignalKind kind, const Piece& piece) const {
    return turning_points(system_, {kind}, piece, sample_at(kind, piece.left, piece.left_values),
                          sample_at(kind, piece.right, piece.right_values), Wanted{});
}

std::optional<StepwiseRun::Event> StepwiseRun::first_event(const Piece& step, const TurningPoints& turns) {
    std::optional<Event> first;
    std::optional<TurningPoints> force_turns;
    for (const model::Transition& row : rules_.from(phase_)) {
        const bool by_force = row.watched == model::Watched::force;
        // The slope of the force needs right-hand sides, so its turning points are sought only where a row watches it.
        if (by_force && !force_turns) { force_turns = turns_of(SignalKind::stop_force, step); }
        const auto t = first_crossing(by_force ? SignalKind::stop_force : SignalKind::overlap, row.direction > 0, step,
                                      by_force ? *force_turns : turns);
        if (t && (!first || *t < first->t)) { first = Event{&row, *t}; }
    }
    return first;
}

std::optional<double> StepwiseRun::first_crossing(SignalKind kind, bool upward, const Piece& step,
                                                  const TurningPoints& turns) {
    const auto end_at = [&](double t, const State& values) -> RootEnd {
        const SignalSample s = sample_at(kind, t, values);
        return {t, {s.value, s.slope}};
    };
    const auto evaluate = [&](double t) {
        State values{};
        stepper_.values(t, values);
        return end_at(t, values);
    };
    const auto crossing_between = [&](const RootEnd& a, const RootEnd& b) -> std::optional<double> {
        const double side = upward ? 1.0 : -1.0;
        // At a turning point one of the two slopes is zero up to rounding, with any sign: the larger one tells which
        // way the function goes.
        const double trend = std::abs(a.sample.slope) > std::abs(b.sample.slope) ? a.sample.slope : b.sample.slope;
        const double way = side * trend * (step.right - step.left);
        // Rounding and the method's own error may set the function beyond zero while it is moving back.
        if (!(side * b.sample.value > 0.0) || !(way > 0.0)) { return std::nullopt; }
        if (!opposite_signs(a.sample.value, b.sample.value)) {
            return a.at;  // on the surface, or over it by rounding, and moving on
        }
        return bracketed_root(a, b, [&](double t) { return evaluate(t).sample; });
    };
    RootEnd a = end_at(step.left, step.left_values);
    for (const TurningPoint& turn : turns) {
        const RootEnd b = evaluate(turn.t);
        if (const auto t = crossing_between(a, b)) { return t; }
        a = b;
    }
    return crossing_between(a, end_at(step.right, step.right_values));
}

void StepwiseRun::observe(Piece piece, TurningPoints turns, const std::optional<Event>& event) {
    if (!observer_.watches_steps() && !(touching() && (request_.observe & observe_force) != 0U)) { return; }
    if (event) {
        // Behind the event the step describes a motion that does not take place.
        while (turns.count > 0 && turns.points[at(turns.count - 1)].t > event->t) { --turns.count; }
        piece.right = event->t;
        stepper_.values(piece.right, piece.right_values);
    }
    observer_.piece(piece, turns);
}

Crossing StepwiseRun::crossing(const Event& event) const {
    Crossing result{event.t, {}};
    const SignalKind kind = event.row->watched == model::Watched::force ? SignalKind::stop_force : SignalKind::overlap;
    const double slope = sample_at(kind, event.t, system_.values(y_)).slope;
    const Sensitive value = sensitive(system_, {kind}, event.t, y_, touching());
    for (int lane = 0; lane < system_.lanes(); ++lane) {
        const double d = value.d[at(lane)];
        // The shift of the event, -dh/(dh/dt). Where nothing moves it there is no shift, also at grazing, where the
        // slope is zero.
        result.shift[at(lane)] = d == 0.0 ? 0.0 : -d / slope;
    }
    return result;
}

void StepwiseRun::cross(const Event& event) {
    if (++events_ > request_.max_events) {
        result_.status = Status::too_many_events;
        return;
    }
    t_ = event.t;
    stepper_.everything(t_, y_);
    const model::Transition& row = *event.row;
    const bool by_gap = row.watched == model::Watched::gap;
    if (row.on_surface) { system_.entry(y_, 0, 0) = 0.0; }
    const Crossing place = crossing(event);
    // Accelerations jump at the event: the values on both sides of it are candidates for peaks.
    observer_.corner(place, y_, touching());
    if (row.next == Phase::contact) {
        observer_.enter(place, y_, by_gap);
    } else if (touching()) {
        observer_.leave(place, y_);
    }
    saltate(system_, y_, row.saltation);
    phase_ = row.next;
    observer_.corner(place, y_, touching());
    // No method starts over a stretch that rounding makes up.
    if (std::abs(limit() - t_) <= shortest_restart * std::abs(limit())) {
        result_.status = Status::ok;
    } else {
        restart();
    }
}

void StepwiseRun::finish() {
    const State values = system_.values(y_);
    result_.state = system_.state(values);
    result_.rhs_evaluations = system_.evaluations();
    if (result_.status != Status::ok) { return; }
    observer_.end(t_, y_, touching());
    for (int lane = 0; lane < system_.lanes(); ++lane) {
        for (int i = 0; i < system_.states(); ++i) {
            result_.state_d[at(i)][at(lane)] = system_.entry(y_, 1 + lane, i);
        }
        result_.state_d[0][at(lane)] += system_.origin_d(lane);
    }
    system_.state_rate(t_, values.data(), touching(), result_.rate.data());
    if (request_.stop == StopMode::held) { divide(); }
    result_.rhs_evaluations = system_.evaluations();
}

void StepwiseRun::divide() {
    const State values = system_.values(y_);
    const double duration = request_.duration;
    const double omega = system_.omega();
    const bool no_time = std::abs(duration) < shortest_duration;
    const Sensitive force = sensitive(system_, {SignalKind::stop_force}, t_, y_, true);
    const double unit = system_.stiffness() * std::abs(duration) + system_.damping();
    Sensitive& gap = result_.divided_gap;
    Sensitive& share = result_.divided_force;
    gap.value = no_time ? values[1] / omega : values[0] / duration;
    share.value = unit > 0.0 ? force.value / unit : 0.0;
    for (int lane = 0; lane < system_.lanes(); ++lane) {
        gap.d[at(lane)] = no_time ? (system_.entry(y_, 1 + lane, 1) - gap.value * system_.omega_d(lane)) / omega
                                  : system_.entry(y_, 1 + lane, 0) / duration;
        const double unit_d = system_.stiffness_d(lane) * std::abs(duration) + system_.damping_d(lane);
        share.d[at(lane)] = unit > 0.0 ? (force.d[at(lane)] - share.value * unit_d) / unit : 0.0;
    }
}

}  // namespace percuss::flow
