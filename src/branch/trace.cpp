#include "branch/trace.hpp"

#include "branch/corner.hpp"
#include "branch/locate.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace percuss::branch {
namespace {

using boundary::Kind;
using orbit::Form;
using orbit::Motion;

class Tracer {
public:
    Tracer(const flow::ParameterFamily& family, const TraceOptions& options) : family_(family), options_(options) {}

    Branch run(const Departure& departure) {
        branch_.period = departure.motion.period;
        if (depart(departure)) {
            while (can_continue()) { step(); }
        }
        pair_jumps();
        return std::move(branch_);
    }

private:
    [[nodiscard]] bool can_continue() {
        if (branch_.end != End::not_run) { return false; }
        if (static_cast<int>(branch_.points.size()) >= options_.max_points ||
            (options_.cancelled && options_.cancelled())) {
            branch_.end = End::budget;
            branch_.end_reason = "as many points as were allowed";
            return false;
        }
        return true;
    }

    void lose(std::string reason) {
        branch_.end = End::lost;
        branch_.end_reason = std::move(reason);
    }

    bool depart(const Departure& d) {
        if (!set_out(d)) {
            lose("Newton's method found no motion to start from");
            return false;
        }
        branch_.points.push_back(last_.point);
        return true;
    }

    bool set_out(const Departure& d) {
        renew_piece(d.motion);
        ++branch_.solves;
        if (d.off.size() == 0) { return piece_->start(d.motion, d.parameter, d.direction) && take_current(); }
        // Beside a grazing point the new branch itself grazes close by: then a smaller distance is needed.
        for (double distance = departure_distance; distance > 1e-7; distance *= 0.1) {
            if (piece_->start_off(d.motion, d.parameter, d.off, distance) && take_current()) {
                piece_->set_step(distance);
                return true;
            }
            ++branch_.solves;
        }
        return false;
    }

    /// One step along the piece and what it brings: another point, a contact that leaves or enters, or trouble.
    void step() {
        if (!piece_->advance()) { return change_form("the step length collapsed"); }
        ++branch_.solves;
        // A speed below zero comes first: the equations have that solution, the flow has not, and what it meets instead
        // would be taken for other contacts.
        const Motion motion = piece_->motion();
        if (const auto leaving = contact_leaving(motion)) { return leave(*leaving); }
        Look seen = look(family_, motion, piece_->parameter());
        if (seen.status == Look::Status::flow_failed) { return try_shorter("the motion could not be integrated"); }
        const std::size_t met = seen.point.contacts.size();
        const std::size_t expected = motion.contacts();
        // The strobed form assumes no contacts: whatever it meets is right.
        if (motion.form != Form::strobed && met > expected) { return enter(seen.point); }
        if (!seen.ok() || (motion.form != Form::strobed && met != expected)) {
            return try_shorter("the contacts of the motion changed in a way that could not be followed");
        }
        accept({piece_->point(), piece_->slope(), std::move(seen.point)});
    }

    void accept(CurvePoint here) {
        // Before anything is noted of it: behind the junction the motion is one of half the period, and its boundaries
        // belong to that branch.
        if (joins(last_, here)) {
            branch_.end = End::joined;
            return;
        }
        note_boundaries(last_, here);
        last_ = std::move(here);
        branch_.points.push_back(last_.point);
        const double low = std::min(options_.from, options_.to);
        const double high = std::max(options_.from, options_.to);
        const double p = last_.point.parameter;
        if (p < low || p > high) {
            end_at(p < low ? low : high);
        } else if (closes()) {
            close();
        } else if (last_.point.motion.form == Form::strobed && ++strobed_points_ >= strobed_stretch) {
            return_to_sequence();
        }
    }

    void note_boundaries(const CurvePoint& a, const CurvePoint& b) {
        for (BoundaryPoint& found : boundaries_between(family_, *piece_, a, b, options_.size, branch_.solves)) {
            record(std::move(found));
        }
    }

    void record(BoundaryPoint found) {
        found.state_at_zero = state_at_zero(family_.at(found.point.parameter), found.point);
        found.after = branch_.points.empty() ? 0 : branch_.points.size() - 1;
        branch_.boundaries.push_back(std::move(found));
    }

    /// The last point moved to the end of the range.
    void end_at(double parameter) {
        branch_.end = End::range;
        if (branch_.points.size() < 2) { return; }
        // From the point just beyond. Where Newton's method fails, as it may behind a fold, that point stays the last.
        const auto there = orbit::solve(family_.at(parameter), last_.point.motion);
        ++branch_.solves;
        if (!there) { return; }
        Look seen = look(family_, *there, parameter);
        if (seen.ok()) { branch_.points.back() = std::move(seen.point); }
    }

    // ---- grazing points

    void leave(int contact) {
        const auto corner = leave_contact(family_, *piece_, last_, contact, options_);
        branch_.solves += 2;
        if (!corner) { return try_shorter("the grazing point where a contact ends could not be located"); }
        note_boundaries(last_, corner->in_front);
        pass(*corner);
    }

    void enter(const Point& seen) {
        // Contacts are taken in one at a time, in the order in which they begin: a shorter step keeps them apart.
        if (seen.contacts.size() > seen.motion.contacts() + 1 && piece_->step() > shortest_step && piece_->retreat()) {
            return;
        }
        auto corner = enter_contact(family_, *piece_, last_, seen, options_);
        branch_.solves += 2;
        if (!corner) { return try_shorter("the grazing point where a contact begins could not be located"); }
        note_boundaries(last_, corner->in_front);
        pass(*corner);
    }

    /// Goes on behind a grazing point with the other form.
    void pass(const Corner& corner) {
        const bool leaving = !corner.entering_contact;
        if (leaving && corner.in_front.slope * corner.onward.direction < 0.0) {
            record_turn(corner, corner.in_front.point);
        }
        branch_.points.push_back(corner.at);
        BoundaryPoint found;
        found.kind = Kind::grazing;
        found.point = corner.at;
        found.uncertainty = corner.uncertainty;
        found.contact = corner.contact;
        record(std::move(found));
        if (corner.shorter_period) {
            branch_.end = End::joined;
            return;
        }
        renew_piece(corner.onward.motion);
        const bool started =
            leaving ? piece_->start(corner.onward.motion, corner.onward.parameter, corner.onward.direction)
                    : piece_->start_with_speed(corner.onward.motion, corner.onward.parameter, *corner.entering_contact);
        if (!started || !take_current()) { return lose("the motion behind a grazing point could not be found"); }
        if (!leaving && corner.in_front.slope * last_.slope < 0.0) { record_turn(corner, last_.point); }
        strobed_points_ = 0;
    }

    /// The branch turns back at the grazing point itself: its fold stands at an even smaller entry speed than where the
    /// striking motion was looked at.
    void record_turn(const Corner& corner, const Point& striking) {
        BoundaryPoint fold;
        fold.kind = Kind::fold;
        fold.point = striking;
        fold.uncertainty = corner.uncertainty + std::abs(striking.parameter - corner.at.parameter);
        record(std::move(fold));
    }

    // ---- trouble

    void try_shorter(const char* reason) {
        if (piece_->step() > shortest_step && piece_->retreat()) { return; }
        change_form(reason);
    }

    /// A sequence that cannot be followed on may be passed stroboscopically: contacts that merge or split.
    void change_form(const char* reason) {
        if (last_.point.motion.form != Form::sequence) { return lose(reason); }
        Motion motion;
        motion.form = Form::strobed;
        motion.period = branch_.period;
        motion.state = last_.point.state;
        motion.phase = last_.point.phase;
        restart(motion, reason);
    }

    void return_to_sequence() {
        strobed_points_ = 0;
        orbit::Orbit orbit;
        orbit.map.period = branch_.period;
        orbit.map.phase = last_.point.phase;
        orbit.state = last_.point.state;
        orbit.contacts = last_.point.contacts;
        const Motion motion = orbit::motion_of(family_.base, orbit);
        if (motion.form == Form::strobed) { return; }
        const Look seen = look(family_, motion, last_.point.parameter);
        // Only where the sequence has the contacts that the flow meets; else a few more points are strobed.
        if (seen.ok() && seen.point.contacts.size() == motion.contacts()) {
            restart(motion, "the motion could not be followed with its new contacts");
        }
    }

    void restart(const Motion& motion, const char* reason) {
        // The branch goes on in the parameter's direction: unknowns of different forms have no tangent in common.
        const double direction = last_.slope;
        renew_piece(motion);
        if (!piece_->start(motion, last_.point.parameter, direction) || !take_current()) { return lose(reason); }
        strobed_points_ = 0;
    }

    void renew_piece(const Motion& motion) {
        piece_ = std::make_unique<Piece>(family_, motion, options_.size, options_.steps);
    }

    bool take_current() {
        Look seen = look(family_, piece_->motion(), piece_->parameter());
        if (!seen.ok()) { return false; }
        last_ = {piece_->point(), piece_->slope(), std::move(seen.point)};
        return true;
    }

    // ---- shape of the whole

    /// Whether both halves of a motion of even period have become the same, or changed places, during the step.
    [[nodiscard]] bool joins(const CurvePoint& a, const CurvePoint& b) const {
        const Motion& motion = b.point.motion;
        // Just off the flip that it sets out from both halves are nearly the same as well: not to be asked of the first
        // points.
        if (motion.form != Form::sequence || branch_.period % 2 != 0 || motion.contacts() % 2 != 0 ||
            a.u.size() != b.u.size() || branch_.points.size() < 2) {
            return false;
        }
        const auto half = (b.u.size() - 1) / 2;
        numerics::Vector before = a.u.head(half) - a.u.segment(half, half);
        numerics::Vector now = b.u.head(half) - b.u.segment(half, half);
        const int block = motion.sequence.unknowns_per_contact(family_.base);
        for (Eigen::Index at = 1; at < half; at += block) {  // entry phases: the later half is as many cycles later
            before[at] += std::numbers::pi * branch_.period;
            now[at] += std::numbers::pi * branch_.period;
        }
        // 1e-7 is what the points are solved to.
        return before.dot(now) <= 0.0 || now.norm() < 1e-7;
    }

    /// Whether the last step passed the first point again, in the same direction.
    [[nodiscard]] bool closes() {
        const auto& points = branch_.points;
        // The first points are near the first one without having come back. A closed curve without corners turns by 360
        // degrees, in steps of 20 at most: it is longer than that.
        if (points.size() < 8) { return false; }
        return near_first(points[points.size() - 2], points.back()) &&
               passes_first(points[points.size() - 2], points.back());
    }

    /// A first look: the last step is near the first point in what is seen of the motions, in units of its own length.
    [[nodiscard]] bool near_first(const Point& a, const Point& b) const {
        const Point& first = branch_.points.front();
        const double unit = family_.units.front();
        const double length = std::abs(b.parameter - a.parameter) / unit + std::abs(b.x_min - a.x_min) / options_.size +
                              std::abs(b.peak_force - a.peak_force) / (1.0 + first.peak_force);
        const double away = std::abs(b.parameter - first.parameter) / unit +
                            std::abs(b.x_min - first.x_min) / options_.size +
                            std::abs(b.peak_force - first.peak_force) / (1.0 + first.peak_force);
        const double way_there = branch_.points[1].parameter - first.parameter;
        // With the first point on the step it is no further away than the step is long, but for the bend; half of that
        // again is for it. The multiplier must be between those of the ends in the same rough sense.
        return away <= 1.5 * length && b.contacts.size() == first.contacts.size() &&
               (b.parameter - a.parameter) * way_there > 0.0 && a.motion.form == b.motion.form &&
               std::abs(b.max_multiplier() - first.max_multiplier()) <
                   3.0 * std::abs(b.max_multiplier() - a.max_multiplier()) + 1e-3;
    }

    /// The proof: the motion of the last step at the first point's parameter is the first motion. Far below resonance a
    /// branch turns back and forth between folds less than a step apart, on motions that differ by one bounce in
    /// fifteen: near is not the same there.
    [[nodiscard]] bool passes_first(const Point& a, const Point& b) {
        const Point& first = branch_.points.front();
        if (a.motion.contacts() != b.motion.contacts()) { return false; }
        const double share = (first.parameter - a.parameter) / (b.parameter - a.parameter);
        const numerics::Vector from = orbit::pack(family_.base, a.motion);
        const numerics::Vector to = orbit::pack(family_.base, b.motion);
        const Motion guess = orbit::unpack(family_.base, from + share * (to - from), a.motion);
        ++branch_.solves;
        const auto solved = orbit::solve(family_.at(first.parameter), guess);
        if (!solved) { return false; }
        const Look seen = look(family_, *solved, first.parameter);
        return seen.ok() && same_motion(seen.point, first, options_.size);
    }

    /// The first point becomes the last as well.
    void close() {
        auto& points = branch_.points;
        const double way_there = points[1].parameter - points[0].parameter;
        // A last point beyond the first is on the way that was gone at the beginning.
        const bool passed = (points.back().parameter - points[0].parameter) * way_there >= 0.0;
        if (passed) { points.pop_back(); }
        points.emplace_back(points.front());
        branch_.end = End::closed;
    }

    /// A fold within 1e-6 of a grazing point is one physical jump with it, also where a torus or flip lies in between.
    void pair_jumps() {
        auto& all = branch_.boundaries;
        for (std::size_t i = 0; i < all.size(); ++i) {
            if ((all[i].kind != Kind::grazing && all[i].kind != Kind::fold) || all[i].partner >= 0) { continue; }
            const Kind other = all[i].kind == Kind::fold ? Kind::grazing : Kind::fold;
            for (std::size_t k = i + 1; k < all.size() && near_together(all[i], all[k]); ++k) {
                if (all[k].kind != other || all[k].partner >= 0) { continue; }
                all[i].partner = static_cast<int>(k);
                all[k].partner = static_cast<int>(i);
                break;
            }
        }
    }

    [[nodiscard]] static bool near_together(const BoundaryPoint& a, const BoundaryPoint& b) {
        return std::abs(a.point.parameter - b.point.parameter) <= 1e-6 * std::abs(a.point.parameter);
    }

    /// In scaled unknowns: a step that is still too long to keep the contacts apart is not worth halving on.
    static constexpr double shortest_step = 1e-4;
    /// From a flip, in scaled unknowns: a first step of StepOptions.
    static constexpr double departure_distance = 0.02;
    /// Points in strobed form before a return to a contact sequence is tried: contacts that have just merged or split
    /// are still too close to be told as a sequence.
    static constexpr int strobed_stretch = 4;

    const flow::ParameterFamily& family_;
    const TraceOptions& options_;
    Branch branch_;
    std::unique_ptr<Piece> piece_;
    CurvePoint last_;
    int strobed_points_ = 0;
};

}  // namespace

Branch trace(const flow::ParameterFamily& family, const Departure& departure, const TraceOptions& options) {
    return Tracer(family, options).run(departure);
}

Branch trace_both_ways(const flow::ParameterFamily& family, const Departure& departure, const TraceOptions& options) {
    Departure back = departure;
    back.direction = -departure.direction;
    Branch joined = trace(family, back, options);
    // An isola was met whole.
    if (joined.end == End::closed) { return joined; }
    Branch forth = trace(family, departure, options);
    // The way back is turned round: what lay after a point then lies after its other neighbour. Both ways begin with
    // the same point, which is kept once.
    const std::size_t shift = joined.points.empty() ? 0 : joined.points.size() - 1;
    std::reverse(joined.points.begin(), joined.points.end());
    std::reverse(joined.boundaries.begin(), joined.boundaries.end());
    const int earlier = static_cast<int>(joined.boundaries.size());
    for (BoundaryPoint& found : joined.boundaries) {
        found.after = found.after < shift ? shift - found.after - 1 : 0;
        if (found.partner >= 0) { found.partner = earlier - 1 - found.partner; }
    }
    joined.begin = joined.end;
    joined.begin_reason = joined.end_reason;
    for (std::size_t i = 1; i < forth.points.size(); ++i) { joined.points.push_back(std::move(forth.points[i])); }
    for (BoundaryPoint& found : forth.boundaries) {
        found.after += shift;
        if (found.partner >= 0) { found.partner += earlier; }
        joined.boundaries.push_back(std::move(found));
    }
    joined.end = forth.end;
    joined.end_reason = forth.end_reason;
    joined.solves += forth.solves;
    return joined;
}

}  // namespace percuss::branch
