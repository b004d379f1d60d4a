#pragma once
/// \file
/// What is asked of one design and what comes back.

#include "design/problem.hpp"
#include "numerics/cancel.hpp"

#include <array>
#include <complex>
#include <limits>
#include <string>
#include <vector>

namespace percuss::design {

enum class EvaluationStatus : std::uint8_t { not_run, ok, no_impact, not_unique, unstable, failed };
std::string_view to_string(EvaluationStatus status);

enum class EdgeKind : std::uint8_t { none, grazing, fold, flip, torus, given };
std::string_view to_string(EdgeKind kind);

enum class Verdict : std::uint8_t { not_checked, unique, not_unique };
std::string_view to_string(Verdict verdict);

inline constexpr double absent = std::numeric_limits<double>::quiet_NaN();

/// Where the actuator is driven. SI, except omega = Omega Gamma (nondimensional).
struct OperatingPoint {
    double drive_frequency = absent;  ///< [Hz], or cycles per unit of nondimensional time
    double omega = absent;
    EdgeKind edge_kind = EdgeKind::none;
    double edge_omega = absent;  ///< nondimensional; the grazing frequency when the edge is one
    double fold_offset =
        absent;  ///< relative distance from edge_omega down to the fold beside it; absent if none found
    double margin = absent;
};

/// The periodic orbit at the operating point, in the units of the problem.
struct OrbitReport {
    std::vector<double> state;  ///< at theta = 0: x [m], x' [m/s], xi_I, xi_II
    int period = 0;             ///< drive cycles
    int contacts = 0;           ///< per period
    double x_max = absent;      ///< extrema of the displacement [m]
    double x_min = absent;
    std::vector<std::complex<double>> multipliers;  ///< of one whole period, largest modulus first
    double residual = absent;                       ///< norm of P(y) - y, nondimensional
    double state_error = absent;                    ///< estimated error of the state, nondimensional
};

/// A motion other than the tuned one, found by the uniqueness check.
struct Attractor {
    int period = 0;                      ///< drive cycles, 0 for aperiodic motions
    std::string_view kind = "periodic";  ///< periodic | chaotic | quasi-periodic | undecided
    std::vector<double> state;
    double peak_force = absent;
    double amplitude = absent;
    double share = absent;
    double max_multiplier = absent;
};

struct Uniqueness {
    int tier = 0;  ///< the tier that was reached
    Verdict verdict = Verdict::not_checked;
    std::string checked;  ///< one sentence: what was done, what was found
    long starts = 0;
    double missed_share_bound = absent;
    std::vector<Attractor> attractors;
};

/// Integration steps that one evaluation may take, so that a stiff or absurd design ends in seconds to a minute. With
/// the Taylor integrator, gradients and error estimates, tier 1 takes 434 to 2748 steps on the shipped problems and at
/// most 76070 on 300 random designs of bench/stress_designs.cpp; the sampled tier with 64 starts up to 30709, ensembles
/// apart; ARKODE some 20 times as many.
inline constexpr long default_step_budget = 20'000'000;

/// What is wanted of an evaluation; nothing else is computed. An evaluation that is cancelled, or needs more steps than
/// its budget, ends as failed with that reason.
struct Demand {
    std::vector<Quantity> quantities;
    std::vector<model::Key> gradients;  ///< d(quantity)/d(key) for these keys
    bool error_estimates = false;
    numerics::CancelRequest cancelled{};  ///< asked while it is worked on
    long step_budget = default_step_budget;
};

/// gradients.of(q)[i] is the total derivative of quantity q with respect to the i-th key of the demand, SI.
struct Gradients {
    std::array<std::vector<double>, quantity_count> quantity;
    std::vector<double> omega;
    std::vector<double> drive_frequency;
    std::vector<double> edge_omega;
};

struct Evaluation {
    EvaluationStatus status = EvaluationStatus::not_run;
    std::string reason;  ///< one sentence when the status is not ok
    OperatingPoint operating_point;
    std::array<double, quantity_count> quantities{};       ///< absent where not asked for or not available
    std::array<double, quantity_count> error_estimates{};  ///< absent likewise
    std::vector<model::Key> gradient_keys;
    Gradients gradients;
    std::array<std::string, 2> band_reasons;  ///< what ends the band below and above, where it was asked for
    OrbitReport orbit;
    Uniqueness uniqueness;
    double periods = 0.0;  ///< drive cycles integrated
    long steps = 0;        ///< integration steps taken, those of ensembles of starts apart
    Evaluation();
    [[nodiscard]] double value(Quantity q) const { return quantities[static_cast<std::size_t>(q)]; }
};

}  // namespace percuss::design
