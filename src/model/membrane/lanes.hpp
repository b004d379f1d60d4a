#pragma once
/// \file
/// Taylor coefficients of several motions of one dielectric elastomer actuator at once, one per SIMD lane: the series
/// of model/membrane/jet.hpp without derivatives. Lanes differ in state, phase and contact, not in parameters.
///
/// With R = sqrt(s), which makes w = R'/R half the log-derivative of s = 1 + u^2,
///
///     C = k1 P - k2 Q,  C' = alpha_A G w      G = k1 P + k2 Q,  G' = alpha_A C w
///     L' = L z,  M' = -M z                    z = alpha_B (w - r)
///     f = u { [C + k3 (L - M) + delta_A omega R']/s - phi^2 } = u b
///
/// Two coefficients are prepared in one sweep over the known ones, which saves loads from memory: the sweep for
/// coefficients n and n + 1 takes the products whose factors are known before coefficient n is. What both membranes
/// have in common (u_I and u_II differ by the rod length) is convolved once. All series lie side by side, coefficient
/// by coefficient, so that they share the first-level cache evenly.

#include "model/membrane/jet.hpp"
#include "model/membrane/membrane.hpp"
#include "numerics/lane_math.hpp"

#include <array>
#include <cmath>
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

    explicit MembraneLanes(const double* p)
        : single_(p),
          length_(p[membrane::length]),
          half_alpha_a_(0.5 * p[membrane::alpha_a]),
          alpha_b_(p[membrane::alpha_b]),
          layers_(p[membrane::layers]),
          damping_rate_(p[membrane::delta_a] * p[membrane::omega]) {
        using std::exp;
        using std::log;
        const double alpha = p[membrane::alpha_a];
        const double log_prestretch = log(p[membrane::lambda_p]);
        const double inverse_omega = 1.0 / p[membrane::omega];
        k1_ = exp((alpha - 2.0) * log_prestretch);
        k2_ = exp((-2.0 * alpha - 2.0) * log_prestretch);
        k3_ = p[membrane::mu_ratio] * exp(-2.0 * log_prestretch);
        relaxation_ = alpha_b_ * inverse_omega / p[membrane::delta_b];
        // phi^2 = phi_pp^2/4 (3/2 -+ 2 cos theta + cos(2 theta)/2); derivatives of cos cycle: cos, -sin, -cos, sin
        const double mean = 0.25 * p[membrane::voltage] * p[membrane::voltage];
        double scale = mean;
        double scale2 = 0.5 * mean;
        mean_square_ = 1.5 * mean;
        for (int n = 0; n < MaxOrder; ++n) {
            const double sign = (n % 4 == 1 || n % 4 == 2) ? -1.0 : 1.0;
            Factors& f = factors_[static_cast<std::size_t>(n)];
            f.reciprocal = 1.0 / (n + 1);
            f.alpha = 2.0 * half_alpha_a_ * f.reciprocal;
            f.next = n + 1;
            f.rate = inverse_omega * f.reciprocal;
            f.cos1 = 2.0 * sign * scale;
            f.cos2 = sign * scale2;
            scale *= f.reciprocal;
            scale2 *= 2.0 * f.reciprocal;
        }
    }

    [[nodiscard]] double stop_position() const { return single_.stop_position(); }
    [[nodiscard]] double stop_stiffness() const { return single_.stop_stiffness(); }
    [[nodiscard]] double stop_damping() const { return single_.stop_damping(); }
    /// Coefficients of displacement and velocity.
    [[nodiscard]] const V& x(int n) const { return c_[n].x; }
    [[nodiscard]] const V& v(int n) const { return c_[n].v; }

    /// Takes (x, x', xi_I, xi_II) into a lane.
    void load(std::size_t lane, const std::array<double, states>& y) {
        single_.load(y);
        c_[0].x.set(lane, y[0]);
        c_[0].v.set(lane, y[1]);
        if constexpr (Viscous) {
            for (std::size_t k = 0; k < 2; ++k) { c_[0].side[k].l.set(lane, single_.stretch()[k]); }
        }
    }
    /// Gives back (x, x', xi_I, xi_II) of a lane at the expansion point.
    [[nodiscard]] std::array<double, states> unload(std::size_t lane) {
        if constexpr (Viscous) { single_.stretch() = {c_[0].side[0].l[lane], c_[0].side[1].l[lane]}; }
        single_.set_position(c_[0].x[lane]);
        single_.velocity() = c_[0].v[lane];
        return single_.unload();
    }
    void set_position(std::size_t lane, double x) { c_[0].x.set(lane, x); }
    /// A lane that nobody uses is at rest.
    void clear(std::size_t lane) {
        c_[0].x.set(lane, 0.0);
        c_[0].v.set(lane, 0.0);
        for (Side& side : c_[0].side) { side.l.set(lane, 1.0); }
    }

    /// Coefficients of x and v up to `order`. theta is the phase at the expansion point; stiffness and damping are
    /// those of the stop, zero in lanes that do not touch it.
    void expand(const V& theta, const V& stiffness, const V& damping, int order) {
        start(theta, stiffness, damping);
        Sums now;
        Sums next;
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
        V x = c_[order].x;
        V v = c_[order].v;
        V l0 = c_[order].side[0].l;
        V l1 = c_[order].side[1].l;
        for (int j = order - 1; j >= 0; --j) {
            x = x * h + c_[j].x;
            v = v * h + c_[j].v;
            if constexpr (Viscous) {
                l0 = l0 * h + c_[j].side[0].l;
                l1 = l1 * h + c_[j].side[1].l;
            }
        }
        c_[0].x = x;
        c_[0].v = v;
        if constexpr (Viscous) {
            c_[0].side[0].l = l0;
            c_[0].side[1].l = l1;
        }
    }

    /// Largest modulus of the j-th coefficients over the state, for the step size.
    [[nodiscard]] V norm(int j) const {
        V m = max(abs(c_[j].x), abs(c_[j].v));
        if constexpr (Viscous) { m = max(m, max(abs(c_[j].side[0].l), abs(c_[j].side[1].l))); }
        return m;
    }

private:
    using Part = typename V::Part;

    /// The j-th coefficients of all series.
    struct Side {
        V s, root, w, c, g, e, l, m, z;
    };
    struct Coefficients {
        V x, v, b;  ///< b: of both membranes together
        Side side[2];
    };
    /// Sums of products of known coefficients.
    struct SideSums {
        V rr, rw, cw, gw, se, lz, mz;
    };
    struct Sums {
        SideSums side[2];
        V xx, xb;
    };
    /// What coefficient n + 1 is made with.
    struct Factors {
        double reciprocal, next, alpha, rate, cos1, cos2;
    };

    void start(const V& theta, const V& stiffness, const V& damping) {
        stiffness_ = stiffness;
        damping_ = damping;
        cos_sin(theta, cos1_, sin1_);
        // Double angle: one cosine and sine per step do.
        cos2_ = 2.0 * cos1_ * cos1_ - 1.0;
        sin2_ = 2.0 * sin1_ * cos1_;
        for (int k = 0; k < 2; ++k) {
            Side& side = c_[0].side[k];
            u_[k] = k == 0 ? c_[0].x : c_[0].x - length_;
            twice_u_[k] = 2.0 * u_[k];
            side.s = u_[k] * u_[k] + 1.0;
            const V log_s = log(side.s);
            // The only power of the step, P = s^(alpha_A/2).
            const V p = exp(half_alpha_a_ * log_s);
            const V q = k2_ / p;
            side.c = k1_ * p - q;
            side.g = k1_ * p + q;
            side.root = exp(0.5 * log_s);
            inverse_root_[k] = 1.0 / side.root;
            half_inverse_root_[k] = 0.5 * inverse_root_[k];
            inverse_s_[k] = 1.0 / side.s;
            if constexpr (Viscous) { side.m = 1.0 / side.l; }
        }
    }

    /// now: sums over j = 1..n of a_j b_(n-j), and of a_j a_(n+1-j) for squares. next: those terms of the sums for n +
    /// 1 that hold nothing later than coefficient n of a and n - 1 of b. n is even. The terms that became known last
    /// are added last, so that the processor need not wait for them.
    void sweep(int n, Sums& now, Sums& next) const {
        for (int i = 0; i < V::parts; ++i) {
            for (int k = 0; k < 2; ++k) { sweep_side(n, k, i, now.side[k], next.side[k]); }
            sweep_squares(n, i, now, next);
        }
    }

    /// Keeps a number in a register where the compiler would read it from memory again for the next product.
    PERCUSS_INLINE static Part hold(Part a) {
#if defined(__AVX512F__)
        asm("" : "+v"(a));
#elif defined(__x86_64__)
        asm("" : "+x"(a));
#endif
        return a;
    }

    /// Products with w, for the sums of n and of n + 1.
    struct ElasticProducts {
        Part r0{}, c0{}, g0{}, r1{}, c1{}, g1{};
        PERCUSS_INLINE void add(const Side& a, int i, const Part& w, const Part& w_next) {
            const Part r = hold(a.root.part[i]);
            const Part c = hold(a.c.part[i]);
            const Part g = hold(a.g.part[i]);
            r0 += r * w, c0 += c * w, g0 += g * w;
            r1 += r * w_next, c1 += c * w_next, g1 += g * w_next;
        }
        PERCUSS_INLINE void add_now(const Side& a, int i, const Part& w) {
            r0 += a.root.part[i] * w, c0 += a.c.part[i] * w, g0 += a.g.part[i] * w;
        }
    };
    /// Products with e and z.
    struct ViscousProducts {
        Part e0{}, l0{}, m0{}, e1{}, l1{}, m1{};
        PERCUSS_INLINE void add(const Side& a, int i, const Part& e, const Part& z, const Part& e_next,
                                const Part& z_next) {
            const Part s = hold(a.s.part[i]);
            e0 += s * e, e1 += s * e_next;
            if constexpr (Viscous) {
                const Part l = hold(a.l.part[i]);
                const Part m = hold(a.m.part[i]);
                l0 += l * z, m0 += m * z;
                l1 += l * z_next, m1 += m * z_next;
            }
        }
        PERCUSS_INLINE void add_now(const Side& a, int i, const Part& e, const Part& z) {
            e0 += a.s.part[i] * e;
            if constexpr (Viscous) { l0 += a.l.part[i] * z, m0 += a.m.part[i] * z; }
        }
    };

    /// Both kinds of products of one membrane. Two loops: the sums of one kind and their factors fit 16 registers.
    PERCUSS_INLINE void sweep_side(int n, int k, int i, SideSums& now, SideSums& next) const {
        ElasticProducts elastic;
        ViscousProducts viscous;
        if (n > 0) {
            const auto side = [&](int j) -> const Side& { return c_[j].side[k]; };
            const auto w = [&](int j) { return hold(side(j).w.part[i]); };
            const auto e = [&](int j) { return hold(side(j).e.part[i]); };
            const auto z = [&](int j) { return Viscous ? hold(side(j).z.part[i]) : Part{}; };
            Part w_next = w(n - 2);
            Part e_next = e(n - 2);
            Part z_next = z(n - 2);
            for (int j = 3; j < n; ++j) {
                const Part w_now = w(n - j);
                elastic.add(side(j), i, w_now, w_next);
                w_next = w_now;
            }
            for (int j = 3; j < n; ++j) {
                const Part e_now = e(n - j);
                const Part z_now = z(n - j);
                viscous.add(side(j), i, e_now, z_now, e_next, z_next);
                e_next = e_now;
                z_next = z_now;
            }
            elastic.add(side(2), i, w(n - 2), w(n - 1));
            viscous.add(side(2), i, e(n - 2), z(n - 2), e(n - 1), z(n - 1));
            elastic.add_now(side(1), i, w(n - 1));
            viscous.add_now(side(1), i, e(n - 1), z(n - 1));
            if (n > 2) {
                elastic.add(side(n), i, w(0), w(1));
                viscous.add(side(n), i, e(0), z(0), e(1), z(1));
            }
        }
        now.rw.part[i] = elastic.r0, now.cw.part[i] = elastic.c0, now.gw.part[i] = elastic.g0;
        next.rw.part[i] = elastic.r1, next.cw.part[i] = elastic.c1, next.gw.part[i] = elastic.g1;
        now.se.part[i] = viscous.e0, now.lz.part[i] = viscous.l0, now.mz.part[i] = viscous.m0;
        next.se.part[i] = viscous.e1, next.lz.part[i] = viscous.l1, next.mz.part[i] = viscous.m1;
    }

    /// Squares of x and of the roots, half of whose terms come twice, and x b.
    PERCUSS_INLINE void sweep_squares(int n, int i, Sums& now, Sums& next) const {
        Part x0{}, p0{}, q0{}, b0{}, x1{}, p1{}, q1{}, b1{};
        if (n > 0) {
            const Coefficients& middle = c_[n / 2 + 1];
            Part x_high = hold(middle.x.part[i]);
            Part p_high = hold(middle.side[0].root.part[i]);
            Part q_high = hold(middle.side[1].root.part[i]);
            Part b_high = hold(c_[n / 2].b.part[i]);
            x1 = 0.5 * x_high * x_high, p1 = 0.5 * p_high * p_high, q1 = 0.5 * q_high * q_high;
            b1 = x_high * b_high;
            for (int j = n / 2; j >= 2; --j) {
                const Coefficients& low = c_[j];
                const Coefficients& high = c_[n + 2 - j];
                const Part x = hold(low.x.part[i]);
                const Part p = hold(low.side[0].root.part[i]);
                const Part q = hold(low.side[1].root.part[i]);
                const Part b = hold(c_[j - 1].b.part[i]);
                x0 += x * x_high, p0 += p * p_high, q0 += q * q_high;
                b0 += x * b_high, b0 += x_high * b;
                x_high = hold(high.x.part[i]);
                p_high = hold(high.side[0].root.part[i]);
                q_high = hold(high.side[1].root.part[i]);
                b_high = hold(c_[n + 1 - j].b.part[i]);
                x1 += x * x_high, p1 += p * p_high, q1 += q * q_high;
                b1 += x * b_high, b1 += x_high * b;
            }
            const Coefficients& one = c_[1];
            b0 += one.x.part[i] * b_high, b0 += x_high * c_[0].b.part[i];
            x0 += one.x.part[i] * x_high;
            p0 += one.side[0].root.part[i] * p_high;
            q0 += one.side[1].root.part[i] * q_high;
        }
        now.xx.part[i] = 2.0 * x0, now.side[0].rr.part[i] = 2.0 * p0, now.side[1].rr.part[i] = 2.0 * q0;
        next.xx.part[i] = 2.0 * x1, next.side[0].rr.part[i] = 2.0 * p1, next.side[1].rr.part[i] = 2.0 * q1;
        now.xb.part[i] = b0;
        next.xb.part[i] = b1;
    }

    /// The terms that sweep(n - 1) could not have.
    void complete(int n, Sums& sums) const {
        const double twice = n > 1 ? 2.0 : 1.0;
        for (int k = 0; k < 2; ++k) {
            SideSums& to = sums.side[k];
            const auto add = [&](const Side& a, const Side& b) {
                to.rw += a.root * b.w;
                to.cw += a.c * b.w;
                to.gw += a.g * b.w;
                to.se += a.s * b.e;
                if constexpr (Viscous) {
                    to.lz += a.l * b.z;
                    to.mz += a.m * b.z;
                }
            };
            add(c_[1].side[k], c_[n - 1].side[k]);
            if (n > 1) { add(c_[n].side[k], c_[0].side[k]); }
            to.rr += twice * c_[1].side[k].root * c_[n].side[k].root;
        }
        sums.xb += c_[1].x * c_[n - 1].b;
        if (n > 1) { sums.xb += c_[n].x * c_[0].b; }
        sums.xx += twice * c_[1].x * c_[n].x;
    }

    /// From coefficients 0..n of x, v, L (and the internal series) to coefficient n + 1: the motion first, on which the
    /// next coefficient waits, then the powers of s.
    void extend(int n, const Sums& sums) {
        const Factors& factor = factors_[static_cast<std::size_t>(n)];
        Coefficients& now = c_[n];
        Coefficients& next = c_[n + 1];
        next.x = now.v * factor.rate;
        const V cos1 = (n % 2 == 0 ? cos1_ : sin1_) * factor.cos1;
        V even = (n % 2 == 0 ? cos2_ : sin2_) * factor.cos2;
        if (n == 0) { even = even + mean_square_; }
        const V phi2[2] = {even - cos1, even + cos1};
        V slope[2];
        V b[2];
        for (int k = 0; k < 2; ++k) {
            const SideSums& sum = sums.side[k];
            Side& from = now.side[k];
            Side& to = next.side[k];
            // s = 1 + u^2 and R R = s, each solved for its newest coefficient; then s e = C + k3 (L - M) + delta_A
            // omega R'.
            to.s = sums.xx + twice_u_[k] * next.x;
            to.root = half_inverse_root_[k] * (to.s - sum.rr);
            slope[k] = factor.next * to.root;
            V stress = from.c - sum.se;
            if constexpr (Viscous) { stress += k3_ * (from.l - from.m); }
            from.e = inverse_s_[k] * (stress + damping_rate_ * slope[k]);
            b[k] = from.e - phi2[k];
        }
        now.b = b[0] + b[1];
        const V penetration = n == 0 ? now.x - stop_position() : now.x;
        const V stop = stiffness_ * penetration + damping_ * now.v;
        const V force = sums.xb + u_[0] * b[0] + u_[1] * b[1];
        next.v = (layers_ * force + stop) * -factor.rate;
        for (int k = 0; k < 2; ++k) {
            const SideSums& sum = sums.side[k];
            const Side& first = c_[0].side[k];
            Side& from = now.side[k];
            Side& to = next.side[k];
            // R w = R', C' = alpha_A G w, G' = alpha_A C w, L' = L z, M' = -M z.
            from.w = inverse_root_[k] * (slope[k] - sum.rw);
            to.c = factor.alpha * (sum.gw + first.g * from.w);
            to.g = factor.alpha * (sum.cw + first.c * from.w);
            if constexpr (Viscous) {
                V excess = from.l - 0.5 * from.m;
                if (n == 0) { excess = excess - 0.5; }
                from.z = alpha_b_ * from.w - relaxation_ * excess;
                to.l = factor.reciprocal * (sum.lz + first.l * from.z);
                to.m = -factor.reciprocal * (sum.mz + first.m * from.z);
            }
        }
    }

    MembraneJet<double, Viscous, 0> single_;  ///< converts states
    double length_, half_alpha_a_, alpha_b_, layers_, damping_rate_;
    double k1_, k2_, k3_, relaxation_, mean_square_;
    std::array<Factors, static_cast<std::size_t>(MaxOrder)> factors_;
    V stiffness_, damping_, cos1_, sin1_, cos2_, sin2_;
    V u_[2], twice_u_[2], inverse_s_[2], inverse_root_[2], half_inverse_root_[2];
    Coefficients c_[MaxOrder + 1];
};

}  // namespace PERCUSS_ISA
}  // namespace percuss::model
