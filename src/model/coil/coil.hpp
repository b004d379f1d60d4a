#pragma once
/// \file
/// The voice-coil actuator m x'' + c x' + k1 x + k3 x^3 + f_stop = Bl i + F0, Le i' + R i + Bl x' = V cos(theta), stop
/// at x = gap: its parameters, keys, signals and scene, and its row in the registry. State (x, x', i).

#include "model/actuator.hpp"
#include "model/scene.hpp"

#include <array>
#include <cstdint>
#include <string_view>

namespace percuss::model::coil {

/// Nondimensional parameters by index: forces per unit mass, the current in units of force/Bl.
enum Index : std::uint8_t {
    damping,     // c
    stiffness,   // k1
    cubic,       // k3
    resistance,  // rho = R T/Le
    coupling,    // beta = Bl^2 T^2/(Le m)
    voltage,     // V T/(Le I)
    gap,
    stop_stiffness,
    stop_damping,
    omega,
    bias,  // F0
    count
};
inline constexpr int states = 3;
inline constexpr std::array<std::string_view, count> names = {
    "damping", "stiffness", "cubic", "rho", "beta", "voltage", "gap", "k", "delta_i", "omega", "bias"};

/// Peak signal: the current. Its slope depends on x', i and theta alone, which no contact makes jump.
enum Peak : std::uint8_t { current };
inline constexpr std::array<PeakSignal, 1> peaks = {{{"current", 1, true, true}}};
/// Mean signals, in units of force times velocity: (rho/beta) i^2, the heat R i^2, and (v/beta) cos(theta) i, the power
/// drawn.
enum Mean : std::uint8_t { heat, power };
inline constexpr std::array<std::string_view, 2> means = {"heat", "power"};

inline constexpr ParameterRoles roles = {omega, gap, stop_stiffness, stop_damping, voltage};
/// The free system seen in a mirror carries the opposite current.
inline constexpr Scene scene = {"voice coil", states, {0, 1, 2, 0}, names,
                                roles,        peaks,  means,        {-1.0, -1.0, -1.0, 1.0}};

/// Scale factor of its own: the current force/Bl [A].
enum OwnScale : std::uint8_t { current_scale };

/// Keys of the problem file.
namespace key {
inline constexpr Key mass = own_key(4, 0);
inline constexpr Key damping = own_key(4, 1);
inline constexpr Key stiffness = own_key(4, 2);
inline constexpr Key cubic = own_key(4, 3);
inline constexpr Key force_constant = own_key(4, 4);
inline constexpr Key resistance = own_key(4, 5);
inline constexpr Key inductance = own_key(4, 6);
inline constexpr Key voltage = own_key(4, 7);
inline constexpr Key bias = own_key(4, 8);
}  // namespace key

extern const Actuator actuator;  ///< [voice-coil]

}  // namespace percuss::model::coil
