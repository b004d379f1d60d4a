#include "flow/step_observer.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>

namespace percuss::flow {
namespace {

constexpr std::size_t at(int i) { return static_cast<std::size_t>(i); }

Sensitive negative(Sensitive a) {
    a.value = -a.value;
    for (double& d : a.d) { d = -d; }
    return a;
}

Sensitive modulus(const Sensitive& a) { return a.value < 0.0 ? negative(a) : a; }

/// Total derivative of a value at an event: its own at fixed t, and what the motion of the event adds.
Sensitive moving(Sensitive a, double slope, const Lanes& shift) {
    for (std::size_t j = 0; j < shift.size(); ++j) {
        if (shift[j] != 0.0) { a.d[j] += slope * shift[j]; }
    }
    return a;
}

/// Saltation of the lanes where the force of a damped stop sets in (sign +1) or ceases (-1) on the surface. The event
/// comes earlier by dx/v (overlap dx at fixed time), the force there is delta_i v: their product delta_i dx is what x'
/// loses and the impulse gains, and v times as much is gained by the work. Nothing is divided by v, which is zero at
/// grazing.
void jump(const AugmentedSystem& system, Extended& y, double sign) {
    const double delta = sign * system.damping();
    const double v = system.entry(y, 0, 1);
    const IntegralPlaces& places = system.integrals();
    for (int column = 1; column < system.columns(); ++column) {
        const double overlap = system.entry(y, column, 0);
        system.entry(y, column, 1) -= delta * overlap;
        if (places.impulse >= 0) {
            system.entry(y, column, places.impulse) += delta * overlap;
            system.entry(y, column, places.stop_work) += delta * v * overlap;
        }
    }
}

}  // namespace

void saltate(const AugmentedSystem& system, Extended& y, int saltation) {
    if (saltation != 0) { jump(system, y, -static_cast<double>(saltation)); }
}

void Peak::raise(const Sensitive& candidate, double at_t) {
    if (!found || candidate.value > best.value) {
        best = candidate;
        t = at_t;
        found = true;
    }
}

double Peak::level() const { return found ? best.value : -std::numeric_limits<double>::infinity(); }

StepObserver::StepObserver(const AugmentedSystem& system, std::uint32_t mask, Result& result)
    : system_(system),
      mask_(mask),
      result_(result),
      out_(result.observables) {
    if (observes(observe_acceleration)) { signals_[at(watched_++)] = {SignalKind::acceleration}; }
    const auto peaks = system.rhs().info().peaks;
    for (int k = 0; k < static_cast<int>(peaks.size()); ++k) {
        if (!observes(observe_peak(k))) { continue; }
        for (int part = 0; part < std::min(peaks[at(k)].parts, max_parts); ++part) {
            signals_[at(watched_++)] = {SignalKind::peak, k, part};
        }
    }
}

Peak& StepObserver::peak_of(const Signal& signal) {
    return signal.kind == SignalKind::peak ? peaks_[at(signal.peak)] : acceleration_;
}

bool StepObserver::has_modulus(const Signal& signal) const {
    if (signal.kind == SignalKind::peak) { return system_.rhs().info().peaks[at(signal.peak)].of_modulus; }
    return signal.kind == SignalKind::acceleration;
}

void StepObserver::begin(double t, const Extended& y, bool touching) {
    offer_ends(t, y, touching);
    if (touching) { open_contact(t, y, true); }
}

void StepObserver::end(double t, const Extended& y, bool touching) {
    offer_ends(t, y, touching);
    if (touching) { close_contact({t, {}}, y, true); }
    const auto shifted = [&](const Sensitive& overlap, double sign) {
        Sensitive x = overlap;
        x.value = sign * x.value + system_.origin();
        for (int lane = 0; lane < system_.lanes(); ++lane) {
            x.d[at(lane)] = sign * x.d[at(lane)] + system_.origin_d(lane);
        }
        return x;
    };
    if (watches_extrema()) {
        out_.x_max = shifted(x_max_.best, 1.0);
        out_.x_min = shifted(x_min_negative_.best, -1.0);
        out_.theta_x_max = system_.phase(x_max_.t);
        out_.theta_x_min = system_.phase(x_min_negative_.t);
    }
    // Kelvin-Voigt forces may be negative before release; only a run that never leaves the stop can have a negative
    // largest force.
    const bool always_touching = result_.contacts.size() == 1 && result_.contacts[0].open_in && touching;
    if (always_touching || force_.best.value > 0.0) {  // in flight the force is zero
        out_.peak_force = force_.best;
    }
    out_.theta_peak_force = force_.found ? system_.phase(force_.t) : 0.0;
    out_.impact_velocity = impact_.best;
    out_.peak_acceleration = acceleration_.best;
    for (std::size_t k = 0; k < peaks_.size(); ++k) { out_.peak[k] = peaks_[k].best; }

    const auto integral = [&](int place) {
        Sensitive value;
        if (place >= 0) {
            value.value = system_.entry(y, 0, place);
            for (int lane = 0; lane < system_.lanes(); ++lane) {
                value.d[at(lane)] = system_.entry(y, 1 + lane, place);
            }
        }
        return value;
    };
    const IntegralPlaces& places = system_.integrals();
    out_.impulse = integral(places.impulse);
    out_.stop_work = integral(places.stop_work);
    out_.drive_work = integral(places.drive_work);
    out_.dissipation = integral(places.dissipation);
    for (std::size_t k = 0; k < places.mean.size(); ++k) { out_.mean[k] = integral(places.mean[k]); }
}

void StepObserver::offer_ends(double t, const Extended& y, bool touching) {
    if (watches_extrema()) {
        const Sensitive overlap = sensitive(system_, {SignalKind::overlap}, t, y, touching);
        x_max_.raise(overlap, t);
        x_min_negative_.raise(negative(overlap), t);
    }
    for (int i = 0; i < watched_; ++i) {
        const Signal signal = signals_[at(i)];
        const Sensitive value = sensitive(system_, signal, t, y, touching);
        peak_of(signal).raise(has_modulus(signal) ? modulus(value) : value, t);
    }
}

void StepObserver::piece(const Piece& piece, const TurningPoints& turns) {
    if (watches_extrema()) {
        for (const TurningPoint& turn : turns) {
            Extended y;
            piece.stepper.everything(turn.t, y);
            const Sensitive overlap = sensitive(system_, {SignalKind::overlap}, turn.t, y, piece.touching);
            if (turn.maximum) {
                x_max_.raise(overlap, turn.t);
            } else {
                x_min_negative_.raise(negative(overlap), turn.t);
            }
        }
    }
    const bool watches_force = piece.touching && observes(observe_force);
    if (watched_ == 0 && !watches_force) { return; }
    const MotionPoint right = motion_point(system_, piece.right, piece.right_values, piece.touching);
    for (int i = 0; i < watched_; ++i) {
        const Signal signal = signals_[at(i)];
        watch(signal, peak_of(signal), left_[at(i)], piece, right);
    }
    if (watches_force) { watch({SignalKind::stop_force}, contact_force_, force_left_, piece, right); }
}

void StepObserver::watch(Signal signal, Peak& peak, std::optional<SignalSample>& left, const Piece& piece,
                         const MotionPoint& right_point) {
    const bool by_modulus = has_modulus(signal);
    // The right end of one piece is the left end of the next, unless an event lies between them.
    if (!left) { left = sample(system_, signal, motion_point(system_, piece.left, piece.left_values, piece.touching)); }
    const SignalSample right = sample(system_, signal, right_point);
    const Wanted wanted{by_modulus ? Wanted::Kind::largest_modulus : Wanted::Kind::maxima, peak.level()};
    for (const TurningPoint& turn : turning_points(system_, signal, piece, *left, right, wanted)) {
        Extended y;
        piece.stepper.everything(turn.t, y);
        const Sensitive value = sensitive(system_, signal, turn.t, y, piece.touching);
        peak.raise(by_modulus ? modulus(value) : value, turn.t);
    }
    left = right;
}

void StepObserver::corner(const Crossing& crossing, const Extended& y, bool touching) {
    // What was remembered belongs to the motion before the event.
    left_ = {};
    force_left_.reset();
    if (watched_ == 0) { return; }
    const MotionPoint point = motion_point(system_, crossing.t, system_.values(y), touching);
    for (int i = 0; i < watched_; ++i) {
        const Signal signal = signals_[at(i)];
        // A signal that is smooth through the event is not largest there but by chance, and then at a turning point.
        if (signal.kind == SignalKind::peak && system_.rhs().info().peaks[at(signal.peak)].smooth) { continue; }
        const SignalSample here = sample(system_, signal, point);
        const Sensitive value = moving(sensitive(system_, signal, crossing.t, y, touching), here.slope, crossing.shift);
        peak_of(signal).raise(modulus(value), crossing.t);
    }
}

void StepObserver::enter(const Crossing& crossing, const Extended& y, bool with_impact) {
    open_contact(crossing.t, y, false);
    opened_ = crossing;
    if (!with_impact || !observes(observe_force)) { return; }
    // The speed of impact is that of the flight: it moves with the event by the acceleration before contact.
    const MotionPoint before = motion_point(system_, crossing.t, system_.values(y), false);
    Sensitive speed;
    speed.value = system_.entry(y, 0, 1);
    for (int lane = 0; lane < system_.lanes(); ++lane) { speed.d[at(lane)] = system_.entry(y, 1 + lane, 1); }
    speed = moving(speed, before.along.state[1], crossing.shift);
    impact_.raise(speed, crossing.t);
    Sensitive force;
    force.value = system_.damping() * speed.value;
    for (int lane = 0; lane < system_.lanes(); ++lane) {
        force.d[at(lane)] = system_.damping() * speed.d[at(lane)] + system_.damping_d(lane) * speed.value;
    }
    contact_force_.raise(force, crossing.t);
}

void StepObserver::leave(const Crossing& crossing, const Extended& y) { close_contact(crossing, y, false); }

void StepObserver::open_contact(double t, const Extended& y, bool open) {
    Contact contact;
    contact.theta_in = system_.phase(t);
    contact.state_in = system_.state(system_.values(y));
    contact.open_in = open;
    result_.contacts.push_back(contact);
    opened_ = {t, {}};
    contact_force_ = {};
    if (open && observes(observe_force)) {
        contact_force_.raise(sensitive(system_, {SignalKind::stop_force}, t, y, true), t);
    }
}

void StepObserver::close_contact(const Crossing& crossing, const Extended& y, bool open) {
    Contact& contact = result_.contacts.back();
    contact.theta_out = system_.phase(crossing.t);
    contact.state_out = system_.state(system_.values(y));
    contact.open_out = open;
    if (!observes(observe_force)) { return; }
    if (open) { contact_force_.raise(sensitive(system_, {SignalKind::stop_force}, crossing.t, y, true), crossing.t); }
    contact.peak_force = contact_force_.best.value;
    if (contact_force_.found) {
        if (force_.found) {
            // The smaller one of this contact and the best so far may be the second of all.
            out_.runner_up_force = std::max(out_.runner_up_force, std::min(force_.best.value, contact.peak_force));
        }
        force_.raise(contact_force_.best, contact_force_.t);
    }
    const double omega = system_.omega();
    const double lasted = (crossing.t - opened_.t) / omega;
    out_.contact_time.value += lasted;
    for (int lane = 0; lane < system_.lanes(); ++lane) {
        // d((t_out - t_in)/omega), each end moving with its event.
        out_.contact_time.d[at(lane)] +=
            (crossing.shift[at(lane)] - opened_.shift[at(lane)] - lasted * system_.omega_d(lane)) / omega;
    }
}

}  // namespace percuss::flow
