#include "branch/corner.hpp"

#include "boundary/critical.hpp"
#include "orbit/polish.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace percuss::branch {
namespace {

using boundary::Kind;
using numerics::Vector;
using orbit::Form;
using orbit::Motion;
using std::numbers::pi;

/// Entry speed, relative to size x omega, at which a contact is looked at beside its grazing point: the parameter moves
/// with the square of it.
constexpr double small_speed = 1e-6;

/// That speed at this parameter, nondimensional.
double slow(const flow::ParameterFamily& family, double parameter, const TraceOptions& options) {
    return small_speed * options.size * family.at(parameter).omega();
}

/// The sequence with one contact at a very small speed, next to its grazing motion.
std::optional<CurvePoint> point_beside_grazing(const flow::ParameterFamily& family, const Motion& grazing,
                                               double parameter, int contact, const TraceOptions& options) {
    Motion motion = grazing;
    motion.sequence.contacts[static_cast<std::size_t>(contact)].speed = slow(family, parameter, options);
    Piece piece(family, motion, options.size, options.steps);
    if (!piece.start_with_speed(motion, parameter, contact)) { return std::nullopt; }
    Look seen = look(family, piece.motion(), piece.parameter());
    if (!seen.ok()) { return std::nullopt; }
    return CurvePoint{piece.point(), piece.slope(), std::move(seen.point)};
}

/// The same motion without one of its contacts.
Motion without(const flow::System& system, const Motion& motion, int contact, const Point& near) {
    Motion rest = motion;
    auto& contacts = rest.sequence.contacts;
    contacts.erase(contacts.begin() + contact);
    if (!contacts.empty()) { return rest; }
    // With the last contact gone the form changes, to the state at phase 0 of a motion that knows no stop; over half a
    // cycle where the symmetry allows, as free motions are followed everywhere.
    rest.form = Form::free;
    orbit::Orbit orbit;
    orbit.map.stop = flow::StopMode::off;
    orbit.map.period = motion.period;
    orbit.map.phase = near.phase;
    orbit.state = near.state;
    rest.state = orbit::state_at_zero(system, orbit);
    rest.phase = 0.0;
    return orbit::halved_if_symmetric(system, rest);
}

/// The way along the branch on which the motion has the contacts of its form and no other.
std::optional<double> real_side(const flow::ParameterFamily& family, const Motion& motion, double parameter,
                                const TraceOptions& options, double preferred) {
    // Scaled steps: 1e-3 is far enough from grazing for the hybrid flow to tell contact from none and mostly near
    // enough to meet no other boundary; a longer and a shorter one are tried where it is not.
    for (double step : {1e-3, 1e-2, 1e-4}) {
        // Either way: a branch may turn back at a corner as well as go on.
        for (double direction : {preferred, -preferred}) {
            Piece piece(family, motion, options.size, options.steps);
            if (!piece.start(motion, parameter, direction)) { continue; }
            piece.set_step(step);
            if (!piece.advance()) { continue; }
            const Look seen = look(family, piece.motion(), piece.parameter());
            const bool leaves = contact_leaving(piece.motion()).has_value();
            if (seen.ok() && !leaves && seen.point.contacts.size() == motion.contacts()) { return direction; }
        }
    }
    return std::nullopt;
}

/// The contact that the hybrid flow met and the sequence does not have: the one furthest in phase from all of its own.
flow::Contact unexpected(const Point& seen) {
    // A contact of the sequence is met near the phase that it is solved for, if not exactly there; the new one stands
    // apart. Without any of its own all are as far, and the first is taken.
    const double whole = 2.0 * pi * seen.motion.period;
    const flow::Contact* found = &seen.contacts.front();
    double furthest = -1.0;
    for (const flow::Contact& contact : seen.contacts) {
        double nearest = 1e300;
        for (const auto& own : seen.motion.sequence.contacts) {
            nearest = std::min(nearest, std::abs(std::remainder(contact.theta_in - own.phase, whole)));
        }
        if (nearest > furthest) {
            furthest = nearest;
            found = &contact;
        }
    }
    return *found;
}

/// The motion as a sequence with one more contact, of no speed, in its place by phase; its index.
std::pair<Motion, int> with_contact(const flow::System& system, const Motion& motion, const flow::Contact& met) {
    Motion more = motion;
    more.form = Form::sequence;
    // There is a stop on one side only: a motion that strikes has not the mirror symmetry.
    more.mirrored = false;
    more.sequence.period = motion.period;
    orbit::ContactUnknowns contact;
    contact.phase = met.theta_in;
    for (std::size_t k = 2; k < static_cast<std::size_t>(system.states()); ++k) {
        contact.rest[k - 2] = met.state_in[k];
    }
    auto& contacts = more.sequence.contacts;
    if (!contacts.empty()) {
        // The hybrid flow was followed for a period from a strobe phase of its own: its phases are brought into the
        // period that begins with the first contact of the sequence, as a sequence is in order of phase.
        const double whole = 2.0 * pi * motion.period;
        double after = std::fmod(contact.phase - contacts.front().phase, whole);
        if (after < 0.0) { after += whole; }
        contact.phase = contacts.front().phase + after;
    }
    const auto place =
        std::find_if(contacts.begin(), contacts.end(), [&](const auto& other) { return other.phase > contact.phase; });
    const int index = static_cast<int>(place - contacts.begin());
    contacts.insert(place, contact);
    return {more, index};
}

/// The strobe phase, moved by whole cycles to lie before the first contact of the sequence.
double latest_phase_before(const Motion& motion, double phase) {
    // The state there is integrated back from the entry: the latest such phase is the shortest way, and backwards a
    // damped motion magnifies errors.
    const double first = motion.sequence.contacts.front().phase;
    return phase + 2.0 * pi * std::floor((first - phase) / (2.0 * pi));
}

/// The grazing motion in the form that it had without the contact.
std::optional<Motion> old_form_at(const flow::System& system, const Motion& old_form, const Motion& grazing,
                                  int contact) {
    if (old_form.form == Form::sequence) {
        Motion motion = grazing;
        // A contact without speed and duration changes nothing: what is left solves the equations without it.
        motion.sequence.contacts.erase(motion.sequence.contacts.begin() + contact);
        return motion;
    }
    Motion motion = old_form;
    const auto state = orbit::state_at(system, grazing.sequence, latest_phase_before(grazing, old_form.phase));
    if (!state) { return std::nullopt; }
    // On the flight that ends in the graze the grazing motion and the old one are the same; Newton removes what
    // rounding has added on the way.
    motion.state = *state;
    return orbit::solve(system, motion);
}

/// The motion of the old form at the grazing point. Where the hybrid flow meets the new contact there, its multipliers
/// are no longer those of the old form, and the motion a little before stands for it.
std::optional<CurvePoint> point_before_grazing(const flow::ParameterFamily& family, Piece& piece, const Vector& found,
                                               const Motion& old_form, double parameter) {
    Look here = look(family, old_form, parameter);
    if (here.status == Look::Status::flow_failed) { return std::nullopt; }
    if (old_form.form != Form::sequence || here.point.contacts.size() == old_form.contacts()) {
        return CurvePoint{found, piece.slope(), std::move(here.point)};
    }
    const double behind = (piece.point() - found).norm();
    // As near to the corner as the hybrid flow allows: contacts of a speed below its resolution are not told.
    for (const double more : {1e-6, 1e-5, 1e-4, 1e-3}) {
        const auto earlier = piece.probe(-(behind + more));
        if (!earlier) { continue; }
        Look there = look(family, earlier->motion, earlier->parameter);
        if (there.ok() && there.point.contacts.size() == old_form.contacts()) {
            return CurvePoint{piece.scaled(earlier->motion, earlier->parameter), earlier->slope,
                              std::move(there.point)};
        }
    }
    return std::nullopt;
}

/// The corner's own point: the motion beside it, at the grazing point's parameter.
Corner corner_at(const flow::ParameterFamily& family, const Point& near, double parameter, int contact) {
    // The grazing motion itself cannot be looked at: the hybrid flow meets no contact of speed zero, and its
    // multipliers are not defined there. The motion beside it stands for it: the parameter differs by the order of its
    // speed squared.
    Corner corner;
    corner.at = near;
    corner.at.parameter = parameter;
    corner.at.omega = family.at(parameter).omega();
    corner.contact = contact;
    // Set, not measured: Newton's method ends with a step below 1e-10 in scaled unknowns and leaves about its square.
    corner.uncertainty = 1e-12 * std::abs(parameter);
    return corner;
}

}  // namespace

std::optional<int> contact_leaving(const Motion& motion) {
    // Of several that a step has taken beyond zero the one furthest beyond is likely to have grazed first.
    std::optional<int> leaving;
    double lowest = 0.0;
    for (std::size_t i = 0; i < motion.contacts(); ++i) {
        if (motion.sequence.contacts[i].speed <= lowest) {
            lowest = motion.sequence.contacts[i].speed;
            leaving = static_cast<int>(i);
        }
    }
    return leaving;
}

std::optional<Corner> leave_contact(const flow::ParameterFamily& family, Piece& piece, const CurvePoint& last,
                                    int contact, const TraceOptions& options) {
    const auto at = static_cast<Eigen::Index>(contact) * piece.motion().sequence.unknowns_per_contact(family.base);
    const double before = last.u[at];
    const double beyond = piece.point()[at];
    // Where the speed passes through zero, by linear interpolation along the step.
    const Vector between = last.u + before / (before - beyond) * (piece.point() - last.u);
    Motion guess = piece.motion_of(between);
    // A stop that cannot pull lets a contact without speed end at a negative time as well: not to be run into.
    guess.sequence.contacts[static_cast<std::size_t>(contact)].speed = 0.0;
    guess.sequence.contacts[static_cast<std::size_t>(contact)].duration = 0.0;
    const auto grazing =
        boundary::solve_critical(family, Kind::grazing, guess, piece.parameter_of(between), contact, 0.0, options.size);
    if (!grazing.ok()) { return std::nullopt; }
    const Vector found = piece.scaled(grazing.motion, grazing.parameter);
    // Newton's method may have gone to the grazing point of another part of the branch.
    if (!place_of(found, last.u, piece.point()).between()) { return std::nullopt; }
    auto near = point_beside_grazing(family, grazing.motion, grazing.parameter, contact, options);
    if (!near) { return std::nullopt; }
    near->slope = -near->slope;  // travelled towards lower speed
    Corner corner = corner_at(family, near->point, grazing.parameter, contact);
    const flow::System system = family.at(grazing.parameter);
    Motion rest = without(system, grazing.motion, contact, near->point);
    const auto solved = orbit::solve(system, rest);
    if (!solved) { return std::nullopt; }
    // A subharmonic motion that has lost its last contact can be a free motion run through several times: the branch
    // ends there, on one of shorter period.
    if (solved->form == Form::free && solved->period > 1) {
        orbit::Orbit free;
        free.map.stop = flow::StopMode::off;
        free.map.period = solved->period;
        free.state = solved->state;
        corner.shorter_period = orbit::minimal_period(system, free) < solved->period;
    }
    // On the other side the contact that has left would be met again.
    const auto direction = real_side(family, *solved, grazing.parameter, options, piece.slope() < 0.0 ? -1.0 : 1.0);
    if (!direction) { return std::nullopt; }
    corner.in_front = std::move(*near);
    corner.onward = {*solved, grazing.parameter, *direction, {}};
    return corner;
}

std::optional<Corner> enter_contact(const flow::ParameterFamily& family, Piece& piece, const CurvePoint& last,
                                    const Point& seen, const TraceOptions& options) {
    const auto [guess, contact] = with_contact(family.at(seen.parameter), seen.motion, unexpected(seen));
    const auto grazing =
        boundary::solve_critical(family, Kind::grazing, guess, seen.parameter, contact, 0.0, options.size);
    if (!grazing.ok()) { return std::nullopt; }
    auto near = point_beside_grazing(family, grazing.motion, grazing.parameter, contact, options);
    if (!near) { return std::nullopt; }
    // The old form at the grazing point must lie between the last point and the one beyond.
    const flow::System system = family.at(grazing.parameter);
    const auto old_form = old_form_at(system, seen.motion, grazing.motion, contact);
    if (!old_form) { return std::nullopt; }
    const Vector found = piece.scaled(*old_form, grazing.parameter);
    if (!place_of(found, last.u, piece.point()).between()) { return std::nullopt; }
    const auto before = point_before_grazing(family, piece, found, *old_form, grazing.parameter);
    if (!before) { return std::nullopt; }
    Corner corner = corner_at(family, near->point, grazing.parameter, contact);
    corner.in_front = *before;
    corner.onward = {near->point.motion, near->point.parameter, 1.0, {}};
    corner.entering_contact = contact;
    return corner;
}

}  // namespace percuss::branch
