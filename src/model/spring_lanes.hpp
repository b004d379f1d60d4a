#pragma once
/// \file
/// Taylor coefficients of several motions of one spring-mass actuator at once, one per SIMD lane: the series of
/// model/spring_jet.hpp without derivatives. Lanes differ in state, phase and contact, not in parameters.

#include "model/parameters.hpp"
#include "numerics/lane_math.hpp"

#include <array>
#include <cstddef>

namespace percuss::model {
inline namespace PERCUSS_ISA {

template <int N, int MaxOrder>
class SpringLanes {
public:
    static constexpr int lanes = N;
    static constexpr int states = 2;
    static constexpr int max_order = MaxOrder;
    using V = numerics::LaneVector<N>;
    using Series = std::array<V, MaxOrder + 1>;

    explicit SpringLanes(const double* p)
        : c_(p[spring::damping]),
          k1_(p[spring::stiffness]),
          k3_(p[spring::cubic]),
          force_(p[spring::force]),
          x_stop_(p[spring::gap]),
          stop_stiffness_(p[spring::stop_stiffness]),
          stop_damping_(p[spring::stop_damping]),
          inverse_omega_(1.0 / p[spring::omega]) {}

    [[nodiscard]] double stop_position() const { return x_stop_; }
    [[nodiscard]] double stop_stiffness() const { return stop_stiffness_; }
    [[nodiscard]] double stop_damping() const { return stop_damping_; }
    /// Coefficients of displacement and velocity.
    [[nodiscard]] const V& x(int n) const { return x_[at(n)]; }
    [[nodiscard]] const V& v(int n) const { return v_[at(n)]; }

    /// Takes (x, x') into a lane.
    void load(std::size_t lane, const std::array<double, states>& y) {
        x_[0].set(lane, y[0]);
        v_[0].set(lane, y[1]);
    }
    [[nodiscard]] std::array<double, states> unload(std::size_t lane) const { return {x_[0][lane], v_[0][lane]}; }
    void set_position(std::size_t lane, double x) { x_[0].set(lane, x); }
    /// A lane that nobody uses is at rest.
    void clear(std::size_t lane) { load(lane, {0.0, 0.0}); }

    /// Coefficients up to `order`. theta is the phase at the expansion point; stiffness and damping are those of the
    /// stop, zero in lanes that do not touch it.
    void expand(const V& theta, const V& stiffness, const V& damping, int order) {
        V c;
        V s;
        cos_sin(theta, c, s);
        double scale = force_;
        for (int n = 0; n < order; ++n) {
            if (n > 0) { scale /= n; }
            // derivatives of cos cycle: cos, -sin, -cos, sin
            const double factor = (n % 4 == 1 || n % 4 == 2) ? -scale : scale;
            V acceleration = (n % 2 == 0 ? c : s) * factor - c_ * v_[at(n)] - k1_ * x_[at(n)];
            if (k3_ != 0.0) { acceleration -= k3_ * cube(n); }
            const V penetration = n == 0 ? x_[0] - x_stop_ : x_[at(n)];
            acceleration -= stiffness * penetration + damping * v_[at(n)];
            const double rate = inverse_omega_ / (n + 1);
            x_[at(n + 1)] = v_[at(n)] * rate;
            v_[at(n + 1)] = acceleration * rate;
        }
    }

    /// Moves the expansion point of each lane by its h.
    void advance(const V& h, int order) {
        V x = x_[at(order)];
        V v = v_[at(order)];
        for (int j = order - 1; j >= 0; --j) {
            x = x * h + x_[at(j)];
            v = v * h + v_[at(j)];
        }
        x_[0] = x;
        v_[0] = v;
    }

    /// Largest modulus of the j-th coefficients over the state, for the step size.
    [[nodiscard]] V norm(int j) const { return max(abs(x_[at(j)]), abs(v_[at(j)])); }

private:
    static constexpr std::size_t at(int i) { return static_cast<std::size_t>(i); }

    /// Coefficient n of x^3, given x up to there.
    V cube(int n) {
        V square = x_[0] * x_[at(n)];
        for (int j = 1; j <= n; ++j) { square += x_[at(j)] * x_[at(n - j)]; }
        square_[at(n)] = square;
        V result = square_[0] * x_[at(n)];
        for (int j = 1; j <= n; ++j) { result += square_[at(j)] * x_[at(n - j)]; }
        return result;
    }

    double c_, k1_, k3_, force_, x_stop_, stop_stiffness_, stop_damping_, inverse_omega_;
    Series x_, v_, square_;
};

}  // namespace PERCUSS_ISA
}  // namespace percuss::model
