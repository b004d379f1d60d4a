#include "model/membrane/membrane.hpp"
#include "model/scaling.hpp"

#include <cmath>
#include <numbers>

namespace percuss::model::membrane {

namespace {

using std::sqrt;
using std::numbers::pi;

constexpr double vacuum_permittivity = 8.8541878128e-12;  // F/m, CODATA 2018

constexpr double most_layers = 64.0;
// Stretch and exponent at their largest together: lambda_p^(3 alpha_A) = 1e150 is still a finite double.
constexpr double largest_stretch = 10.0;
constexpr double largest_exponent = 50.0;
constexpr double largest_permittivity = 1e6;

constexpr std::array si_table = {
    positive_key(key::inner_radius, "actuator.inner_radius", "m", "radius a of the central disk"),
    positive_key(key::outer_radius, "actuator.outer_radius", "m", "radius b of the frame, above inner_radius"),
    positive_key(key::membrane_thickness, "actuator.membrane_thickness", "m",
                 "thickness T0 of one layer before pre-stretch"),
    key_at_least(1.0, key::prestretch, "actuator.prestretch", "1", "equal-biaxial pre-stretch lambda_p",
                 largest_stretch),
    positive_key(key::rod_length, "actuator.rod_length", "m",
                 "length L of the rod; each membrane stands at L/2 at rest"),
    positive_key(key::moving_mass, "actuator.moving_mass", "kg", "mass m that moves"),
    key_at_least(1.0, key::layers, "actuator.layers", "1", "membranes n stacked per side, in parallel", most_layers,
                 1.0)
        .with(Role::layers)
        .whole(),
    positive_key(key::shear_modulus, "material.shear_modulus", "Pa", "modulus mu_A of the Ogden spring"),
    positive_key(key::ogden_exponent, "material.ogden_exponent", "1", "exponent alpha_A of the Ogden spring",
                 largest_exponent),
    key_at_least(0.0, key::maxwell_modulus, "material.maxwell_modulus", "Pa",
                 "modulus mu_B of the Maxwell spring; 0: no Maxwell branch"),
    positive_key(key::maxwell_exponent, "material.maxwell_exponent", "1", "exponent alpha_B of the Maxwell spring",
                 largest_exponent),
    key_at_least(0.0, key::kelvin_viscosity, "material.kelvin_viscosity", "Pa s",
                 "viscosity eta_A of the parallel dashpot"),
    key_at_least(0.0, key::maxwell_viscosity, "material.maxwell_viscosity", "Pa s",
                 "viscosity eta_B of the Maxwell dashpot, above 0 unless maxwell_modulus is 0"),
    key_at_least(1.0, key::relative_permittivity, "material.relative_permittivity", "1",
                 "relative permittivity eps_r of the membrane", largest_permittivity),
    key_at_least(0.0, key::drive_voltage, "drive.voltage", "V", "peak-to-peak voltage Phi_pp, swings from 0 to Phi_pp")
        .with(Role::drive),
};

constexpr std::array si_keys = {key::inner_radius,
                                key::outer_radius,
                                key::membrane_thickness,
                                key::prestretch,
                                key::rod_length,
                                key::moving_mass,
                                key::layers,
                                key::shear_modulus,
                                key::ogden_exponent,
                                key::maxwell_modulus,
                                key::maxwell_exponent,
                                key::kelvin_viscosity,
                                key::maxwell_viscosity,
                                key::relative_permittivity,
                                Key::stop_gap,
                                Key::stop_stiffness,
                                Key::stop_damping,
                                key::drive_voltage,
                                Key::drive_frequency};

constexpr std::array nondimensional_table = {
    key_at_least(1.0, key::nd_lambda_p, "nondimensional.lambda_p", "1", "pre-stretch", largest_stretch),
    key_at_least(0.0, key::nd_mu_ratio, "nondimensional.mu_ratio", "1", "mu_B/mu_A; 0: no Maxwell branch"),
    positive_key(key::nd_alpha_a, "nondimensional.alpha_A", "1", "exponent of the Ogden spring", largest_exponent),
    positive_key(key::nd_alpha_b, "nondimensional.alpha_B", "1", "exponent of the Maxwell spring", largest_exponent),
    key_at_least(0.0, key::nd_delta_a, "nondimensional.delta_A", "1", "viscosity of the parallel dashpot"),
    key_at_least(0.0, key::nd_delta_b, "nondimensional.delta_B", "1",
                 "viscosity of the Maxwell dashpot, above 0 unless mu_ratio is 0"),
    positive_key(key::nd_length, "nondimensional.l", "1", "rod length"),
    key_at_least(0.0, key::nd_gap, "nondimensional.g", "1", "gap between rest and stop").with(Role::stop_gap),
    key_at_least(0.0, key::nd_stiffness, "nondimensional.k", "1", "stiffness of the stop").with(Role::stop_stiffness),
    key_at_least(0.0, key::nd_damping, "nondimensional.delta_i", "1", "damping of the stop").with(Role::stop_damping),
    key_at_least(0.0, key::nd_voltage, "nondimensional.phi_pp", "1", "peak-to-peak voltage").with(Role::drive),
    key_at_least(1.0, key::nd_layers, "nondimensional.layers", "1", "membranes stacked per side", most_layers, 1.0)
        .with(Role::layers)
        .whole(),
    positive_key(key::nd_omega, "nondimensional.omega", "1", "angular drive frequency, or edge").with(Role::frequency),
};

constexpr std::array nondimensional_keys = {key::nd_lambda_p,  key::nd_mu_ratio, key::nd_alpha_a, key::nd_alpha_b,
                                            key::nd_delta_a,   key::nd_delta_b,  key::nd_length,  key::nd_gap,
                                            key::nd_stiffness, key::nd_damping,  key::nd_voltage, key::nd_layers,
                                            key::nd_omega};

/// With the Maxwell branch off its stretches act on nothing; any decay will do as long as it is one.
template <class T>
void switch_maxwell_branch_off(ScaledValues<T>& out) {
    out.parameters[delta_b] = 1.0;
    out.parameters[alpha_b] = 2.0;
}

/// Paper, section 2.2.
struct SiScaling {
    template <class T>
    static ScaledValues<T> scale(const Values<T>& v) {
        const T& inner = v[key::inner_radius];
        const T& outer = v[key::outer_radius];
        const T& thickness = v[key::membrane_thickness];
        const T& stretch = v[key::prestretch];
        const T& mass = v[key::moving_mass];
        const T& mu = v[key::shear_modulus];
        const T permittivity = vacuum_permittivity * v[key::relative_permittivity];

        ScaledValues<T> out;
        out.length = outer - inner;
        out.force = 2.0 * pi * inner * mu * thickness;
        out.time = sqrt(mass * out.length / out.force);  // Gamma
        const T field_unit = sqrt(mu / permittivity);
        out.own[field_scale] = field_unit;
        // C Phi = eps pi (b^2 - a^2) lambda_p^2 s Phi / T0 with Phi = phi (T0/lambda_p) sqrt(mu_A/eps)
        out.own[current_scale] =
            v[key::layers] * sqrt(permittivity * mu) * pi * (outer * outer - inner * inner) * stretch / out.time;
        out.own[voltage_scale] = v[key::drive_voltage];

        auto& p = out.parameters;
        p[lambda_p] = stretch;
        p[mu_ratio] = v[key::maxwell_modulus] / mu;
        p[alpha_a] = v[key::ogden_exponent];
        p[alpha_b] = v[key::maxwell_exponent];
        p[delta_a] = v[key::kelvin_viscosity] / (out.time * mu * stretch);
        p[delta_b] = 3.0 * v[key::maxwell_viscosity] / (out.time * v[key::maxwell_modulus]);
        p[length] = v[key::rod_length] / out.length;
        p[gap] = v[Key::stop_gap] / out.length;
        p[stiffness] = v[Key::stop_stiffness] * out.length / out.force;  // K Gamma^2 / m
        p[damping] = v[Key::stop_damping] * out.time / mass;
        p[voltage] = v[key::drive_voltage] * stretch / (thickness * field_unit);
        p[layers] = v[key::layers];
        p[omega] = 2.0 * pi * v[Key::drive_frequency] * out.time;
        // delta_B has just been divided by this modulus.
        if (number(v[key::maxwell_modulus]) == 0.0) { switch_maxwell_branch_off(out); }
        return out;
    }
};

struct NondimensionalScaling {
    template <class T>
    static ScaledValues<T> scale(const Values<T>& v) {
        ScaledValues<T> out;
        auto& p = out.parameters;
        p[lambda_p] = v[key::nd_lambda_p];
        p[mu_ratio] = v[key::nd_mu_ratio];
        p[alpha_a] = v[key::nd_alpha_a];
        p[alpha_b] = v[key::nd_alpha_b];
        p[delta_a] = v[key::nd_delta_a];
        p[delta_b] = v[key::nd_delta_b];
        p[length] = v[key::nd_length];
        p[gap] = v[key::nd_gap];
        p[stiffness] = v[key::nd_stiffness];
        p[damping] = v[key::nd_damping];
        p[voltage] = v[key::nd_voltage];
        p[layers] = v[key::nd_layers];
        p[omega] = v[key::nd_omega];
        if (number(v[key::nd_mu_ratio]) == 0.0) { switch_maxwell_branch_off(out); }
        return out;
    }
};

/// Without Maxwell branches two states do: the stretches would be followed for nothing.
const Scene& scene_of(const Specification& spec) {
    return spec.type->scale(spec).parameters[mu_ratio] > 0.0 ? viscous : elastic;
}

/// A Maxwell branch without viscosity would relax at once: delta_B = 0 is divided by.
void check_maxwell_branch(const Specification& spec, Key modulus, Key viscosity, std::vector<std::string>& found) {
    if (spec.effective(modulus) != 0.0 && spec.value(viscosity) == 0.0) {
        found.push_back(assignment(viscosity, 0.0) +
                        " is out of range: must be above 0 unless the Maxwell branch is off");
    }
}

/// Appends what is wrong between keys: a frame no wider than the disk, a stop that presses at rest (which this scaling
/// and the symmetry of the free motion do not cover), a branch without viscosity.
void check_si(const Specification& spec, std::vector<std::string>& found) {
    const double inner = spec.value(key::inner_radius);
    const double outer = spec.value(key::outer_radius);
    if (outer <= inner) {
        found.push_back(assignment(key::outer_radius, outer) + " is out of range: must be above " +
                        assignment(key::inner_radius, inner));
    }
    const double stop_gap = spec.value(Key::stop_gap);
    if (stop_gap < 0.0) {
        found.push_back(assignment(Key::stop_gap, stop_gap) + " is out of range: must be at least 0");
    }
    check_maxwell_branch(spec, key::maxwell_modulus, key::maxwell_viscosity, found);
}

void check_nondimensional(const Specification& spec, std::vector<std::string>& found) {
    check_maxwell_branch(spec, key::nd_mu_ratio, key::nd_delta_b, found);
}

/// The rest of the Maxwell branch means nothing where its modulus is zero.
bool may_be_absent_si(const Specification& spec, Key k) {
    return (k == key::maxwell_exponent || k == key::maxwell_viscosity) && spec.effective(key::maxwell_modulus) == 0.0;
}
bool may_be_absent_nondimensional(const Specification& spec, Key k) {
    return (k == key::nd_alpha_b || k == key::nd_delta_b) && spec.effective(key::nd_mu_ratio) == 0.0;
}

constexpr ScalePowers of_length = {1, 0, 0, {}};
constexpr ScalePowers of_velocity = {1, -1, 0, {}};
constexpr std::array<StateInfo, states> state_infos = {
    {{"x", "m", of_length}, {"x'", "m/s", of_velocity}, {"xi_I", "", {}, true}, {"xi_II", "", {}, true}}};

/// Shares of the peak-to-peak voltage on membranes I and II, in anti-phase: (1 -+ cos theta)/2.
double lower_half(double phase) { return 0.5 * (1.0 - std::cos(phase)); }
double upper_half(double phase) { return 0.5 * (1.0 + std::cos(phase)); }
constexpr std::array<DriveSignal, 2> voltages = {{{"voltage_I", "V", lower_half}, {"voltage_II", "V", upper_half}}};
constexpr std::array<DriveSignal, 2> plain_voltages = {{{"phi_I", "", lower_half}, {"phi_II", "", upper_half}}};

constexpr std::array<OwnQuantity, 3> quantities = {{
    {"electric_field",
     "V/m",
     "largest true electric field in a membrane",
     OwnQuantity::From::peak,
     field,
     {0, 0, 0, {1, 0, 0}}},
    {"drive_current",
     "A",
     "largest current per side, all layers",
     OwnQuantity::From::peak,
     current,
     {0, 0, 0, {0, 1, 0}}},
    {"apparent_power",
     "VA",
     "drive voltage times drive_current",
     OwnQuantity::From::peak,
     current,
     {0, 0, 0, {0, 1, 1}}},
}};

constexpr std::string_view type_name = "dielectric-elastomer";
constexpr std::string_view stretches = "the stretches xi_I and xi_II";
constexpr std::array<std::string_view, 2> si_sections = {"actuator.", "material."};
constexpr std::array<std::string_view, 1> nondimensional_sections = {"nondimensional."};
constexpr std::array si_frequencies = {Key::drive_frequency};
constexpr std::array nondimensional_frequencies = {key::nd_omega};

}  // namespace

constinit const Actuator si = {
    .type = type_name,
    .kind = "a dielectric elastomer problem in SI units",
    .sections = si_sections,
    .sections_in_words = "[actuator] and [material]",
    .nondimensional = false,
    .follows_type = true,
    .own_keys = si_table,
    .keys = si_keys,
    .frequencies = si_frequencies,
    .drive_word = "voltage",
    .drives = voltages,
    .states = state_infos,
    .positive_states = stretches,
    .parameters = names,
    .roles = roles,
    .quantities = quantities,
    .quantities_only_for = "exists only for dielectric elastomer problems given in SI units",
    .scale = scale_with<SiScaling>,
    .scale_derivative = scale_derivative_with<SiScaling>,
    .scene = scene_of,
    .may_be_absent = may_be_absent_si,
    .check = check_si,
};

constinit const Actuator nondimensional = {
    .type = type_name,
    .kind = "a [nondimensional] problem",
    .sections = nondimensional_sections,
    .sections_in_words = "[nondimensional]",
    .nondimensional = true,
    .follows_type = false,
    .own_keys = nondimensional_table,
    .keys = nondimensional_keys,
    .frequencies = nondimensional_frequencies,
    .drive_word = "voltage",
    .drives = plain_voltages,
    .states = state_infos,
    .positive_states = stretches,
    .parameters = names,
    .roles = roles,
    .quantities = {},
    .quantities_only_for = "",
    .scale = scale_with<NondimensionalScaling>,
    .scale_derivative = scale_derivative_with<NondimensionalScaling>,
    .scene = scene_of,
    .may_be_absent = may_be_absent_nondimensional,
    .check = check_nondimensional,
};

}  // namespace percuss::model::membrane
