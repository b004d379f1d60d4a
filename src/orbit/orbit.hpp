#pragma once
/// \file
/// Periodic orbits by stroboscopic shooting: damped Newton on P(y) - y = 0 with the exact monodromy matrix.

#include "flow/flow.hpp"
#include "numerics/linear.hpp"
#include "numerics/newton.hpp"
#include "orbit/return_map.hpp"

#include <optional>
#include <vector>

namespace percuss::orbit {

enum class OrbitStatus : std::uint8_t {
    not_run,
    converged,
    no_convergence,
    flow_failed,  ///< the flow itself failed (chatter, divergence)
};

using NewtonOptions = numerics::NewtonOptions;

struct Orbit {
    OrbitStatus status = OrbitStatus::not_run;
    ReturnMap map;
    flow::State state{};              ///< at map.phase
    numerics::SmallMatrix monodromy;  ///< of the return map
    double residual = 0.0;            ///< |P(y) - y| at the last iterate
    double last_step = 0.0;
    int iterations = 0;
    std::vector<flow::Contact> contacts;
    [[nodiscard]] bool ok() const { return status == OrbitStatus::converged; }
};

/// Newton from `guess` at map.phase.
Orbit find_orbit(const flow::System& system, const ReturnMap& map, const flow::State& guess,
                 const NewtonOptions& options = {});

/// Floquet multipliers of one whole period, largest modulus first (squares of the half-cycle map's when mirrored).
numerics::SmallComplexVector multipliers(const Orbit& orbit);
double max_multiplier(const Orbit& orbit);

/// State after following the motion for a number of drive cycles from phase 0, or nothing if the flow failed.
std::optional<flow::State> settle(const flow::System& system, const flow::State& from, int cycles,
                                  flow::StopMode stop = flow::StopMode::hybrid);

/// A strobe phase in the middle of the longest flight, for orbits that are in contact at phase 0 or nearly so; and the
/// orbit moved there.
Orbit away_from_contact(const flow::System& system, const Orbit& orbit);

/// A converged orbit looked at closely: observables, derivatives of the state and of the observables with respect to
/// parameter directions (orbit following the parameters: implicit differentiation), monodromy, error estimates.
struct Portrait {
    flow::Status status = flow::Status::not_run;
    Image image;  ///< of the orbit's state
    numerics::SmallMatrix monodromy;
    double residual = 0.0;
    Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::ColMajor, flow::max_states, max_directions> d_state;
    /// Total derivative of an observable along direction i.
    [[nodiscard]] double total(ObservableIndex q, int i) const;
    [[nodiscard]] bool ok() const { return status == flow::Status::ok; }
};
Portrait portray(const flow::System& system, const Orbit& orbit, std::span<const flow::ParameterVector> directions,
                 std::uint32_t observe);

/// Errors by comparison with a tighter integrator of the same system: the orbit's state is corrected by one Newton
/// step with the tighter residual, observables are compared after that correction.
struct ErrorEstimate {
    double state = 0.0;
    std::array<double, observable_count> observed{};
};
ErrorEstimate estimate_errors(const flow::System& tighter, const Orbit& orbit, const Portrait& portrait,
                              std::uint32_t observe);

}  // namespace percuss::orbit
