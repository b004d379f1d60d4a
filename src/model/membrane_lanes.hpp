#pragma once
/// \file
/// Taylor coefficients of several motions of one dielectric elastomer actuator at once, one per SIMD lane: the series
/// of model/membrane_jet.hpp without derivatives. Lanes differ in state, phase and contact, not in parameters.
///
/// Two coefficients are prepared in one sweep over the known ones, which halves the loads from memory: the sweep for
/// coefficients n and n + 1 takes the products whose factors are known before coefficient n is. What both membranes
/// have in common (u_I and u_II differ by the rod length) is convolved once.

#include "model/membrane_jet.hpp"
#include "model/parameters.hpp"
#include "numerics/lane_math.hpp"

#include <array>
#include <cstddef>

namespace percuss::model {
inline namespace PERCUSS_ISA {

/// Viscous = false leaves out the Maxwell branches: the state is then (x, x').
template <int N, bool Viscous, int MaxOrder>
class MembraneLanes {
public:
    static constexpr int lanes = N;
    static constexpr int states = Viscous ? 4 : 2;
    static constexpr int max_order = MaxOrder;
    using V = numerics::LaneVector<N>;
    using Series = std::array<V, MaxOrder + 1>;

    explicit MembraneLanes(const double* p)
        : single_(p),
          length_(p[membrane::length]),
          inverse_omega_(1.0 / p[membrane::omega]),
          half_alpha_a_(0.5 * p[membrane::alpha_a]),
          alpha_b_(p[membrane::alpha_b]),
          layers_(p[membrane::layers]) {
        using std::exp;
        using std::log;
        const double alpha = p[membrane::alpha_a];
        const double log_prestretch = log(p[membrane::lambda_p]);
        k1_ = exp((alpha - 2.0) * log_prestretch);
        k2_ = exp((-2.0 * alpha - 2.0) * log_prestretch);
        k3_ = p[membrane::mu_ratio] * exp(-2.0 * log_prestretch);
        damping_rate_ = p[membrane::delta_a] * p[membrane::omega];
        relaxation_ = inverse_omega_ / p[membrane::delta_b];
        phi_mean_ = 0.25 * p[membrane::voltage] * p[membrane::voltage];
    }

    [[nodiscard]] double stop_position() const { return single_.stop_position(); }
    [[nodiscard]] double stop_stiffness() const { return single_.stop_stiffness(); }
    [[nodiscard]] double stop_damping() const { return single_.stop_damping(); }
    [[nodiscard]] const Series& x() const { return x_; }
    [[nodiscard]] const Series& v() const { return v_; }

    /// Takes (x, x', xi_I, xi_II) into a lane.
    void load(std::size_t lane, const std::array<double, states>& y) {
        single_.load(y);
        x_[0].set(lane, y[0]);
        v_[0].set(lane, y[1]);
        if constexpr (Viscous) {
            sides_[0].l[0].set(lane, single_.stretch()[0]);
            sides_[1].l[0].set(lane, single_.stretch()[1]);
        }
    }
    /// Gives back (x, x', xi_I, xi_II) of a lane at the expansion point.
    [[nodiscard]] std::array<double, states> unload(std::size_t lane) {
        if constexpr (Viscous) { single_.stretch() = {sides_[0].l[0][lane], sides_[1].l[0][lane]}; }
        single_.set_position(x_[0][lane]);
        single_.velocity() = v_[0][lane];
        return single_.unload();
    }
    void set_position(std::size_t lane, double x) { x_[0].set(lane, x); }
    /// A lane that nobody uses is at rest.
    void clear(std::size_t lane) {
        x_[0].set(lane, 0.0);
        v_[0].set(lane, 0.0);
        for (Side& side : sides_) { side.l[0].set(lane, 1.0); }
    }

    /// Coefficients of x and v up to `order`. theta is the phase at the expansion point; stiffness and damping are
    /// those of the stop, zero in lanes that do not touch it.
    void expand(const V& theta, const V& stiffness, const V& damping, int order) {
        start(theta, stiffness, damping);
        Sums now{};
        Sums next{};
        for (int n = 0; n < order; n += 2) {
            sweep(n, now, next);
            extend(n, now);
            if (n + 1 == order) { break; }
            complete(n + 1, next);
            extend(n + 1, next);
        }
    }

    /// Moves the expansion point of each lane by its h.
    void advance(const V& h, int order) {
        V x = x_[at(order)];
        V v = v_[at(order)];
        V l0 = sides_[0].l[at(order)];
        V l1 = sides_[1].l[at(order)];
        for (int j = order - 1; j >= 0; --j) {
            x = x * h + x_[at(j)];
            v = v * h + v_[at(j)];
            if constexpr (Viscous) {
                l0 = l0 * h + sides_[0].l[at(j)];
                l1 = l1 * h + sides_[1].l[at(j)];
            }
        }
        x_[0] = x;
        v_[0] = v;
        if constexpr (Viscous) {
            sides_[0].l[0] = l0;
            sides_[1].l[0] = l1;
        }
    }

    /// Largest modulus of the j-th coefficients over the state, for the step size.
    [[nodiscard]] V norm(int j) const {
        V m = max(abs(x_[at(j)]), abs(v_[at(j)]));
        if constexpr (Viscous) { m = max(m, max(abs(sides_[0].l[at(j)]), abs(sides_[1].l[at(j)]))); }
        return m;
    }

private:
    using Part = typename V::Part;

    /// The series of one membrane, named as in model/membrane_jet.hpp.
    struct Side {
        Series s, w, p, q, root, e, l, m, z;
    };
    /// Sums of products of known coefficients, for one coefficient each.
    struct SideSums {
        V sw, pw, qw, rw, se, lz, mz;
    };
    struct Sums {
        SideSums side[2];
        V xx, xb;
    };

    static constexpr std::size_t at(int i) { return static_cast<std::size_t>(i); }

    void start(const V& theta, const V& stiffness, const V& damping) {
        stiffness_ = stiffness;
        damping_ = damping;
        cos_sin(theta, cos1_, sin1_);
        cos2_ = 2.0 * cos1_ * cos1_ - 1.0;
        sin2_ = 2.0 * sin1_ * cos1_;
        inverse_factorial_ = 1.0;
        power_of_two_ = 1.0;
        for (int k = 0; k < 2; ++k) {
            Side& side = sides_[k];
            u_[k] = k == 0 ? x_[0] : x_[0] - length_;
            side.s[0] = u_[k] * u_[k] + 1.0;
            inverse_s_[k] = 1.0 / side.s[0];
            const V log_s = log(side.s[0]);
            side.p[0] = exp(half_alpha_a_ * log_s);
            side.q[0] = 1.0 / side.p[0];
            side.root[0] = exp(-0.5 * log_s);
            if constexpr (Viscous) { side.m[0] = 1.0 / side.l[0]; }
        }
    }

    /// now: sums over j = 1..n of a_j b_(n-j), and of x_j x_(n+1-j); next: those terms of the sums for n + 1 that hold
    /// nothing later than coefficients n of a and n - 1 of b.
    void sweep(int n, Sums& now, Sums& next) const {
        for (int i = 0; i < V::parts; ++i) {
            for (int k = 0; k < 2; ++k) {
                const Side& side = sides_[k];
                sweep_log_derivative(side, n, i, now.side[k], next.side[k]);
                sweep_branch(side, n, i, now.side[k], next.side[k]);
            }
            sweep_common(n, i, now, next);
        }
    }

    PERCUSS_INLINE static void sweep_log_derivative(const Side& side, int n, int i, SideSums& now, SideSums& next) {
        Part s0{}, p0{}, q0{}, r0{}, s1{}, p1{}, q1{}, r1{};
        if (n > 0) {
            Part before = side.w[at(n - 1)].part[i];
            s0 = side.s[1].part[i] * before;
            p0 = side.p[1].part[i] * before;
            q0 = side.q[1].part[i] * before;
            r0 = side.root[1].part[i] * before;
            for (int j = 2; j <= n; ++j) {
                const Part w = side.w[at(n - j)].part[i];
                const Part s = side.s[at(j)].part[i];
                const Part p = side.p[at(j)].part[i];
                const Part q = side.q[at(j)].part[i];
                const Part r = side.root[at(j)].part[i];
                s0 += s * w, p0 += p * w, q0 += q * w, r0 += r * w;
                s1 += s * before, p1 += p * before, q1 += q * before, r1 += r * before;
                before = w;
            }
        }
        now.sw.part[i] = s0, now.pw.part[i] = p0, now.qw.part[i] = q0, now.rw.part[i] = r0;
        next.sw.part[i] = s1, next.pw.part[i] = p1, next.qw.part[i] = q1, next.rw.part[i] = r1;
    }

    PERCUSS_INLINE static void sweep_branch(const Side& side, int n, int i, SideSums& now, SideSums& next) {
        Part e0{}, l0{}, m0{}, e1{}, l1{}, m1{};
        if (n > 0) {
            Part e_before = side.e[at(n - 1)].part[i];
            Part z_before{};
            e0 = side.s[1].part[i] * e_before;
            if constexpr (Viscous) {
                z_before = side.z[at(n - 1)].part[i];
                l0 = side.l[1].part[i] * z_before;
                m0 = side.m[1].part[i] * z_before;
            }
            for (int j = 2; j <= n; ++j) {
                const Part e = side.e[at(n - j)].part[i];
                const Part s = side.s[at(j)].part[i];
                e0 += s * e, e1 += s * e_before;
                e_before = e;
                if constexpr (Viscous) {
                    const Part z = side.z[at(n - j)].part[i];
                    const Part l = side.l[at(j)].part[i];
                    const Part m = side.m[at(j)].part[i];
                    l0 += l * z, m0 += m * z;
                    l1 += l * z_before, m1 += m * z_before;
                    z_before = z;
                }
            }
        }
        now.se.part[i] = e0, now.lz.part[i] = l0, now.mz.part[i] = m0;
        next.se.part[i] = e1, next.lz.part[i] = l1, next.mz.part[i] = m1;
    }

    PERCUSS_INLINE void sweep_common(int n, int i, Sums& now, Sums& next) const {
        Part x0{}, b0{}, x1{}, b1{};
        if (n > 0) {
            Part b_before = b_[at(n - 1)].part[i];
            Part x_before = x_[at(n)].part[i];
            b0 = x_[1].part[i] * b_before;
            x0 = x_[1].part[i] * x_before;
            for (int j = 2; j <= n; ++j) {
                const Part x = x_[at(j)].part[i];
                const Part b = b_[at(n - j)].part[i];
                const Part other = x_[at(n + 1 - j)].part[i];
                b0 += x * b, b1 += x * b_before;
                x0 += x * other, x1 += x * x_before;
                b_before = b;
                x_before = other;
            }
        }
        now.xx.part[i] = x0, now.xb.part[i] = b0;
        next.xx.part[i] = x1, next.xb.part[i] = b1;
    }

    /// The terms that sweep(n - 1) could not have.
    void complete(int n, Sums& sums) const {
        const auto add = [n](V& sum, const Series& a, const Series& b) {
            sum += a[1] * b[at(n - 1)];
            if (n > 1) { sum += a[at(n)] * b[0]; }
        };
        for (int k = 0; k < 2; ++k) {
            const Side& side = sides_[k];
            SideSums& to = sums.side[k];
            add(to.sw, side.s, side.w);
            add(to.pw, side.p, side.w);
            add(to.qw, side.q, side.w);
            add(to.rw, side.root, side.w);
            add(to.se, side.s, side.e);
            if constexpr (Viscous) {
                add(to.lz, side.l, side.z);
                add(to.mz, side.m, side.z);
            }
        }
        add(sums.xb, x_, b_);
        sums.xx += (n > 1 ? 2.0 : 1.0) * (x_[1] * x_[at(n)]);
    }

    /// phi^2 = phi_pp^2/4 (3/2 -+ 2 cos theta + cos(2 theta)/2), coefficient n.
    void drive(int n, V& first, V& second) {
        if (n > 0) {
            inverse_factorial_ /= n;
            power_of_two_ *= 2.0;
        }
        // derivatives of cos cycle: cos, -sin, -cos, sin
        const double scale = (n % 4 == 1 || n % 4 == 2) ? -inverse_factorial_ : inverse_factorial_;
        const V c1 = (n % 2 == 0 ? cos1_ : sin1_) * (2.0 * phi_mean_ * scale);
        const V c2 = (n % 2 == 0 ? cos2_ : sin2_) * (0.5 * phi_mean_ * scale * power_of_two_);
        const V even = n == 0 ? c2 + 1.5 * phi_mean_ : c2;
        first = even - c1;
        second = even + c1;
    }

    /// From coefficients 0..n of x, v, L (and the internal series) to coefficient n + 1.
    void extend(int n, Sums& sums) {
        const double reciprocal = 1.0 / (n + 1);
        x_[at(n + 1)] = v_[at(n)] * (inverse_omega_ * reciprocal);
        V phi2[2];
        V b[2];
        drive(n, phi2[0], phi2[1]);
        for (int k = 0; k < 2; ++k) {
            Side& side = sides_[k];
            SideSums& sum = sums.side[k];
            const V next_s = sums.xx + 2.0 * (u_[k] * x_[at(n + 1)]);
            const V w = inverse_s_[k] * ((n + 1.0) * next_s - sum.sw);
            side.s[at(n + 1)] = next_s;
            side.w[at(n)] = w;
            side.p[at(n + 1)] = (half_alpha_a_ * reciprocal) * (sum.pw + side.p[0] * w);
            side.q[at(n + 1)] = (-half_alpha_a_ * reciprocal) * (sum.qw + side.q[0] * w);
            const V slope = -0.5 * (sum.rw + side.root[0] * w);
            side.root[at(n + 1)] = reciprocal * slope;
            V stress = k1_ * side.p[at(n)] - k2_ * side.q[at(n)];
            if constexpr (Viscous) {
                const V& l = side.l[at(n)];
                const V& m = side.m[at(n)];
                V excess = l - 0.5 * m;
                if (n == 0) { excess = excess - 0.5; }
                const V z = alpha_b_ * (0.5 * w - relaxation_ * excess);
                side.z[at(n)] = z;
                side.l[at(n + 1)] = reciprocal * (sum.lz + side.l[0] * z);
                side.m[at(n + 1)] = -reciprocal * (sum.mz + side.m[0] * z);
                stress += k3_ * (l - m);
            }
            side.e[at(n)] = inverse_s_[k] * (stress - sum.se);
            b[k] = side.e[at(n)] - damping_rate_ * slope - phi2[k];
        }
        b_[at(n)] = b[0] + b[1];
        V acceleration = -layers_ * (sums.xb + u_[0] * b[0] + u_[1] * b[1]);
        const V penetration = n == 0 ? x_[0] - stop_position() : x_[at(n)];
        acceleration -= stiffness_ * penetration + damping_ * v_[at(n)];
        v_[at(n + 1)] = acceleration * (inverse_omega_ * reciprocal);
    }

    MembraneJet<double, Viscous, 0> single_;  ///< converts states
    double length_, inverse_omega_, half_alpha_a_, alpha_b_, layers_;
    double k1_, k2_, k3_, damping_rate_, relaxation_, phi_mean_;
    double inverse_factorial_ = 1.0;
    double power_of_two_ = 1.0;
    V stiffness_, damping_, cos1_, sin1_, cos2_, sin2_;
    V u_[2], inverse_s_[2];
    Series x_, v_;
    Series b_;  ///< of both membranes together
    Side sides_[2];
};

}  // namespace PERCUSS_ISA
}  // namespace percuss::model
