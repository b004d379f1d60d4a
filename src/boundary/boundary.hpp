#pragma once
/// \file
/// Points where a motion begins to touch the stop (grazing) or loses its stability or existence (fold, flip, torus), as
/// zeros of extended systems, with exact derivatives with respect to any parameter direction.

#include "flow/flow.hpp"
#include "numerics/linear.hpp"
#include "orbit/return_map.hpp"

#include <span>
#include <string_view>
#include <vector>

namespace percuss::boundary {

enum class Kind : std::uint8_t {
    none,
    grazing,  ///< max x = stop
    fold,     ///< multiplier +1
    flip,     ///< multiplier -1; of the half-cycle map of the free system: loss of the mirror symmetry
    torus,    ///< a complex pair of multipliers of modulus 1 (Neimark-Sacker)
};

std::string_view to_string(Kind kind);

enum class SolveStatus : std::uint8_t { not_run, converged, no_convergence, flow_failed };

struct Boundary {
    SolveStatus status = SolveStatus::not_run;
    Kind kind = Kind::none;
    double omega = 0.0;
    flow::State state{};         ///< of the orbit, at map.phase
    double theta_contact = 0.0;  ///< grazing: phase of the largest displacement
    double residual = 0.0;
    std::vector<double> d_omega;       ///< derivative of omega along each direction
    std::vector<flow::State> d_state;  ///< derivative of the orbit's state, following the boundary
    int iterations = 0;
    [[nodiscard]] bool ok() const { return status == SolveStatus::converged; }
};

/// A boundary of the orbits of a return map in (y, omega): the equations of boundary/critical.hpp for a motion of free
/// form, or strobed where the map's stop is hybrid; grazing needs a free one.
Boundary solve_boundary(const flow::System& system, const orbit::ReturnMap& map, Kind kind, const flow::State& guess,
                        double omega, std::span<const flow::ParameterVector> directions);

/// Distance of the free orbit's largest displacement from the stop (negative: no contact), from an image of the
/// half-cycle or full map taken with observe_extrema. `columns` of derivative as in orbit::Observed.
orbit::Observed clearance(const flow::System& system, const orbit::ReturnMap& map, const orbit::Image& image,
                          std::span<const flow::ParameterVector> directions);
/// The phase of that displacement; where half a cycle reaches further to the other side, half a cycle later.
double phase_of_clearance(const flow::System& system, const orbit::ReturnMap& map, const orbit::Image& image);

}  // namespace percuss::boundary
