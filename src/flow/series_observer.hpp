#pragma once
/// \file
/// Observables read off the Taylor series of each step: maxima at roots of the derivative's polynomial, integrals term
/// by term. Gradients of maxima follow from the envelope theorem: the time at which a smooth maximum is reached needs
/// no derivative. Values that sit at an event move with it, d(theta_e) = -(dx - dx_stop) / (dx/dtheta).

#include "flow/flow.hpp"
#include "numerics/dual.hpp"
#include "numerics/polynomial_roots.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <utility>
#include <vector>

namespace percuss::flow {
inline namespace PERCUSS_ISA {

template <class Jet>
class SeriesObserver {
public:
    using T = typename Jet::Scalar;
    using Base = typename Jet::Base;
    static constexpr int lanes = numerics::ScalarTraits<T>::lanes;

    struct Extremum {
        T value{};
        Base theta{};
        bool found = false;
        /// Keeps the larger of what it has and the candidate.
        void raise(const T& candidate, const Base& at) {
            if (!found || numerics::base(candidate) > numerics::base(value)) {
                value = candidate;
                theta = at;
                found = true;
            }
        }
    };

    explicit SeriesObserver(Jet& jet) : jet_(jet) {}

    void begin(std::uint32_t mask, const Base& theta, bool touching) {
        mask_ = mask;
        theta_ = theta;
        first_ = true;
        if (touching) { open_contact(theta, true); }
    }

    /// Called with the series of a step of length h, before it is taken. `event`: the step ends at an event; `last`: it
    /// ends the run.
    void step(int order, const Base& h, bool touching, bool event, bool last) {
        if (mask_ != observe_nothing) {
            order_ = order;
            h_ = h;
            last_ = last;
            if ((mask_ & observe_extrema) != 0U) { watch_extrema(); }
            if (touching && (mask_ & observe_force) != 0U) { watch_force(); }
            if ((mask_ & observe_acceleration) != 0U) { watch_acceleration(); }
            watch_peaks(std::make_integer_sequence<int, Jet::peaks>{});
            if ((mask_ & observe_energy) != 0U) { watch_energy(); }
            if constexpr (Jet::means > 0) {
                for (int k = 0; k < Jet::means; ++k) {
                    if ((mask_ & observe_mean(k)) != 0U) { watch_mean(k); }
                }
            }
            if (event) { remember_end(); }
            first_ = false;
        }
        theta_ += h;
    }

    /// Start of contact: entry on the surface, or (no-tension law) the force coming back inside the stop. Lanes still
    /// at fixed time.
    void enter(const Base& theta, bool on_surface) {
        open_contact(theta, false);
        if ((mask_ & (observe_force | observe_acceleration)) == 0U) { return; }
        const T shift = event_shift(on_surface);
        if ((mask_ & observe_force) != 0U) {
            if (on_surface) {
                const T v = jet_.velocity();
                const T speed = v + shift * numerics::base(end_acceleration_);
                impact_velocity_.raise(speed, theta);
                contact_peak_.raise(jet_.stop_damping() * speed, theta);
                const T overlap = displacement_lanes();
                // The force sets in at delta_i v, and the event moves by -overlap/v in tau (overlap: its lanes, value
                // zero): the integrals gain the product, from which v cancels. At the exit they lose it.
                impulse_ += jet_.stop_damping() * overlap;
                work_ += jet_.stop_damping() * v * overlap;
            }
            // Minus the time of entry here, plus that of release in exit(), each moving with its event.
            contact_time_ -= (T(theta) + shift * jet_.omega()) * jet_.inverse_omega();
        }
        discontinuity(shift, theta);
    }

    /// End of contact. `on_surface`: the displacement ended it; else the force did (no-tension law).
    void exit(const Base& theta, bool on_surface) {
        close_contact(theta, false);
        if ((mask_ & (observe_force | observe_acceleration)) == 0U) { return; }
        const T shift = event_shift(on_surface);
        if ((mask_ & observe_force) != 0U) {
            if (on_surface) {
                const T overlap = displacement_lanes();
                impulse_ -= jet_.stop_damping() * overlap;
                work_ -= jet_.stop_damping() * jet_.velocity() * overlap;
            }
            contact_time_ += (T(theta) + shift * jet_.omega()) * jet_.inverse_omega();
        }
        discontinuity(shift, theta);
    }

    void end(bool touching) {
        if (touching) { close_contact(theta_, true); }
        if ((mask_ & observe_extrema) != 0U) {
            x_max_.raise(jet_.position(), theta_);
            negative_x_min_.raise(-jet_.position(), theta_);
        }
        if ((mask_ & observe_force) != 0U && contact_open_since_start_) {
            contact_time_ -= T(open_from_) * jet_.inverse_omega();
        }
        if ((mask_ & observe_force) != 0U && touching) { contact_time_ += T(theta_) * jet_.inverse_omega(); }
    }

    // Results as the jet's scalar; valid after end().
    [[nodiscard]] const Extremum& x_max() const { return x_max_; }
    [[nodiscard]] const Extremum& negative_x_min() const { return negative_x_min_; }
    [[nodiscard]] const Extremum& peak_force() const { return peak_force_; }
    [[nodiscard]] Base runner_up() const { return runner_up_; }
    [[nodiscard]] const Extremum& impact_velocity() const { return impact_velocity_; }
    [[nodiscard]] const T& contact_time() const { return contact_time_; }
    [[nodiscard]] const T& impulse() const { return impulse_; }
    [[nodiscard]] const T& stop_work() const { return work_; }
    [[nodiscard]] const Extremum& peak_acceleration() const { return peak_acceleration_; }
    /// Largest value (or modulus) of peak signal k, zero where none was seen.
    [[nodiscard]] T peak(int k) const {
        const Extremum& found = peaks_[static_cast<std::size_t>(k)];
        if constexpr (Jet::peaks > 0) {
            if (found.found) { return jet_.peak_value(k, found.value); }
        }
        return T(0.0);
    }
    /// Integral over tau of mean signal k.
    [[nodiscard]] const T& mean(int k) const { return means_[static_cast<std::size_t>(k)]; }
    [[nodiscard]] const T& drive_work() const { return drive_work_; }
    [[nodiscard]] const T& dissipation() const { return dissipation_; }

    struct ContactRecord {
        Base theta_in{}, theta_out{};
        typename Jet::State state_in{}, state_out{};
        bool open_in = false, open_out = false;
        Base peak{};
    };
    [[nodiscard]] const std::vector<ContactRecord>& contacts() const { return contacts_; }

private:
    using Series = std::array<T, Jet::max_order + 1>;

    static T lanes_only(T a) {
        if constexpr (lanes > 0) {
            a.v = 0.0;
            return a;
        } else {
            return T(0.0);
        }
    }
    /// Of the stop, at the expansion point.
    [[nodiscard]] T force() const {
        return jet_.stop_stiffness() * (jet_.position() - jet_.stop_position()) + jet_.stop_damping() * jet_.velocity();
    }
    [[nodiscard]] T displacement_lanes() const { return lanes_only(jet_.position() - jet_.stop_position()); }
    /// d(tau of the event), value zero: displacement or force, held at zero, over its rate just before the event.
    [[nodiscard]] T event_shift(bool on_surface) const {
        const Base& v = numerics::base(jet_.velocity());
        if (on_surface) { return displacement_lanes() * (Base(-1) / v); }
        const Base slope = numerics::base(jet_.stop_stiffness()) * v +
                           numerics::base(jet_.stop_damping()) * numerics::base(end_acceleration_);
        return lanes_only(force()) * (Base(-1) / slope);
    }

    void open_contact(const Base& theta, bool open) {
        ContactRecord record;
        record.theta_in = theta;
        record.state_in = jet_.unload();
        record.open_in = open;
        contacts_.push_back(record);
        contact_peak_ = Extremum{};
        if (open) {
            contact_open_since_start_ = true;
            open_from_ = theta;
        }
    }
    void close_contact(const Base& theta, bool open) {
        ContactRecord& record = contacts_.back();
        record.theta_out = theta;
        record.state_out = jet_.unload();
        record.open_out = open;
        record.peak = contact_peak_.found ? numerics::base(contact_peak_.value) : Base(0);
        if (!contact_peak_.found) { return; }
        if (!peak_force_.found || record.peak > numerics::base(peak_force_.value)) {
            if (peak_force_.found) { runner_up_ = numerics::base(peak_force_.value); }
            peak_force_ = contact_peak_;
        } else if (record.peak > runner_up_) {
            runner_up_ = record.peak;
        }
    }

    template <class Coefficients>
    static T evaluate(const Coefficients& c, int degree, const Base& t) {
        T r = c[degree];
        for (int j = degree - 1; j >= 0; --j) { r = r * t + c[j]; }
        return r;
    }

    /// Local maxima (sign = -1: the derivative falls through zero) or minima (+1) of a series inside the step.
    template <class Coefficients, class Visit>
    void visit_extrema(const Coefficients& c, int degree, int sign, Visit visit) const {
        double derivative[numerics::max_degree + 1];
        derivative[0] = 0.0;  // the compiler cannot see that degree > 0
        double power = 1.0;
        for (int j = 1; j <= degree; ++j) {
            derivative[j - 1] = j * static_cast<double>(numerics::base(c[j])) * power;
            power *= static_cast<double>(h_);
        }
        double rest = 0.0;
        for (int j = 1; j < degree; ++j) { rest += std::abs(derivative[j]); }
        // The first term outweighs all others together: no root in the step, which is nearly always so.
        if (std::abs(derivative[0]) > rest) { return; }
        const numerics::Roots roots = numerics::sign_changes(derivative, degree - 1);
        for (int i = 0; i < roots.count; ++i) {
            if (roots.sign[static_cast<std::size_t>(i)] == sign) {
                visit(polish(c, degree, Base(roots.at[static_cast<std::size_t>(i)]) * h_));
            }
        }
    }
    /// Root of the derivative in the scalar's own precision.
    template <class Coefficients>
    static Base polish(const Coefficients& c, int degree, Base t) {
        if constexpr (sizeof(Base) > sizeof(double)) {
            // Three, for the digits of __float128, as for events.
            for (int iteration = 0; iteration < 3; ++iteration) {
                Base first = 0;
                Base second = 0;
                for (int j = degree; j >= 1; --j) {
                    second = second * t + first;
                    first = first * t + numerics::base(c[j]) * static_cast<Base>(j);
                }
                t = t - first / second;
            }
        }
        return t;
    }
    /// Whether the series can exceed `best` anywhere in the step.
    template <class Coefficients>
    [[nodiscard]] bool may_exceed(const Coefficients& c, int degree, const Extremum& best) const {
        if (!best.found) { return true; }
        double sum = static_cast<double>(numerics::base(c[0]));
        double power = 1.0;
        for (int j = 1; j <= degree; ++j) {
            power *= std::abs(static_cast<double>(h_));
            sum += std::abs(static_cast<double>(numerics::base(c[j]))) * power;
        }
        return sum > static_cast<double>(numerics::base(best.value));
    }
    /// Raises `best` by every local maximum of the series in the step, and by its two ends if asked.
    template <class Coefficients>
    void maximise(const Coefficients& c, int degree, Extremum& best, bool from_start) {
        // Where one step ends and the next begins nothing is lost: a maximum there is a root of the derivative in one
        // of them. The ends of the run, and of motions at events, are no roots and are looked at by themselves.
        if (from_start) { best.raise(c[0], theta_); }
        if (last_) { best.raise(evaluate(c, degree, h_), theta_ + h_); }
        // The sum of all moduli is cheap and spares most steps the isolation of roots.
        if (!may_exceed(c, degree, best)) { return; }
        visit_extrema(c, degree, -1, [&](const Base& t) { best.raise(evaluate(c, degree, t), theta_ + t); });
    }

    void watch_extrema() {
        const auto& x = jet_.x();
        if (first_) {
            x_max_.raise(x[0], theta_);
            negative_x_min_.raise(-x[0], theta_);
        }
        visit_extrema(x, order_, -1, [&](const Base& t) { x_max_.raise(evaluate(x, order_, t), theta_ + t); });
        visit_extrema(x, order_, +1,
                      [&](const Base& t) { negative_x_min_.raise(-evaluate(x, order_, t), theta_ + t); });
    }

    void watch_force() {
        for (int j = 0; j <= order_; ++j) {
            const T e = j == 0 ? jet_.x()[0] - jet_.stop_position() : jet_.x()[j];
            scratch_[j] = jet_.stop_stiffness() * e + jet_.stop_damping() * jet_.v()[j];
        }
        maximise(scratch_, order_, contact_peak_, first_);
        T impulse(0.0);
        // Horner over the integrals of the terms, c_n h^(n+1)/(n+1).
        for (int n = order_; n >= 0; --n) {
            impulse = impulse * h_ + scratch_[n] * (Base(1) / static_cast<Base>(n + 1));
        }
        // The product is carried to its full degree: cut at the order of its factors it would be much less exact.
        T work(0.0);
        for (int n = 2 * order_; n >= 0; --n) {
            T product(0.0);
            for (int j = std::max(0, n - order_); j <= std::min(n, order_); ++j) {
                product += scratch_[j] * jet_.v()[n - j];
            }
            work = work * h_ + product * (Base(1) / static_cast<Base>(n + 1));
        }
        impulse_ += impulse * h_ * jet_.inverse_omega();
        work_ += work * h_ * jet_.inverse_omega();
    }

    [[nodiscard]] T acceleration(int j) const { return jet_.v()[j + 1] * (jet_.omega() * static_cast<Base>(j + 1)); }

    void watch_acceleration() {
        for (int j = 0; j < order_; ++j) { scratch_[j] = acceleration(j); }
        // Right behind an event the acceleration has its new one-sided value, which moves with the event by the jerk.
        const T start = scratch_[0] + pending_shift_ * (numerics::base(scratch_[1]) * numerics::base(jet_.omega()));
        if (first_ || pending_) {
            peak_acceleration_.raise(start, theta_);
            peak_acceleration_.raise(-start, theta_);
            pending_ = false;
            pending_shift_ = T(0.0);
        }
        maximise(scratch_, order_ - 1, peak_acceleration_, false);
        for (int j = 0; j < order_; ++j) { scratch_[j] = -scratch_[j]; }
        maximise(scratch_, order_ - 1, peak_acceleration_, false);
    }

    template <int... K>
    void watch_peaks(std::integer_sequence<int, K...>) {
        (watch_peak<K>(), ...);
    }
    template <int K>
    void watch_peak() {
        if ((mask_ & observe_peak(K)) == 0U) { return; }
        constexpr model::PeakSignal signal = Jet::peak_signal(K);
        Extremum& best = peaks_[static_cast<std::size_t>(K)];
        for (int part = 0; part < signal.parts; ++part) {
            const int degree = jet_.peak_series(K, part, order_, scratch_);
            maximise(scratch_, degree, best, first_);
            if (!signal.of_modulus) { continue; }
            for (int n = 0; n <= degree; ++n) { scratch_[n] = -scratch_[n]; }
            maximise(scratch_, degree, best, first_);
        }
    }

    void watch_mean(int k) {
        T sum(0.0);
        for (int n = order_ - 1; n >= 0; --n) {
            sum = sum * h_ + jet_.mean(k, n) * (Base(1) / static_cast<Base>(n + 1));
        }
        means_[static_cast<std::size_t>(k)] += sum * h_ * jet_.inverse_omega();
    }

    void watch_energy() {
        T drive(0.0);
        T loss(0.0);
        for (int n = order_ - 1; n >= 0; --n) {
            const auto power = jet_.power(n);
            const Base weight = Base(1) / static_cast<Base>(n + 1);
            drive = drive * h_ + power[0] * weight;
            loss = loss * h_ + power[1] * weight;
        }
        drive_work_ += drive * h_ * jet_.inverse_omega();
        dissipation_ += loss * h_ * jet_.inverse_omega();
    }

    /// Acceleration and jerk just before an event.
    void remember_end() {
        for (int j = 0; j < order_; ++j) { scratch_[j] = acceleration(j); }
        end_acceleration_ = evaluate(scratch_, order_ - 1, h_);
        Base jerk = 0;
        for (int j = order_ - 1; j >= 1; --j) { jerk = jerk * h_ + numerics::base(scratch_[j]) * static_cast<Base>(j); }
        end_jerk_ = jerk * numerics::base(jet_.omega());
    }
    /// The acceleration jumps at an event: both of its one-sided values, moving with the event, are candidates.
    void discontinuity(const T& shift, const Base& theta) {
        if ((mask_ & observe_acceleration) == 0U) { return; }
        const T before = end_acceleration_ + shift * end_jerk_;
        peak_acceleration_.raise(before, theta);
        peak_acceleration_.raise(-before, theta);
        pending_ = true;
        pending_shift_ = shift;
    }

    Jet& jet_;
    std::uint32_t mask_ = 0;
    int order_ = 0;
    Base h_{};
    Base theta_{};
    bool first_ = true;
    bool last_ = false;
    bool pending_ = false;
    bool contact_open_since_start_ = false;
    Base open_from_{};
    Extremum x_max_, negative_x_min_, peak_force_, contact_peak_, impact_velocity_, peak_acceleration_;
    std::array<Extremum, model::max_peaks> peaks_;
    std::array<T, model::max_means> means_{};
    Base runner_up_{};
    T contact_time_{}, impulse_{}, work_{}, drive_work_{}, dissipation_{};
    T end_acceleration_{}, pending_shift_{};
    Base end_jerk_{};
    Series scratch_;
    std::vector<ContactRecord> contacts_;
};

}  // namespace PERCUSS_ISA
}  // namespace percuss::flow
