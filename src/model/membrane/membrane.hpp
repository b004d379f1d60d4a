#pragma once
/// \file
/// The double-cone dielectric elastomer actuator: its parameters, keys, signals and scenes, and its rows in the
/// registry (in SI units, and nondimensional). State (x, x', xi_I, xi_II).

#include "model/actuator.hpp"
#include "model/scene.hpp"

#include <array>
#include <cstdint>
#include <string_view>

namespace percuss::model::membrane {

/// Nondimensional parameters by index (paper, section 2.2).
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

/// Peak signals: phi lambda_1, the true electric field in units of sqrt(mu_A/eps), and d(s phi)/dtau, the current.
enum Peak : std::uint8_t { field, current };
inline constexpr std::array<PeakSignal, 2> peaks = {{{"field", 2, false, true}, {"current", 2, true, false}}};

inline constexpr ParameterRoles roles = {omega, gap, stiffness, damping, voltage};
inline constexpr Scene viscous = {"membranes", states, {0, 1, 3, 2}, names, roles, peaks, {}};
/// mu_B = 0: the Maxwell branches act on nothing and are left out.
inline constexpr Scene elastic = {"elastic membranes", 2, {0, 1, 0, 0}, names, roles, peaks, {}};

/// Scale factors of its own: field sqrt(mu_A/eps) [V/m], current n sqrt(eps mu_A) pi (b^2 - a^2) lambda_p / Gamma [A],
/// voltage Phi_pp [V].
enum OwnScale : std::uint8_t { field_scale, current_scale, voltage_scale };

/// Keys of the problem file.
namespace key {
inline constexpr Key inner_radius = own_key(1, 0);
inline constexpr Key outer_radius = own_key(1, 1);
inline constexpr Key membrane_thickness = own_key(1, 2);
inline constexpr Key prestretch = own_key(1, 3);
inline constexpr Key rod_length = own_key(1, 4);
inline constexpr Key moving_mass = own_key(1, 5);
inline constexpr Key layers = own_key(1, 6);
inline constexpr Key shear_modulus = own_key(1, 7);
inline constexpr Key ogden_exponent = own_key(1, 8);
inline constexpr Key maxwell_modulus = own_key(1, 9);
inline constexpr Key maxwell_exponent = own_key(1, 10);
inline constexpr Key kelvin_viscosity = own_key(1, 11);
inline constexpr Key maxwell_viscosity = own_key(1, 12);
inline constexpr Key relative_permittivity = own_key(1, 13);
inline constexpr Key drive_voltage = own_key(1, 14);
inline constexpr Key nd_lambda_p = own_key(2, 0);
inline constexpr Key nd_mu_ratio = own_key(2, 1);
inline constexpr Key nd_alpha_a = own_key(2, 2);
inline constexpr Key nd_alpha_b = own_key(2, 3);
inline constexpr Key nd_delta_a = own_key(2, 4);
inline constexpr Key nd_delta_b = own_key(2, 5);
inline constexpr Key nd_length = own_key(2, 6);
inline constexpr Key nd_gap = own_key(2, 7);
inline constexpr Key nd_stiffness = own_key(2, 8);
inline constexpr Key nd_damping = own_key(2, 9);
inline constexpr Key nd_voltage = own_key(2, 10);
inline constexpr Key nd_layers = own_key(2, 11);
inline constexpr Key nd_omega = own_key(2, 12);
}  // namespace key

extern const Actuator si;              ///< [actuator] and [material]
extern const Actuator nondimensional;  ///< [nondimensional]

}  // namespace percuss::model::membrane
