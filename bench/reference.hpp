#pragma once
/// \file
/// Reference solutions: the Taylor method in 80-bit long double at order 30, which is good to about 1e-18 a step.

#include "flow/flow.hpp"
#include "flow/taylor.hpp"
#include "model/membrane/jet.hpp"
#include "model/spring/jet.hpp"
#include "scenes.hpp"

#include <array>
#include <cstddef>
#include <stdexcept>

namespace percuss::bench {

inline constexpr int reference_order = 30;

template <class Jet>
flow::State reference_end(model::ContactLaw law, const flow::ParameterVector& parameters,
                          const flow::Request& request) {
    using T = typename Jet::Scalar;
    std::array<T, flow::max_parameters> p;
    typename Jet::State y;
    for (std::size_t k = 0; k < p.size(); ++k) { p[k] = T(parameters[k]); }
    for (std::size_t k = 0; k < y.size(); ++k) { y[k] = T(request.state[k]); }
    flow::TaylorRun<Jet> run(p.data(), law, reference_order);
    if (run.run(y, T(request.theta), T(request.duration), request) != flow::Status::ok) {
        throw std::runtime_error("the reference solution failed");
    }
    flow::State end{};
    y = run.state();
    for (std::size_t k = 0; k < y.size(); ++k) { end[k] = static_cast<double>(y[k]); }
    return end;
}

/// State at the end of the request, exact for the purposes of double precision.
inline flow::State reference_end(const SceneKind& kind, const flow::ParameterVector& parameters,
                                 const flow::Request& request) {
    using Extended = long double;
    const auto law = static_cast<model::ContactLaw>(kind.law);
    if (kind.scene == &model::spring::scene) {
        return reference_end<model::SpringJet<Extended, reference_order>>(law, parameters, request);
    }
    return reference_end<model::MembraneJet<Extended, true, reference_order>>(law, parameters, request);
}

}  // namespace percuss::bench
