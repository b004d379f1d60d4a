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
    flow::State state{};              ///< of the orbit, at map.phase
    numerics::SmallMatrix monodromy;  ///< of the map
    double theta_contact = 0.0;       ///< grazing: phase of the largest displacement
    double residual = 0.0;
    std::vector<double> d_omega;       ///< derivative of omega along each direction
    std::vector<flow::State> d_state;  ///< derivative of the orbit's state, following the boundary
    int iterations = 0;
    [[nodiscard]] bool ok() const { return status == SolveStatus::converged; }
};

/// Newton on {P(y) - y = 0, test = 0} for (y, omega). Tests: grazing, max x - x_stop by the envelope theorem; fold and
/// flip, the bordered determinant-like function of the minimally augmented system (W. Govaerts, Numerical Methods for
/// Bifurcations of Dynamical Equilibria, SIAM 2000), whose gradient takes the second derivative of P along the null
/// vector as a central difference of exact derivatives; torus, |mu|^2 - 1 of the complex multiplier nearest the circle,
/// differentiated by left and right eigenvectors in the same way.
/// The stop mode of `map` decides whether the orbit is free or impacting; grazing needs a free one.
Boundary solve_boundary(const flow::System& system, const orbit::ReturnMap& map, Kind kind, const flow::State& guess,
                        double omega, std::span<const flow::ParameterVector> directions);

/// Distance of the free orbit's largest displacement from the stop (negative: no contact), from an image of the
/// half-cycle or full map taken with observe_extrema. `columns` of derivative as in orbit::Observed.
orbit::Observed clearance(const flow::System& system, const orbit::ReturnMap& map, const orbit::Image& image,
                          std::span<const flow::ParameterVector> directions);

}  // namespace percuss::boundary
