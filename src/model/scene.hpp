#pragma once
/// \file
/// What a set of equations is to the integrators: how many states and parameters, which parameters are known by role,
/// which signals can be observed. One actuator may have several (with or without its viscous branches, say). Symbols
/// as in Wu, Cai, Gao, Cao, "Nonlinear Dynamics of a Resonant-Impact Dielectric Elastomer Actuator",
/// Appl. Syst. Innov. 2022, 5, 122 (called "the paper" in this folder).

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string_view>

namespace percuss::model {

inline constexpr int max_states = 4;
inline constexpr int max_parameters = 13;
inline constexpr int max_peaks = 2;  ///< signals of an actuator whose largest value is observed
inline constexpr int max_means = 2;  ///< signals of an actuator whose integral over time is observed

/// Unused entries are zero.
using StateVector = std::array<double, max_states>;
using Parameters = std::array<double, max_parameters>;

/// Lower and upper ends of an interval for every state.
struct StateRange {
    StateVector lower{};
    StateVector upper{};
};

/// A signal of the actuator whose largest value over a run is an observable.
struct PeakSignal {
    std::string_view name;
    int parts = 1;           ///< equal parts of the actuator that have it each; the largest of all counts
    bool of_modulus = true;  ///< the largest modulus; false: the largest value (the signal has one sign)
    bool smooth = false;     ///< its slope does not jump where contact begins or ends (it depends on x and theta alone)
};

/// Indices in the parameter vector of what every actuator has.
struct ParameterRoles {
    int omega = 0;           ///< drive frequency
    int gap = 0;             ///< from the centre to the stop
    int stop_stiffness = 0;  ///< k
    int stop_damping = 0;    ///< delta_i
    int drive = 0;           ///< amplitude of the drive
};

struct Scene {
    std::string_view name;
    int states = 0;
    /// Without the stop the system (where symmetric at all) is unchanged under state -> reflect(state),
    /// theta -> theta + pi, where reflect mirrors x about the centre, negates x' and permutes the other states so.
    std::array<int, max_states> mirror{};
    std::span<const std::string_view> parameters;  ///< names, as the parameter vector is numbered
    ParameterRoles roles;
    std::span<const PeakSignal> peaks;        ///< at most max_peaks
    std::span<const std::string_view> means;  ///< names of the signals with a mean, at most max_means
};

}  // namespace percuss::model
