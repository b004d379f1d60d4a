#pragma once
/// \file
/// The spring-mass actuator m x'' + c x' + k1 x + k3 x^3 + f_stop = F cos(theta), stop at x = gap: its parameters, keys
/// and scene, and its row in the registry. State (x, x').

#include "model/actuator.hpp"
#include "model/scene.hpp"

#include <array>
#include <cstdint>
#include <string_view>

namespace percuss::model::spring {

/// Nondimensional parameters by index, all per unit mass.
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

inline constexpr ParameterRoles roles = {omega, gap, stop_stiffness, stop_damping, force};
inline constexpr Scene scene = {"spring", states, {0, 1, 0, 0}, names, roles, {}, {}};

/// Keys of the problem file.
namespace key {
inline constexpr Key mass = own_key(3, 0);
inline constexpr Key damping = own_key(3, 1);
inline constexpr Key stiffness = own_key(3, 2);
inline constexpr Key cubic = own_key(3, 3);
inline constexpr Key force = own_key(3, 4);
inline constexpr Key omega = own_key(3, 5);
}  // namespace key

extern const Actuator actuator;  ///< [spring-mass]

}  // namespace percuss::model::spring
