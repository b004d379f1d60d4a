#pragma once
/// \file
/// The Taylor integrator of flow/taylor.hpp for many starts of one system: as many motions as a vector has lanes
/// advance together, each with its own phase, step and kind of contact, and a lane whose motion has ended takes the
/// next start. A template over a model's lanes (model/series.hpp).
///
/// Order, step and events follow the same rules as there. No lane ever reads another one and nothing depends on where
/// a start sits, so its numbers are the same to the last bit in any company.

#include "flow/flow.hpp"
#include "flow/taylor.hpp"
#include "numerics/lane_math.hpp"
#include "numerics/polynomial_roots.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <span>

namespace percuss::flow {
inline namespace PERCUSS_ISA {

template <model::LaneSeries Jets>
class TaylorEnsemble {
public:
    static constexpr int lanes = Jets::lanes;
    using V = typename Jets::V;
    using Mask = numerics::LaneMask<lanes>;

    /// parameters: as the model numbers them.
    TaylorEnsemble(const double* parameters, model::ContactLaw law, int order)
        : jets_(parameters),
          rules_(model::contact_rules(law, jets_.stop_damping() != 0.0)),
          order_(std::min(order, Jets::max_order)),
          // As in TaylorRun.
          safety_(std::exp(-2.0 - 0.7 / (order_ - 1))) {}

    void run(const EnsembleRequest& request, std::span<EnsembleMember> members) {
        request_ = &request;
        members_ = members;
        seeks_events_ = request.stop == StopMode::hybrid && rules_.has_stop;
        for (std::size_t i = 0; i < width; ++i) { take_next(i); }
        for (long sweeps = 1; busy_ > 0; ++sweeps) {
            jets_.expand(elapsed_ + request.theta, stiffness_, damping_, order_);
            choose_steps();
            locate_events();
            jets_.advance(step_, order_);
            elapsed_ += step_;
            for (std::size_t i = 0; i < width; ++i) { settle(i); }
            if (sweeps % steps_between_questions == 0 && is_cancelled(request)) { conclude_all(Status::cancelled); }
        }
    }

private:
    static constexpr auto width = static_cast<std::size_t>(lanes);

    using Phase = model::ContactPhase;
    using Event = model::Transition;

    /// What a lane is busy with.
    struct Lane {
        EnsembleMember* member = nullptr;  ///< null: nothing
        Phase phase = Phase::free;
        const Event* event = nullptr;
        bool deflate = false;
        bool finished = false;
        int events = 0;
        long steps = 0;
    };

    void take_next(std::size_t i) {
        Lane& lane = lane_[i];
        lane = Lane{};
        if (next_ == request_->states.size()) {
            // No start is left for this lane. It goes on in step with the others, at rest and with its time used up, so
            // that its steps have length zero and its numbers stay finite.
            jets_.clear(i);
            elapsed_.set(i, request_->duration);
        } else {
            const State& start = request_->states[next_];
            lane.member = &members_[next_];
            *lane.member = EnsembleMember{};
            ++next_;
            ++busy_;
            std::array<double, Jets::states> y;
            std::copy_n(start.begin(), y.size(), y.begin());
            jets_.load(i, y);
            elapsed_.set(i, 0.0);
            lane.phase = first_phase(start);
        }
        show_phase(i);
    }

    [[nodiscard]] Phase first_phase(const State& start) const {
        if (request_->stop == StopMode::held) { return Phase::contact; }
        const double gap = start[0] - jets_.stop_position();
        if (!seeks_events_) { return Phase::free; }
        return rules_.first_phase(gap, jets_.stop_stiffness() * gap + jets_.stop_damping() * start[1]);
    }

    /// Makes the vectors that depend on phase and deflation agree with them.
    void show_phase(std::size_t i) {
        const Lane& lane = lane_[i];
        const bool touching = lane.phase == Phase::contact;
        stiffness_.set(i, touching ? jets_.stop_stiffness() : 0.0);
        damping_.set(i, touching ? jets_.stop_damping() : 0.0);
        gap_sign_.set(i, rules_.direction(lane.phase, model::Watched::gap));
        force_sign_.set(i, rules_.direction(lane.phase, model::Watched::force));
        deflate_.set(i, lane.deflate);
    }

    /// Jorba and Zou (2005), section 3.2, with one scale for the whole state.
    void choose_steps() {
        // States are of order one by scaling; smaller ones are held to the same absolute tolerance.
        const V scale = max(jets_.norm(0), numerics::all_lanes<lanes>(1.0));
        const V last = jets_.norm(order_) / scale;
        const V but_one = jets_.norm(order_ - 1) / scale;
        // The same limits as for a single run; a lane beyond them ends, with a step of zero because its own may be NaN.
        const Mask sound = (last < 1e300) & (but_one < 1e300) & (scale < 1e6);
        const V growth = max(log(but_one) * (1.0 / (order_ - 1)), log(last) * (1.0 / order_));
        // The cap is for a mass at rest, as in TaylorRun.
        const V h = min(exp(-growth) * safety_, numerics::all_lanes<lanes>(3.0));
        const V remaining = request_->duration - elapsed_;
        const Mask more = h < remaining;
        step_ = select(more, h, remaining);
        const bool unsound = (~sound).any();
        for (std::size_t i = 0; i < width; ++i) { lane_[i].finished = !more[i]; }
        if (!unsound) { return; }
        for (std::size_t i = 0; i < width; ++i) {
            if (!sound[i] && lane_[i].member != nullptr) {
                conclude(i, Status::diverged);
                step_.set(i, 0.0);
            }
        }
    }

    /// The next event inside each step, if any, shortens it. Polynomial bounds, for all lanes at once, rule most out.
    void locate_events() {
        if (!seeks_events_) { return; }
        Mask possible = may_change_sign(gap_sign_, false);
        if (rules_.releases_on_force) { possible = possible | may_change_sign(force_sign_, true); }
        if (!possible.any()) { return; }
        for (std::size_t i = 0; i < width; ++i) {
            if (possible[i] && lane_[i].member != nullptr && lane_[i].member->status == Status::not_run) { locate(i); }
        }
    }

    /// Whether the gap (or the stop's force) times `sign` may rise above zero inside the step: the sum of its value at
    /// the start and of all positive terms at the end says no. In deflated lanes it starts at zero, and the linear term
    /// is what must be outweighed.
    [[nodiscard]] Mask may_change_sign(const V& sign, bool force) const {
        V power = sign * step_;
        const V zero{};
        const V constant = sign * event_coefficients(force, 0);
        const V linear = power * event_coefficients(force, 1);
        V bound = select(deflate_, linear, constant + max(linear, zero));
        for (int j = 2; j <= order_; ++j) {
            power = power * step_;
            bound += max(power * event_coefficients(force, j), zero);
        }
        return ~(bound < 0.0);
    }
    [[nodiscard]] PERCUSS_INLINE V event_coefficients(bool force, int j) const {
        const V& x = jets_.x(j);
        const V e = j == 0 ? x - jets_.stop_position() : x;
        return force ? jets_.stop_stiffness() * e + jets_.stop_damping() * jets_.v(j) : e;
    }

    void locate(std::size_t i) {
        for (const Event& event : rules_.from(lane_[i].phase)) { find(i, event); }
    }

    /// Looks for the first sign change that makes the event, in (0, step]. A function that is zero at the start of the
    /// step is divided by t first.
    __attribute__((noinline)) void find(std::size_t i, const Event& event) {
        const bool force = event.watched == model::Watched::force;
        const int sign = event.direction;
        const Lane& lane = lane_[i];
        const double h = step_[i];
        double c[numerics::max_degree + 1];
        double power = 1.0;
        double bound = 0.0;
        const int shift = lane.deflate ? 1 : 0;
        const int degree = order_ - shift;
        // As in TaylorRun::find: coefficients in units of the step, and a bound on what the higher terms add.
        const double unit = static_cast<double>(sign);
        for (int j = 0; j <= degree; ++j) {
            c[j] = event_coefficient(i, force, j + shift) * power;
            power *= h;
            if (j > 0) { bound += std::max(0.0, unit * c[j]); }
        }
        const bool already = unit * c[0] >= 0.0;  // on the surface, or crossed by rounding, at the very start
        if (already && unit * c[1] > 0.0 && !lane.deflate) { return accept(i, event, 0.0); }
        if (unit * c[0] + bound < 0.0) { return; }
        double t = 0.0;
        if (numerics::first_sign_change(c, degree, sign, t)) { accept(i, event, t * h); }
    }
    [[nodiscard]] double event_coefficient(std::size_t i, bool force, int j) const {
        const double x = jets_.x(j)[i];
        const double e = j == 0 ? x - jets_.stop_position() : x;
        return force ? jets_.stop_stiffness() * e + jets_.stop_damping() * jets_.v(j)[i] : e;
    }

    void accept(std::size_t i, const Event& event, double t) {
        step_.set(i, t);
        lane_[i].event = &event;
        lane_[i].finished = false;
    }

    /// After the step: what it ended at.
    void settle(std::size_t i) {
        Lane& lane = lane_[i];
        if (lane.member == nullptr) { return; }
        EnsembleMember& member = *lane.member;
        if (member.status == Status::not_run) {
            ++lane.steps;
            // Nearly every step: nothing happened, and the masks are still right.
            if (lane.event == nullptr && !lane.deflate && !lane.finished && lane.steps < request_->max_steps) {
                return;
            }
            lane.deflate = false;
            Status status = Status::not_run;
            if (lane.event != nullptr) {
                if (!cross(i)) { status = Status::too_many_events; }
            } else if (lane.finished) {
                status = Status::ok;
            }
            lane.event = nullptr;
            show_phase(i);
            if (status == Status::not_run && lane.steps >= request_->max_steps) { status = Status::too_many_steps; }
            if (status != Status::not_run) { conclude(i, status); }
        }
        if (member.status != Status::not_run) { take_next(i); }
    }

    /// Puts the state on the surface and changes phase. False: one event too many.
    bool cross(std::size_t i) {
        Lane& lane = lane_[i];
        if (++lane.events > request_->max_events) { return false; }
        const Event& event = *lane.event;
        if (event.on_surface) { jets_.set_position(i, jets_.stop_position()); }
        if (event.next == Phase::contact) { ++lane.member->contacts; }
        lane.phase = event.next;
        lane.deflate = event.deflates;
        return true;
    }

    /// The motion of a lane ends here.
    void conclude(std::size_t i, Status status) {
        EnsembleMember& member = *lane_[i].member;
        const auto y = jets_.unload(i);
        std::copy(y.begin(), y.end(), member.state.begin());
        member.status = status;
        member.steps = lane_[i].steps;
        --busy_;
    }
    /// So do all of them, and no other start is taken; those never taken get the status too.
    void conclude_all(Status status) {
        for (std::size_t i = 0; i < width; ++i) {
            if (lane_[i].member != nullptr) { conclude(i, status); }
            lane_[i].member = nullptr;
        }
        for (; next_ < request_->states.size(); ++next_) {
            members_[next_] = EnsembleMember{};
            members_[next_].status = status;
        }
    }

    Jets jets_;
    const model::ContactRules& rules_;
    int order_;
    double safety_;
    const EnsembleRequest* request_ = nullptr;
    std::span<EnsembleMember> members_;
    std::size_t next_ = 0;  ///< start that no lane has taken yet
    int busy_ = 0;
    bool seeks_events_ = false;
    std::array<Lane, width> lane_;
    V elapsed_{}, step_{};
    V stiffness_{}, damping_{};  ///< of the stop where it touches, zero elsewhere
    V gap_sign_{}, force_sign_{};
    Mask deflate_{};
};

}  // namespace PERCUSS_ISA
}  // namespace percuss::flow
