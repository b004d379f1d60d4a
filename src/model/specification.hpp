#pragma once
/// \file
/// An actuator as a user describes it: one number per problem-file key, SI (or nondimensional for [nondimensional]
/// problems), and the way from there to the parameters that are integrated.

#include "model/parameters.hpp"

#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace percuss::model {

/// Which sections describe the actuator.
enum class Family : std::uint8_t {
    dielectric_elastomer_si,
    dielectric_elastomer_nondimensional,
    spring_mass,
};

/// Every numeric key of a problem file that describes the physical system or the drive.
enum class Key : std::uint8_t {
    inner_radius,
    outer_radius,
    membrane_thickness,
    prestretch,
    rod_length,
    moving_mass,
    layers,
    shear_modulus,
    ogden_exponent,
    maxwell_modulus,
    maxwell_exponent,
    kelvin_viscosity,
    maxwell_viscosity,
    relative_permittivity,
    stop_gap,
    stop_stiffness,
    stop_damping,
    drive_voltage,
    drive_frequency,
    nd_lambda_p,
    nd_mu_ratio,
    nd_alpha_a,
    nd_alpha_b,
    nd_delta_a,
    nd_delta_b,
    nd_length,
    nd_gap,
    nd_stiffness,
    nd_damping,
    nd_voltage,
    nd_layers,
    nd_omega,
    sm_mass,
    sm_damping,
    sm_stiffness,
    sm_cubic,
    sm_force,
    sm_omega,
    count
};
inline constexpr std::size_t key_count = static_cast<std::size_t>(Key::count);

/// What is known of a key: its name in files ("stop.gap"), the unit its value is kept in ("m"; "1" when
/// dimensionless), what is allowed, and a default where one exists.
struct KeyInfo {
    Key key;
    std::string_view name;
    std::string_view unit;
    double lowest;  ///< allowed range
    double highest;
    bool lowest_allowed;             ///< whether `lowest` itself is allowed
    std::optional<double> fallback;  ///< default; empty: required (drive_frequency, nd_omega, sm_omega: empty = edge)
    std::string_view meaning;
};

const KeyInfo& key_info(Key key);
/// The key with this file name, or nothing.
std::optional<Key> find_key(std::string_view name);
/// Keys of a family, in file order.
std::span<const Key> keys_of(Family family);

/// The range of a key in words: "above 0", "at least 1, at most 64".
std::string allowed_range(const KeyInfo& info);

/// NaN marks a value that is absent.
struct Specification {
    Family family = Family::dielectric_elastomer_si;
    StopLaw law = StopLaw::kelvin_voigt;
    std::array<double, key_count> values{};  // filled with NaN by the constructor
    Specification();
    [[nodiscard]] double value(Key key) const { return values[static_cast<std::size_t>(key)]; }
    void set(Key key, double v) { values[static_cast<std::size_t>(key)] = v; }
    [[nodiscard]] bool has(Key key) const;
};

/// Whether a specification of this family, stop law and material is incomplete without the key.
bool is_required(const Specification& spec, Key key);

/// Whether a drive frequency is given; without one the actuator is operated at its edge.
bool has_frequency(const Specification& spec);

/// Gives every absent key of the family that has a default its default.
void apply_defaults(Specification& spec);

/// Everything that is wrong with a specification, one sentence each naming key, value and the allowed range: values
/// out of range, missing or NaN, an outer radius not above the inner one, and so on. Empty for a good one.
std::vector<std::string> violations(const Specification& spec);

/// Throws std::invalid_argument with the first of the violations, if any.
void validate(const Specification& spec);

/// What one nondimensional unit is in SI; all ones for [nondimensional] problems.
/// Per quantity, as conversion factor from the integrator's observable to the reported quantity.
struct Scales {
    double length = 1.0;   ///< (b - a), or the gap of a spring-mass system [m]
    double time = 1.0;     ///< Gamma [s]
    double force = 1.0;    ///< 2 pi a mu_A T0, or m length/time^2 [N]
    double field = 1.0;    ///< sqrt(mu_A / eps) [V/m], times peak_field gives electric_field
    double current = 1.0;  ///< n sqrt(eps mu_A) pi (b^2 - a^2) lambda_p / Gamma [A], times peak_current
    double voltage = 1.0;  ///< Phi_pp [V]: apparent_power = voltage * drive_current
};

/// Number of parameters is membrane::count or spring::count; unused entries are zero.
using Parameters = std::array<double, 13>;

struct Scaled {
    Parameters parameters{};  ///< omega entry: 2 pi f Gamma when a frequency is given, else 0
    Scales scales;
};

/// Nondimensional parameters and scales of a validated specification (paper, section 2.2; see each formula's comment).
Scaled scale(const Specification& spec);

/// Exact derivative of `scale` with respect to one key (forward differentiation of the same code).
Scaled scale_derivative(const Specification& spec, Key key);

/// ActuatorKind behind a family.
ActuatorKind actuator_kind(Family family);

}  // namespace percuss::model
