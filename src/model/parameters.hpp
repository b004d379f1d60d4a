#pragma once
/// \file
/// The nondimensional parameters that the two actuator types integrate with, by index. Symbols as in
/// Wu, Cai, Gao, Cao, "Nonlinear Dynamics of a Resonant-Impact Dielectric Elastomer Actuator",
/// Appl. Syst. Innov. 2022, 5, 122 (called "the paper" in this folder).

#include <array>
#include <cstddef>
#include <cstdint>
#include <string_view>

namespace percuss::model {

enum class ActuatorKind : std::uint8_t { dielectric_elastomer, spring_mass };

/// kelvin_voigt: f = k pen + delta_i x' while pen >= 0 (switches on displacement alone, paper eq. (8));
/// no_tension: f = max(0, k pen + delta_i x') while pen >= 0.
enum class StopLaw : std::uint8_t { kelvin_voigt, no_tension, none };

/// Double-cone dielectric elastomer actuator; state (x, x', xi_I, xi_II).
namespace membrane {
enum Index : std::uint8_t {
    lambda_p,
    mu_ratio,
    alpha_a,
    alpha_b,
    delta_a,
    delta_b,
    length,     // l
    gap,        // g
    stiffness,  // k
    damping,    // delta_i
    voltage,    // phi_pp
    layers,
    omega,
    count
};
inline constexpr int states = 4;
inline constexpr std::array<std::string_view, count> names = {"lambda_p", "mu_ratio", "alpha_A", "alpha_B", "delta_A",
                                                              "delta_B",  "l",        "g",       "k",       "delta_i",
                                                              "phi_pp",   "layers",   "omega"};
}  // namespace membrane

/// x'' + c x' + k1 x + k3 x^3 + f_stop = F cos(theta), all per unit mass; state (x, x'); stop at x = gap.
namespace spring {
enum Index : std::uint8_t {
    damping,    // c
    stiffness,  // k1
    cubic,      // k3
    force,      // F
    gap,
    stop_stiffness,
    stop_damping,
    omega,
    count
};
inline constexpr int states = 2;
inline constexpr std::array<std::string_view, count> names = {"damping", "stiffness", "cubic",   "force",
                                                              "gap",     "k",         "delta_i", "omega"};
}  // namespace spring

}  // namespace percuss::model
