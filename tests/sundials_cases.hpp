#pragma once
/// \file
/// Systems, parameters and comparisons shared by the tests of the step-by-step backends.
///
/// Reference numbers: an independent DOP853 and Gragg-Bulirsch-Stoer integration of the same equations (the paper's
/// section 3.1 defaults; the orbit at omega = 1.9 is good to 1e-14).

#include "flow/flow.hpp"
#include "flow/sundials.hpp"
#include "kernels/plain_systems.hpp"
#include "model/membrane/membrane.hpp"
#include "model/spring/spring.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <memory>
#include <numbers>
#include <string_view>
#include <vector>

namespace percuss::test {

inline constexpr double two_pi = 2.0 * std::numbers::pi;

inline std::size_t at(int i) { return static_cast<std::size_t>(i); }

/// Defaults of the paper's section 3.1 at omega = 1.9.
inline constexpr flow::ParameterVector paper_defaults = {1.1, 1.0,    3.0, 2.0, 0.3, 60.0, 0.8,
                                                         0.1, 2500.0, 2.0, 0.4, 1.0, 1.9};
/// Period-1 impacting orbit there, at theta = 0.
inline constexpr flow::State paper_orbit = {0.28441053480900, -0.04807487486239, 1.17803265118641, 1.19639597555165};

inline std::shared_ptr<const flow::RightHandSide> membranes(model::ContactLaw law = model::ContactLaw::kelvin_voigt) {
    return kernels::make_plain_system(model::membrane::viscous, law);
}
inline std::shared_ptr<const flow::RightHandSide> spring(model::ContactLaw law = model::ContactLaw::kelvin_voigt) {
    return kernels::make_plain_system(model::spring::scene, law);
}

/// An observable by name; call it with the observables of a run.
struct NamedObservable {
    std::string_view name;
    const flow::Sensitive& (*member)(const flow::Observables&);
};
template <flow::Sensitive flow::Observables::*Member>
const flow::Sensitive& one_of(const flow::Observables& all) {
    return all.*Member;
}
template <std::size_t K>
const flow::Sensitive& peak_of(const flow::Observables& all) {
    return all.peak[K];
}
inline constexpr std::array<NamedObservable, 12> observables = {{
    {"x_max", one_of<&flow::Observables::x_max>},
    {"x_min", one_of<&flow::Observables::x_min>},
    {"peak_force", one_of<&flow::Observables::peak_force>},
    {"impact_velocity", one_of<&flow::Observables::impact_velocity>},
    {"contact_time", one_of<&flow::Observables::contact_time>},
    {"impulse", one_of<&flow::Observables::impulse>},
    {"stop_work", one_of<&flow::Observables::stop_work>},
    {"peak_acceleration", one_of<&flow::Observables::peak_acceleration>},
    {"peak_field", peak_of<model::membrane::field>},
    {"peak_current", peak_of<model::membrane::current>},
    {"drive_work", one_of<&flow::Observables::drive_work>},
    {"dissipation", one_of<&flow::Observables::dissipation>},
}};

/// Every way in which a run can be moved: each state, each parameter, the phase.
inline std::vector<flow::Direction> all_directions(const flow::SystemInfo& info) {
    std::vector<flow::Direction> directions;
    for (int i = 0; i < info.states; ++i) { directions.emplace_back().state[at(i)] = 1.0; }
    for (int i = 0; i < info.parameters; ++i) { directions.emplace_back().parameter[at(i)] = 1.0; }
    directions.emplace_back().phase = 1.0;
    return directions;
}

struct Case {
    flow::ParameterVector parameters{};
    flow::Request request;
};

/// The case moved by an amount along a direction, without derivatives.
inline Case moved(Case c, const flow::Direction& direction, double amount) {
    for (std::size_t i = 0; i < direction.state.size(); ++i) { c.request.state[i] += amount * direction.state[i]; }
    for (std::size_t i = 0; i < direction.parameter.size(); ++i) { c.parameters[i] += amount * direction.parameter[i]; }
    c.request.theta += amount * direction.phase;
    c.request.directions = {};
    return c;
}

/// Size of what a direction moves, for difference steps.
inline double size_along(const Case& c, const flow::Direction& direction) {
    double size = direction.phase != 0.0 ? 1.0 : 0.0;
    for (std::size_t i = 0; i < direction.state.size(); ++i) {
        size = std::max(size, direction.state[i] != 0.0 ? std::max(0.1, std::abs(c.request.state[i])) : 0.0);
    }
    for (std::size_t i = 0; i < direction.parameter.size(); ++i) {
        size = std::max(size, direction.parameter[i] != 0.0 ? std::max(0.01, std::abs(c.parameters[i])) : 0.0);
    }
    return size;
}

inline flow::Result run(const flow::Integrator& integrator, const Case& c) {
    flow::Result result;
    integrator.run(c.parameters, c.request, result);
    return result;
}

}  // namespace percuss::test
