#pragma once
/// \file
/// The driven linear oscillator with a stop, exactly: between events the motion is a particular solution plus two
/// exponentials, evaluated in long double; events are bracketed by fine sampling and bisected.

#include "flow/flow.hpp"
#include "model/membrane/membrane.hpp"
#include "model/spring/spring.hpp"

#include <array>
#include <cmath>
#include <complex>
#include <stdexcept>
#include <vector>

namespace percuss::test {

class PiecewiseLinear {
public:
    using Real = long double;
    using Complex = std::complex<Real>;
    enum class Mode { free, contact, slack };  ///< slack: inside the stop, no force on it (no-tension law)

    struct Contact {
        Real theta_in, theta_out, v_in, v_out;
        bool open_in = false, open_out = false;
    };

    /// parameters as in model::spring; the cubic term must be zero.
    PiecewiseLinear(const flow::ParameterVector& p, model::ContactLaw law) : law_(law) {
        if (p[model::spring::cubic] != 0.0) { throw std::invalid_argument("piecewise linear: no cubic spring"); }
        c_ = p[model::spring::damping];
        k_ = p[model::spring::stiffness];
        force_ = p[model::spring::force];
        gap_ = p[model::spring::gap];
        stop_k_ = p[model::spring::stop_stiffness];
        stop_c_ = p[model::spring::stop_damping];
        w_ = p[model::spring::omega];
    }

    /// Follows the motion from a state in flight or in contact.
    void run(const flow::State& start, Real theta, Real duration) {
        x_ = start[0];
        v_ = start[1];
        theta_ = theta;
        const Real end = theta + duration;
        mode_ = x_ > gap_
                  ? (law_ == model::ContactLaw::no_tension && stop_force(x_, v_) < 0 ? Mode::slack : Mode::contact)
                  : Mode::free;
        if (mode_ == Mode::contact) { open(true); }
        while (follow(end)) {}
        if (mode_ == Mode::contact) { close(true); }
    }

    [[nodiscard]] Real x() const { return x_; }
    [[nodiscard]] Real v() const { return v_; }
    [[nodiscard]] const std::vector<Contact>& contacts() const { return contacts_; }
    [[nodiscard]] Real contact_time() const { return contact_time_; }  ///< in tau
    [[nodiscard]] Real impulse() const { return impulse_; }
    [[nodiscard]] Real work() const { return work_; }
    [[nodiscard]] Real peak_force() const { return peak_; }

private:
    /// Motion since the phase `from`: x and v at a later phase.
    struct Piece {
        Complex s1, s2, a1, a2;
        Real offset, cosine, sine, w, from;
        [[nodiscard]] std::array<Real, 2> at(Real theta) const {
            const Real t = (theta - from) / w;
            const Complex e1 = a1 * std::exp(s1 * t);
            const Complex e2 = a2 * std::exp(s2 * t);
            const Real c = std::cos(theta);
            const Real s = std::sin(theta);
            return {offset + cosine * c + sine * s + (e1 + e2).real(),
                    w * (sine * c - cosine * s) + (s1 * e1 + s2 * e2).real()};
        }
    };

    [[nodiscard]] Real stop_force(Real x, Real v) const { return stop_k_ * (x - gap_) + stop_c_ * v; }

    [[nodiscard]] Piece piece() const {
        const bool touching = mode_ == Mode::contact;
        const Real c = c_ + (touching ? stop_c_ : 0.0L);
        const Real k = k_ + (touching ? stop_k_ : 0.0L);
        Piece p;
        p.w = w_;
        p.from = theta_;
        p.offset = touching ? stop_k_ * gap_ / k : 0.0L;
        const Real stiff = k - w_ * w_;
        const Real unit = force_ / (stiff * stiff + c * c * w_ * w_);
        p.cosine = unit * stiff;
        p.sine = unit * c * w_;
        const Complex root = std::sqrt(Complex(0.25L * c * c - k));
        p.s1 = -0.5L * c + root;
        p.s2 = -0.5L * c - root;
        p.a1 = p.a2 = 0.0L;
        const auto rest = p.at(theta_);
        const Complex x = x_ - rest[0];
        const Complex v = v_ - rest[1];
        p.a1 = (v - p.s2 * x) / (p.s1 - p.s2);
        p.a2 = x - p.a1;
        return p;
    }

    /// One piece, up to its event or the end; false at the end.
    bool follow(Real end) {
        const Piece p = piece();
        const auto gap = [&](Real theta) { return p.at(theta)[0] - gap_; };
        const auto force = [&](Real theta) {
            const auto y = p.at(theta);
            return stop_force(y[0], y[1]);
        };
        const Real fastest = std::sqrt(k_ + (mode_ == Mode::contact ? stop_k_ : 0.0L)) + w_;
        const Real sample = 4e-3L * w_ / fastest;
        Real last = theta_;
        for (bool first = true; last < end; first = false) {
            const Real next = std::min(end, last + sample);
            switch (mode_) {
                case Mode::free:
                    // A piece that starts on the surface moves away from it. Excursions shorter than a sample, less
                    // than 1e-6 of the amplitude, would be missed.
                    if (gap(next) > 0) { return finish(p, bisect(gap, last, next, first), end, Mode::contact); }
                    break;
                case Mode::contact:
                    if (law_ == model::ContactLaw::kelvin_voigt ? gap(next) < 0 : force(next) < 0) {
                        const bool kelvin = law_ == model::ContactLaw::kelvin_voigt;
                        const Real at = kelvin ? bisect(gap, last, next, first) : bisect(force, last, next, first);
                        return finish(p, at, end, kelvin || stop_c_ == 0 ? Mode::free : Mode::slack);
                    }
                    break;
                case Mode::slack:
                    if (force(next) > 0) { return finish(p, bisect(force, last, next, first), end, Mode::contact); }
                    if (gap(next) < 0) { return finish(p, bisect(gap, last, next, first), end, Mode::free); }
                    break;
            }
            last = next;
        }
        finish(p, end, end, mode_);
        return false;
    }

    template <class Function>
    static Real bisect(Function&& f, Real low, Real high, bool starts_on_root) {
        const bool above = f(high) > 0;
        if (starts_on_root) {  // the root at the start itself is not meant
            Real inner = low + 0.5L * (high - low);
            while ((f(inner) > 0) == above && inner - low > 1e-17L) { inner = low + 0.5L * (inner - low); }
            low = inner;
        }
        for (int i = 0; i < 70; ++i) {
            const Real middle = 0.5L * (low + high);
            ((f(middle) > 0) == above ? high : low) = middle;
        }
        return 0.5L * (low + high);
    }

    bool finish(const Piece& p, Real theta, Real end, Mode next) {
        if (mode_ == Mode::contact) { integrate(p, theta); }
        const auto y = p.at(theta);
        x_ = y[0];
        v_ = y[1];
        theta_ = theta;
        const Mode before = mode_;
        mode_ = next;
        if (before == next) { return theta < end; }
        if (before == Mode::contact) { close(false); }
        if (next == Mode::contact) { open(false); }
        if (next == Mode::free || before == Mode::free) { x_ = gap_; }
        return true;
    }
    void open(bool at_start) { contacts_.push_back({theta_, 0, v_, 0, at_start, false}); }
    void close(bool at_end) {
        contacts_.back().theta_out = theta_;
        contacts_.back().v_out = v_;
        contacts_.back().open_out = at_end;
    }

    /// Force, impulse and work of a contact piece by Boole's rule on intervals of 0.008 of the shortest time scale:
    /// relative error 1e-13.
    void integrate(const Piece& p, Real end) {
        const Real fastest = std::max(std::abs(p.s1), std::abs(p.s2)) + w_;
        const int n = 4 * static_cast<int>(std::ceil(fastest * (end - theta_) / w_ / 0.032L) + 10);
        const Real h = (end - theta_) / n;
        int largest = 0;
        for (int i = 0; i <= n; ++i) {
            const auto y = p.at(theta_ + h * i);
            const Real f = stop_force(y[0], y[1]);
            constexpr std::array<int, 4> boole = {14, 32, 12, 32};
            const Real weight = (i == 0 || i == n ? 7 : boole[static_cast<std::size_t>(i % 4)]) * 2 * h / 45 / w_;
            impulse_ += weight * f;
            work_ += weight * f * y[1];
            if (f > peak_) {
                peak_ = f;
                largest = i;
            }
        }
        contact_time_ += (end - theta_) / w_;
        // Ternary search around the largest sample; the value is good to the square of its last interval.
        Real low = theta_ + h * std::max(0, largest - 1);
        Real high = theta_ + h * std::min(n, largest + 1);
        const auto force = [&](Real theta) {
            const auto y = p.at(theta);
            return stop_force(y[0], y[1]);
        };
        for (int i = 0; i < 60; ++i) {
            const Real third = (high - low) / 3;
            (force(low + third) < force(high - third) ? low : high) =
                force(low + third) < force(high - third) ? low + third : high - third;
        }
        peak_ = std::max(peak_, force(0.5L * (low + high)));
    }

    model::ContactLaw law_;
    Real c_, k_, force_, gap_, stop_k_, stop_c_, w_;
    Real x_ = 0, v_ = 0, theta_ = 0;
    Mode mode_ = Mode::free;
    std::vector<Contact> contacts_;
    Real contact_time_ = 0, impulse_ = 0, work_ = 0, peak_ = 0;
};

}  // namespace percuss::test
