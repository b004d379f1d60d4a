#include "model/number_text.hpp"
#include "model/specification.hpp"

#include <limits>
#include <stdexcept>

namespace percuss::model {

namespace {

constexpr double unbounded = std::numeric_limits<double>::infinity();
constexpr double most_layers = 64.0;
constexpr double largest_stretch = 10.0;
constexpr double largest_exponent = 50.0;
constexpr double largest_permittivity = 1e6;

constexpr KeyInfo positive(Key key, std::string_view name, std::string_view unit, std::string_view meaning,
                           double highest = unbounded) {
    return {key, name, unit, 0.0, highest, false, std::nullopt, meaning};
}

constexpr KeyInfo at_least(double lowest, Key key, std::string_view name, std::string_view unit,
                           std::string_view meaning, double highest = unbounded,
                           std::optional<double> fallback = std::nullopt) {
    return {key, name, unit, lowest, highest, true, fallback, meaning};
}

constexpr KeyInfo any(Key key, std::string_view name, std::string_view unit, std::string_view meaning,
                      double fallback) {
    return {key, name, unit, -unbounded, unbounded, false, fallback, meaning};
}

constexpr std::array<KeyInfo, key_count> table = {{
    positive(Key::inner_radius, "actuator.inner_radius", "m", "radius a of the central disk"),
    positive(Key::outer_radius, "actuator.outer_radius", "m", "radius b of the frame, above inner_radius"),
    positive(Key::membrane_thickness, "actuator.membrane_thickness", "m",
             "thickness T0 of one layer before pre-stretch"),
    at_least(1.0, Key::prestretch, "actuator.prestretch", "1", "equal-biaxial pre-stretch lambda_p", largest_stretch),
    positive(Key::rod_length, "actuator.rod_length", "m", "length L of the rod; each membrane stands at L/2 at rest"),
    positive(Key::moving_mass, "actuator.moving_mass", "kg", "mass m that moves"),
    at_least(1.0, Key::layers, "actuator.layers", "1", "membranes n stacked per side, in parallel", most_layers, 1.0),
    positive(Key::shear_modulus, "material.shear_modulus", "Pa", "modulus mu_A of the Ogden spring"),
    positive(Key::ogden_exponent, "material.ogden_exponent", "1", "exponent alpha_A of the Ogden spring",
             largest_exponent),
    at_least(0.0, Key::maxwell_modulus, "material.maxwell_modulus", "Pa",
             "modulus mu_B of the Maxwell spring; 0: no Maxwell branch"),
    positive(Key::maxwell_exponent, "material.maxwell_exponent", "1", "exponent alpha_B of the Maxwell spring",
             largest_exponent),
    at_least(0.0, Key::kelvin_viscosity, "material.kelvin_viscosity", "Pa s",
             "viscosity eta_A of the parallel dashpot"),
    at_least(0.0, Key::maxwell_viscosity, "material.maxwell_viscosity", "Pa s",
             "viscosity eta_B of the Maxwell dashpot, above 0 unless maxwell_modulus is 0"),
    at_least(1.0, Key::relative_permittivity, "material.relative_permittivity", "1",
             "relative permittivity eps_r of the membrane", largest_permittivity),
    at_least(0.0, Key::stop_gap, "stop.gap", "m", "distance G from rest to the stop"),
    at_least(0.0, Key::stop_stiffness, "stop.stiffness", "N/m", "stiffness K of the stop"),
    at_least(0.0, Key::stop_damping, "stop.damping", "N s/m", "damping c of the stop"),
    at_least(0.0, Key::drive_voltage, "drive.voltage", "V", "peak-to-peak voltage Phi_pp, swings from 0 to Phi_pp"),
    positive(Key::drive_frequency, "drive.frequency", "Hz", "drive frequency, or edge: operate just below the edge"),
    at_least(1.0, Key::nd_lambda_p, "nondimensional.lambda_p", "1", "pre-stretch", largest_stretch),
    at_least(0.0, Key::nd_mu_ratio, "nondimensional.mu_ratio", "1", "mu_B/mu_A; 0: no Maxwell branch"),
    positive(Key::nd_alpha_a, "nondimensional.alpha_A", "1", "exponent of the Ogden spring", largest_exponent),
    positive(Key::nd_alpha_b, "nondimensional.alpha_B", "1", "exponent of the Maxwell spring", largest_exponent),
    at_least(0.0, Key::nd_delta_a, "nondimensional.delta_A", "1", "viscosity of the parallel dashpot"),
    at_least(0.0, Key::nd_delta_b, "nondimensional.delta_B", "1",
             "viscosity of the Maxwell dashpot, above 0 unless mu_ratio is 0"),
    positive(Key::nd_length, "nondimensional.l", "1", "rod length"),
    at_least(0.0, Key::nd_gap, "nondimensional.g", "1", "gap between rest and stop"),
    at_least(0.0, Key::nd_stiffness, "nondimensional.k", "1", "stiffness of the stop"),
    at_least(0.0, Key::nd_damping, "nondimensional.delta_i", "1", "damping of the stop"),
    at_least(0.0, Key::nd_voltage, "nondimensional.phi_pp", "1", "peak-to-peak voltage"),
    at_least(1.0, Key::nd_layers, "nondimensional.layers", "1", "membranes stacked per side", most_layers, 1.0),
    positive(Key::nd_omega, "nondimensional.omega", "1", "angular drive frequency, or edge"),
    positive(Key::sm_mass, "spring-mass.mass", "kg", "moving mass m"),
    at_least(0.0, Key::sm_damping, "spring-mass.damping", "N s/m", "damping c of the suspension"),
    at_least(0.0, Key::sm_stiffness, "spring-mass.stiffness", "N/m",
             "linear stiffness k1 of the suspension, above 0 unless cubic is above 0"),
    any(Key::sm_cubic, "spring-mass.cubic", "N/m^3", "cubic stiffness k3 of the suspension", 0.0),
    at_least(0.0, Key::sm_force, "spring-mass.force", "N", "amplitude F of the driving force"),
    positive(Key::sm_omega, "spring-mass.omega", "rad/s", "angular drive frequency, in place of drive.frequency"),
}};

constexpr bool table_is_in_order() {
    for (std::size_t i = 0; i < key_count; ++i) {
        if (table[i].key != static_cast<Key>(i)) { return false; }
    }
    return true;
}
static_assert(table_is_in_order());

constexpr std::array dielectric_si = {Key::inner_radius,
                                      Key::outer_radius,
                                      Key::membrane_thickness,
                                      Key::prestretch,
                                      Key::rod_length,
                                      Key::moving_mass,
                                      Key::layers,
                                      Key::shear_modulus,
                                      Key::ogden_exponent,
                                      Key::maxwell_modulus,
                                      Key::maxwell_exponent,
                                      Key::kelvin_viscosity,
                                      Key::maxwell_viscosity,
                                      Key::relative_permittivity,
                                      Key::stop_gap,
                                      Key::stop_stiffness,
                                      Key::stop_damping,
                                      Key::drive_voltage,
                                      Key::drive_frequency};

constexpr std::array dielectric_nondimensional = {Key::nd_lambda_p,  Key::nd_mu_ratio, Key::nd_alpha_a, Key::nd_alpha_b,
                                                  Key::nd_delta_a,   Key::nd_delta_b,  Key::nd_length,  Key::nd_gap,
                                                  Key::nd_stiffness, Key::nd_damping,  Key::nd_voltage, Key::nd_layers,
                                                  Key::nd_omega};

constexpr std::array spring_mass = {Key::sm_mass,         Key::sm_damping, Key::sm_stiffness,   Key::sm_cubic,
                                    Key::sm_force,        Key::stop_gap,   Key::stop_stiffness, Key::stop_damping,
                                    Key::drive_frequency, Key::sm_omega};

}  // namespace

const KeyInfo& key_info(Key key) { return table.at(static_cast<std::size_t>(key)); }

std::optional<Key> find_key(std::string_view name) {
    for (const KeyInfo& info : table) {
        if (info.name == name) { return info.key; }
    }
    return std::nullopt;
}

std::span<const Key> keys_of(Family family) {
    switch (family) {
        case Family::dielectric_elastomer_si: return dielectric_si;
        case Family::dielectric_elastomer_nondimensional: return dielectric_nondimensional;
        case Family::spring_mass: return spring_mass;
    }
    throw std::invalid_argument("model: unknown family");
}

std::string allowed_range(const KeyInfo& info) {
    const bool below_bounded = info.lowest > -unbounded;
    const bool above_bounded = info.highest < unbounded;
    if (!below_bounded && !above_bounded) { return "any finite number"; }
    std::string text;
    if (below_bounded) { text = (info.lowest_allowed ? "at least " : "above ") + number_text(info.lowest); }
    if (above_bounded) { text += (below_bounded ? ", at most " : "at most ") + number_text(info.highest); }
    return text;
}

}  // namespace percuss::model
