#pragma once
/// \file
/// Actuators, states and runs that the benchmarks share.
///
/// Known states: reference/dea.json of the project, computed by a Gragg-Bulirsch-Stoer integrator in long double and a
/// DOP853 integrator with variational equations for the nondimensional defaults of C. Wu, A. Cai, X. Gao, C. Cao,
/// "Nonlinear Dynamics of a Resonant-Impact Dielectric Elastomer Actuator", Appl. Syst. Innov. 2022, 5, 122, section
/// 3.1. The orbit at omega = 1.9 is good to 1e-14, the one at 3.0 to 1e-12.

#include "flow/flow.hpp"
#include "kernels/kernels.hpp"
#include "model/membrane/membrane.hpp"
#include "model/spring/spring.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <memory>
#include <numbers>
#include <string>
#include <string_view>
#include <vector>

namespace percuss::bench {

inline constexpr double two_pi = 2.0 * std::numbers::pi;

inline constexpr std::size_t at(int i) { return static_cast<std::size_t>(i); }

/// lambda_p mu_ratio alpha_A alpha_B delta_A delta_B l g k delta_i phi_pp layers omega
inline constexpr flow::ParameterVector paper_defaults = {1.1, 1.0,    3.0, 2.0, 0.3, 60.0, 0.8,
                                                         0.1, 2500.0, 2.0, 0.4, 1.0, 1.9};
/// Period-1 impacting orbit at omega = 1.9, at theta = 0.
inline constexpr flow::State paper_orbit = {0.28441053480900, -0.04807487486239, 1.17803265118641, 1.19639597555165};
/// Period-1 orbit at omega = 3, which stays clear of the stop.
inline constexpr double clear_omega = 3.0;
inline constexpr flow::State clear_orbit = {0.41090395464036, -0.00136890359622, 1.18476545344551, 1.18475676192469};

/// x'' + 0.02 x' + x + 29 max(x - 1, 0) = 0.152380952381 cos(1.05 tau): demonstration "bld_osc" of PWSDDE-cont without
/// control. c k1 k3 F gap k delta_i omega
inline constexpr flow::ParameterVector soft_impact = {0.02, 1.0, 0.0, 0.152380952381, 1.0, 29.0, 0.0, 1.05};

inline flow::ParameterVector with(flow::ParameterVector p, int index, double value) {
    p[at(index)] = value;
    return p;
}

struct SceneKind {
    const model::Scene* scene = &model::membrane::viscous;
    model::ContactLaw law = model::ContactLaw::kelvin_voigt;
};

inline std::unique_ptr<flow::Integrator> make(const SceneKind& kind, std::string_view integrator, double tolerance,
                                              std::string_view instruction_set = "auto") {
    kernels::IntegratorOptions options;
    options.integrator = integrator;
    options.tolerance = tolerance;
    options.instruction_set = instruction_set;
    return kernels::make_integrator(*kind.scene, kind.law, options);
}

/// `cycles` drive cycles from theta = 0.
inline flow::Request cycles_from(const flow::State& state, int cycles = 1) {
    flow::Request request;
    request.state = state;
    request.duration = two_pi * cycles;
    request.max_events = 256 * cycles;
    return request;
}

/// The first `count` state directions, then parameter directions.
inline std::vector<flow::Direction> directions(int states, int count) {
    std::vector<flow::Direction> list(at(count));
    for (int i = 0; i < count; ++i) {
        if (i < states) {
            list[at(i)].state[at(i)] = 1.0;
        } else {
            list[at(i)].parameter[at(i - states)] = 1.0;
        }
    }
    return list;
}

/// Largest difference of two states.
inline double distance(const flow::State& a, const flow::State& b) {
    double largest = 0.0;
    for (std::size_t k = 0; k < a.size(); ++k) {
        const double d = std::abs(a[k] - b[k]);
        if (!(d <= largest)) { largest = d; }  // NaN stays
    }
    return largest;
}

/// first, first/step, ... down to last.
inline std::vector<double> tolerances(double first, double last, int per_decade) {
    std::vector<double> list;
    const int count = static_cast<int>(std::lround(per_decade * std::log10(first / last)));
    for (int i = 0; i <= count; ++i) { list.push_back(first * std::pow(10.0, -static_cast<double>(i) / per_decade)); }
    return list;
}

}  // namespace percuss::bench
