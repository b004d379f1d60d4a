#pragma once
/// \file
/// The Taylor integrator with events: expand, choose a step, locate the next event in it, observe, advance, cross.
/// A template over a model's series (model/series.hpp), which brings the scalar: double, a Dual with sensitivities as
/// SIMD lanes, or an extended precision.
///
/// Order and step: A. Jorba, M. Zou, "A software package for the numerical integration of ODEs by means of high-order
/// Taylor methods", Experimental Mathematics 14 (2005): order -ln(tol)/2 + 2, step from the last two coefficients; no
/// step is rejected. Derivative lanes are taken at fixed times; the saltation at an event is applied in the form
/// S = I -+ delta_i e_v e_x^T, which never divides by the velocity (kelvin-voigt entry and exit; the acceleration jumps
/// by delta_i v there, so (f- - f+) dt_e = -delta_i (dx - dx_stop) exactly).

#include "flow/flow.hpp"
#include "flow/series_observer.hpp"
#include "model/contact_law.hpp"
#include "model/series.hpp"
#include "numerics/dual.hpp"
#include "numerics/polynomial_roots.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace percuss::flow {
inline namespace PERCUSS_ISA {

/// Unless a request wants full derivatives, the derivative parts of the series stop this many orders before the values:
/// less than two thirds of the work. Measured on the default orbit, the monodromy matrix is then good to 1e-9 at
/// tolerance 1e-13 and to a few 1e-5 at 1e-8: enough for Newton's method, not for what is reported.
inline constexpr int derivative_orders_saved = 4;
/// Whether the run is to end early is asked every so many steps: a hundred microseconds or so, and no cost that shows.
inline constexpr long steps_between_questions = 256;
/// Sensitivities alone may carry this much more relative error per step than the values, before they shorten it.
inline constexpr double lane_tolerance = 1e-2;

template <model::Series Jet>
class TaylorRun {
public:
    using T = typename Jet::Scalar;
    using Base = typename Jet::Base;
    using JetState = typename Jet::State;
    static constexpr int lanes = numerics::ScalarTraits<T>::lanes;

    /// parameters: as the jet's model numbers them.
    TaylorRun(const T* parameters, model::ContactLaw law, int order)
        : jet_(parameters),
          rules_(model::contact_rules(law, numerics::base(jet_.stop_damping()) != 0)),
          order_(std::min(order, Jet::max_order)),
          derivative_order_(order_),
          // The step that Jorba and Zou give for a series truncated at this order: the radius of convergence over e^2,
          // times their safety factor exp(-0.7/(order - 1)).
          safety_(std::exp(-2.0 - 0.7 / (order_ - 1))),
          observer_(jet_) {}

    /// Follows the flow from `start` at phase `theta` (whose derivative part, if any, shifts the drive) for `duration`.
    Status run(const JetState& start, const T& theta, const Base& duration, const Request& request) {
        request_ = &request;
        // Not below order 4: at loose tolerances the series are short, and little would be left of the lanes.
        if (lanes > 0 && !request.full_derivatives) {
            derivative_order_ = std::max(4, order_ - derivative_orders_saved);
        }
        theta_ = theta;
        elapsed_ = 0;
        duration_ = duration;
        jet_.load(start);
        enter_first_phase();
        observer_.begin(request.observe, numerics::base(theta_), touching());
        while (status_ == Status::not_run) {
            jet_.expand(theta_at(), touching(), order_, derivative_order_);
            choose_step();
            locate_event();
            observer_.step(order_, step_, touching(), event_ != nullptr, finished_);
            advance();
            if (event_ != nullptr) { cross(); }
            if (event_ == nullptr && finished_ && status_ == Status::not_run) { status_ = Status::ok; }
            if (++steps_ >= request.max_steps && status_ == Status::not_run) { status_ = Status::too_many_steps; }
            if (steps_ % steps_between_questions == 0 && status_ == Status::not_run && is_cancelled(request)) {
                status_ = Status::cancelled;
            }
        }
        observer_.end(touching());
        return status_;
    }

    [[nodiscard]] JetState state() const { return jet_.unload(); }
    [[nodiscard]] long steps() const { return steps_; }
    [[nodiscard]] Jet& jet() { return jet_; }
    [[nodiscard]] SeriesObserver<Jet>& observer() { return observer_; }
    [[nodiscard]] const T& divided_gap() const { return divided_gap_; }
    [[nodiscard]] bool touching() const { return phase_ == Phase::contact; }
    [[nodiscard]] T theta_at() const { return theta_ + elapsed_; }

private:
    using Phase = model::ContactPhase;
    using Event = model::Transition;

    void enter_first_phase() {
        phase_ = Phase::free;
        deflate_ = false;
        switch (request_->stop) {
            case StopMode::off: return;
            case StopMode::held: phase_ = Phase::contact; return;
            case StopMode::hybrid: break;
        }
        if (!rules_.has_stop) { return; }
        if (request_->starts_in_contact) {
            phase_ = rules_.entry().next;
            deflate_ = rules_.entry().deflates;
        } else {
            const Base gap = numerics::base(jet_.position()) - numerics::base(jet_.stop_position());
            phase_ = rules_.first_phase(static_cast<double>(gap), static_cast<double>(force_now()));
        }
    }

    [[nodiscard]] Base force_now() {
        return numerics::base(jet_.stop_stiffness()) *
                   (numerics::base(jet_.position()) - numerics::base(jet_.stop_position())) +
               numerics::base(jet_.stop_damping()) * numerics::base(jet_.velocity());
    }

    /// Jorba and Zou (2005), section 3.2, with one scale for the whole state.
    void choose_step() {
        const Base size = jet_.norm(0);
        // States are of order one by scaling; smaller ones are held to the same absolute tolerance.
        const double scale = std::max(1.0, static_cast<double>(size));
        // Both of the last two coefficients have their say: one alone may vanish by symmetry (even or odd series).
        double h = 1e300;
        for (int j : {order_ - 1, order_}) {
            const double c = static_cast<double>(jet_.norm(j)) / scale;
            // A coefficient that is NaN fails the first test. States of 1e6 mean that the motion left: they are of
            // order one by scaling.
            if (!(c < 1e300) || !(scale < 1e6)) {
                status_ = Status::diverged;
                step_ = 0;
                finished_ = true;
                return;
            }
            const double largest = std::max(c, lane_growth(j - order_ + derivative_order_, j));
            if (largest > 0) { h = std::min(h, std::pow(largest, -1.0 / j)); }
        }
        // An undriven mass at rest has no coefficients that could bound the step; about half a drive cycle does.
        h = std::min(h * safety_, 3.0);
        const Base remaining = duration_ - elapsed_;
        const Base room = remaining < 0 ? -remaining : remaining;
        finished_ = !(room > Base(h));
        step_ = finished_ ? remaining : (remaining < 0 ? Base(-h) : Base(h));
    }

    /// Largest ratio, over the lanes, of the j-th coefficients to the first ones. A quasi-static motion has tiny
    /// coefficients while its sensitivities swing at the natural frequency: they need their own say in the step.
    /// j: a coefficient that the lanes have; value_order: the one that the step is measured by, so that the answer is
    /// (growth per order)^value_order.
    [[nodiscard]] double lane_growth([[maybe_unused]] int j, [[maybe_unused]] int value_order) const {
        double growth = 0.0;
        if constexpr (lanes > 0) {
            for (std::size_t i = 0; i < static_cast<std::size_t>(lanes); ++i) {
                double first = 0.0;
                // The first three coefficients together: a direction may start with no displacement or no velocity, and
                // a single one of them as the unit would make the growth infinite.
                for (int n = 0; n < 3; ++n) {
                    first = std::max({first, std::abs(jet_.x()[n].d[i]), std::abs(jet_.v()[n].d[i])});
                }
                const double last = std::max(std::abs(jet_.x()[j].d[i]), std::abs(jet_.v()[j].d[i]));
                // A lane that does not move at all has nothing to follow.
                if (last > growth * first && first > 0.0) { growth = last / first; }
            }
            // The lanes stop earlier than the values: what j orders grow by is carried over to as many orders as the
            // values have.
            if (j != value_order) { growth = std::pow(growth, static_cast<double>(value_order) / j); }
        }
        return lane_tolerance * growth;
    }

    /// The next event inside the step, if any, shortens it. A polynomial bound rules most steps out; the rest go to
    /// root isolation, which cannot miss a crossing. A function that is zero at the start of the step is divided by t
    /// first.
    void locate_event() {
        event_ = nullptr;
        if (request_->stop != StopMode::hybrid || !rules_.has_stop || status_ != Status::not_run) { return; }
        for (const Event& event : rules_.from(phase_)) { find(event); }
    }

    [[nodiscard]] Base event_coefficient(model::Watched watched, int j) const {
        const Base& x = numerics::base(jet_.x()[j]);
        const Base e = j == 0 ? x - numerics::base(jet_.stop_position()) : x;
        if (watched == model::Watched::gap) { return e; }
        return numerics::base(jet_.stop_stiffness()) * e +
               numerics::base(jet_.stop_damping()) * numerics::base(jet_.v()[j]);
    }

    /// Looks for the first sign change that makes the event, in (0, step].
    void find(const Event& event) {
        const int sign = event.direction;
        const double h = static_cast<double>(step_);
        double c[numerics::max_degree + 1];
        double power = 1.0;
        double bound = 0.0;
        const int shift = deflate_ ? 1 : 0;
        const int degree = order_ - shift;
        const double unit = static_cast<double>(sign);
        // The function in units of the step, c(t/h), and the largest that its higher terms could add to c[0] anywhere
        // in it. A run that never reaches the stop pays some 6 % of its instructions for this bound.
        for (int j = 0; j <= degree; ++j) {
            c[j] = static_cast<double>(event_coefficient(event.watched, j + shift)) * power;
            power *= h;
            if (j > 0) { bound += std::max(0.0, unit * c[j]); }
        }
        const bool already = unit * c[0] >= 0.0;  // on the surface, or crossed by rounding, at the very start
        // Where it is deflated, c[0] is the slope at the event and not a place on the surface: a sign there is no
        // crossing.
        if (already && unit * c[1] > 0.0 && !deflate_) { return accept(event, Base(0)); }
        if (unit * c[0] + bound < 0.0) { return; }
        double t = 0.0;
        if (numerics::first_sign_change(c, degree, sign, t)) {
            accept(event, refine(event.watched, shift, Base(t) * step_));
        }
    }

    /// Newton's method in the scalar's own precision (the isolated root is good to double precision).
    [[nodiscard]] Base refine(model::Watched watched, int shift, Base t) const {
        if constexpr (sizeof(Base) > sizeof(double)) {
            // Digits double with each iteration: 16 become more than the 34 of __float128 in two; the third one is for
            // a flat crossing.
            for (int iteration = 0; iteration < 3; ++iteration) {
                Base value = 0;
                Base slope = 0;
                for (int j = order_; j >= shift; --j) {
                    slope = slope * t + value;
                    value = value * t + event_coefficient(watched, j);
                }
                t = t - value / slope;
            }
        }
        return t;
    }

    void accept(const Event& event, const Base& t) {
        step_ = t;
        event_ = &event;
        finished_ = false;
    }

    void advance() {
        if (request_->stop == StopMode::held && finished_) { divide_gap(); }
        jet_.advance(step_, order_);
        // The sum of the steps would miss the end by rounding.
        elapsed_ = finished_ ? duration_ : elapsed_ + step_;
        deflate_ = false;
    }

    /// (x - x_stop)/duration at the end of a held run. In a single step that starts on the surface this is the series
    /// divided by t: smooth through duration zero.
    void divide_gap() {
        const T start = jet_.x()[0] - jet_.stop_position();
        const bool single = steps_ == 0;
        T sum = jet_.x()[order_];
        for (int j = order_ - 1; j >= 1; --j) { sum = sum * step_ + jet_.x()[j]; }
        if (single) {
            divided_gap_ = sum;
            // At grazing Newton's method takes the duration to zero, so past where its reciprocal is finite.
            constexpr Base shortest = std::numeric_limits<double>::min();
            if (duration_ > shortest || duration_ < -shortest) { divided_gap_ += start * (Base(1) / duration_); }
        } else {
            divided_gap_ = (sum * step_ + start) * (Base(1) / duration_);
        }
    }

    /// Puts the state on the surface, applies the saltation to the lanes and changes phase.
    void cross() {
        // Chattering contacts accumulate at a point in time: without a cap the run would not end.
        if (++events_ > request_->max_events) {
            status_ = Status::too_many_events;
            return;
        }
        const Base theta = numerics::base(theta_) + elapsed_;
        const bool by_gap = event_->watched == model::Watched::gap;
        // Rounding leaves the state a little beside the surface; on it the deflated series begins with exactly zero.
        if (event_->on_surface) { jet_.set_position(numerics::base(jet_.stop_position())); }
        if (event_->next == Phase::contact) {
            observer_.enter(theta, by_gap);
        } else if (touching()) {
            observer_.exit(theta, by_gap);
        }
        if (event_->saltation != 0) { saltate(event_->saltation); }
        phase_ = event_->next;
        deflate_ = event_->deflates;
    }

    /// delta v += sign delta_i (delta x - delta x_stop); values stay as they are.
    void saltate(int sign) {
        if constexpr (lanes > 0) {
            const double delta = numerics::base(jet_.stop_damping());
            // The row of x' in S = I -+ delta_i e_v e_x^T; all other rows are those of the identity.
            jet_.velocity().d += (sign * delta) * (jet_.position().d - jet_.stop_position().d);
        }
    }

    Jet jet_;
    const model::ContactRules& rules_;
    int order_;
    int derivative_order_;
    double safety_;
    SeriesObserver<Jet> observer_;
    const Request* request_ = nullptr;
    T theta_{};
    Base elapsed_{};
    Base duration_{};
    Base step_{};
    T divided_gap_{};
    Phase phase_ = Phase::free;
    const Event* event_ = nullptr;
    Status status_ = Status::not_run;
    bool deflate_ = false;
    bool finished_ = false;
    int events_ = 0;
    long steps_ = 0;
};

}  // namespace PERCUSS_ISA
}  // namespace percuss::flow
