#pragma once
/// \file
/// The dielectric elastomer actuator as a right-hand side made for speed, so that step-by-step integrators compete at
/// their best. src/kernels/plain_systems.cpp evaluates the equations as they are printed, with some twenty powers per
/// call; this is the rearranged form of model/membrane/jet.hpp: with s = 1 + u^2, P = s^(alpha_A/2),
/// L = (lambda_p sqrt(s)/xi)^alpha_B,
///
///     f = u { [k1 P - k2/P + k3 (L - 1/L)]/s + delta_A u s^(-3/2) x' - phi^2 },   xi' = xi (L - 1/(2 L) - 1/2)/delta_B
///
/// four logarithms, four exponentials, two square roots and a cosine per call. What depends on the parameters alone is
/// kept from call to call: not to be shared between threads.

#include "flow/flow.hpp"
#include "flow/right_hand_side.hpp"
#include "kernels/plain_systems.hpp"
#include "model/membrane/membrane.hpp"
#include "model/spring/spring.hpp"
#include "numerics/dual.hpp"

#include <array>
#include <cmath>
#include <cstddef>
#include <memory>
#include <span>

namespace percuss::bench {

class LeanMembranes final : public flow::RightHandSide {
public:
    explicit LeanMembranes(model::ContactLaw law) : plain_(kernels::make_plain_system(model::membrane::viscous, law)) {}

    [[nodiscard]] const flow::SystemInfo& info() const override { return plain_->info(); }
    [[nodiscard]] model::ContactLaw contact_law() const override { return plain_->contact_law(); }
    [[nodiscard]] bool meaningful(const flow::State& state) const override { return plain_->meaningful(state); }
    [[nodiscard]] double centre(const flow::ParameterVector& p) const override { return plain_->centre(p); }
    [[nodiscard]] double centre_derivative(const flow::ParameterVector& p,
                                           const flow::ParameterVector& dp) const override {
        return plain_->centre_derivative(p, dp);
    }
    [[nodiscard]] flow::State rest_state(const flow::ParameterVector& p) const override {
        return plain_->rest_state(p);
    }
    [[nodiscard]] double linear_resonance(const flow::ParameterVector& p) const override {
        return plain_->linear_resonance(p);
    }
    [[nodiscard]] bool symmetric(const flow::ParameterVector& p) const override { return plain_->symmetric(p); }
    void means(const flow::ParameterVector& p, double theta, const flow::State& state,
               std::span<const flow::Direction> directions, flow::Means& value, flow::Means* value_d) const override {
        plain_->means(p, theta, state, directions, value, value_d);
    }
    void powers(const flow::ParameterVector& p, double theta, const flow::State& state,
                std::span<const flow::Direction> directions, flow::Powers& value,
                flow::Powers* value_d) const override {
        plain_->powers(p, theta, state, directions, value, value_d);
    }
    [[nodiscard]] double peak(int which, int side, const flow::ParameterVector& p, double theta,
                              const flow::State& state, std::span<const flow::Direction> directions,
                              double* value_d) const override {
        return plain_->peak(which, side, p, theta, state, directions, value_d);
    }

    void rates(const flow::ParameterVector& p, double theta, const flow::State& state, bool touching,
               std::span<const flow::Direction> directions, flow::State& rate, flow::State* rate_d) const override {
        remember(p);
        if (directions.empty()) {
            evaluate<double>(p.data(), constants_, theta, state.data(), touching, rate.data());
        } else if (directions.size() <= 4) {
            differentiate<4>(p, theta, state, touching, directions, rate, rate_d);
        } else {
            differentiate<flow::max_lanes>(p, theta, state, touching, directions, rate, rate_d);
        }
    }

private:
    /// Functions of the parameters alone.
    template <class T>
    struct Constants {
        T log_prestretch, k1, k2, k3;
    };

    void remember(const flow::ParameterVector& p) const {
        if (p == remembered_) { return; }
        const double log_prestretch = std::log(p[model::membrane::lambda_p]);
        const double alpha = p[model::membrane::alpha_a];
        constants_ = {log_prestretch, std::exp((alpha - 2.0) * log_prestretch),
                      std::exp((-2.0 * alpha - 2.0) * log_prestretch),
                      p[model::membrane::mu_ratio] * std::exp(-2.0 * log_prestretch)};
        remembered_ = p;
    }

    template <int N>
    void differentiate(const flow::ParameterVector& p, double theta, const flow::State& state, bool touching,
                       std::span<const flow::Direction> directions, flow::State& rate, flow::State* rate_d) const {
        using T = numerics::Dual<N>;
        std::array<T, model::membrane::count> parameters;
        std::array<T, model::membrane::states> y;
        T phase(theta);
        for (std::size_t k = 0; k < parameters.size(); ++k) { parameters[k] = T(p[k]); }
        for (std::size_t k = 0; k < y.size(); ++k) { y[k] = T(state[k]); }
        for (std::size_t i = 0; i < directions.size(); ++i) {
            for (std::size_t k = 0; k < parameters.size(); ++k) { parameters[k].d.set(i, directions[i].parameter[k]); }
            for (std::size_t k = 0; k < y.size(); ++k) { y[k].d.set(i, directions[i].state[k]); }
            phase.d.set(i, directions[i].phase);
        }
        const T& prestretch = parameters[model::membrane::lambda_p];
        const T& alpha = parameters[model::membrane::alpha_a];
        const T log_prestretch(constants_.log_prestretch, prestretch.d * (1.0 / prestretch.v));
        const auto power = [&](double value, const T& exponent) {  // lambda_p^exponent with its value known
            return T(value, (exponent.d * log_prestretch.v + log_prestretch.d * exponent.v) * value);
        };
        const double inverse_square = std::exp(-2.0 * log_prestretch.v);
        const Constants<T> constants = {log_prestretch, power(constants_.k1, alpha - 2.0),
                                        power(constants_.k2, -2.0 * alpha - 2.0),
                                        parameters[model::membrane::mu_ratio] * power(inverse_square, T(-2.0))};
        std::array<T, model::membrane::states> out;
        evaluate<T>(parameters.data(), constants, phase, y.data(), touching, out.data());
        for (std::size_t k = 0; k < out.size(); ++k) {
            rate[k] = out[k].v;
            for (std::size_t i = 0; i < directions.size(); ++i) { rate_d[i][k] = out[k].d[i]; }
        }
    }

    template <class T>
    static void evaluate(const T* p, const Constants<T>& c, const T& theta, const T* y, bool touching, T* out) {
        using std::cos;
        using std::exp;
        using std::log;
        using std::sqrt;
        const T inverse_omega = 1.0 / p[model::membrane::omega];
        const T relaxation = inverse_omega / p[model::membrane::delta_b];
        const T half_swing = 0.5 * p[model::membrane::voltage];
        const T swing = half_swing * cos(theta);
        T force(0.0);
        for (int side = 0; side < 2; ++side) {
            const T u = side == 0 ? y[0] : y[0] - p[model::membrane::length];
            const T& xi = y[2 + side];
            const T phi = side == 0 ? half_swing - swing : half_swing + swing;
            const T s = 1.0 + u * u;
            const T inverse_s = 1.0 / s;
            const T log_s = log(s);
            const T power = exp(0.5 * p[model::membrane::alpha_a] * log_s);
            const T ratio = exp(p[model::membrane::alpha_b] * (c.log_prestretch + 0.5 * log_s - log(xi)));
            const T inverse_ratio = 1.0 / ratio;
            const T stress = c.k1 * power - c.k2 / power + c.k3 * (ratio - inverse_ratio);
            const T damping = p[model::membrane::delta_a] * u * inverse_s * sqrt(inverse_s) * y[1];
            force += u * (stress * inverse_s + damping - phi * phi);
            out[2 + side] = relaxation * xi * (ratio - 0.5 * inverse_ratio - 0.5);
        }
        T acceleration = -p[model::membrane::layers] * force;
        if (touching) {
            const T penetration = y[0] - (0.5 * p[model::membrane::length] + p[model::membrane::gap]);
            acceleration -= p[model::membrane::stiffness] * penetration + p[model::membrane::damping] * y[1];
        }
        out[0] = y[1] * inverse_omega;
        out[1] = acceleration * inverse_omega;
    }

    std::shared_ptr<const flow::RightHandSide> plain_;
    mutable flow::ParameterVector remembered_{};
    mutable Constants<double> constants_{};
};

}  // namespace percuss::bench
