#include "model/specification.hpp"
#include "numerics/forward_dual.hpp"

#include <cmath>
#include <numbers>
#include <stdexcept>
#include <string>
#include <tuple>

namespace percuss::model {

namespace {

using numerics::ForwardDual;
using std::cbrt;
using std::sqrt;

constexpr double pi = std::numbers::pi;
constexpr double vacuum_permittivity = 8.8541878128e-12;  // F/m, CODATA 2018

double number(double x) { return x; }
double number(const ForwardDual& x) { return x.value; }

/// A specification read as scalars of type T: absent values read as their default, else as zero.
template <class T>
struct Values {
    std::array<T, key_count> at{};
    StopLaw law = StopLaw::kelvin_voigt;
    bool frequency_given = false;

    explicit Values(const Specification& spec) : law(spec.law), frequency_given(has_frequency(spec)) {
        for (std::size_t i = 0; i < key_count; ++i) {
            const Key key = static_cast<Key>(i);
            at[i] = spec.has(key) ? spec.value(key) : key_info(key).fallback.value_or(0.0);
        }
    }
    const T& operator[](Key key) const { return at[static_cast<std::size_t>(key)]; }
};

/// Scaled over the scalar T.
template <class T>
struct ScaledValues {
    std::array<T, std::tuple_size_v<Parameters>> parameters{};
    T length = 1.0;
    T time = 1.0;
    T force = 1.0;
    T field = 1.0;
    T current = 1.0;
    T voltage = 1.0;
};

/// With the Maxwell branch off its stretches act on nothing; any decay will do as long as it is one.
template <class T>
void switch_maxwell_branch_off(ScaledValues<T>& out) {
    out.parameters[membrane::delta_b] = 1.0;
    out.parameters[membrane::alpha_b] = 2.0;
}

/// Paper, section 2.2.
template <class T>
ScaledValues<T> scale_dielectric(const Values<T>& v) {
    const T& inner = v[Key::inner_radius];
    const T& outer = v[Key::outer_radius];
    const T& thickness = v[Key::membrane_thickness];
    const T& stretch = v[Key::prestretch];
    const T& mass = v[Key::moving_mass];
    const T& mu = v[Key::shear_modulus];
    const T permittivity = vacuum_permittivity * v[Key::relative_permittivity];

    ScaledValues<T> out;
    out.length = outer - inner;
    out.force = 2.0 * pi * inner * mu * thickness;
    out.time = sqrt(mass * out.length / out.force);  // Gamma
    out.field = sqrt(mu / permittivity);
    // C Phi = eps pi (b^2 - a^2) lambda_p^2 s Phi / T0 with Phi = phi (T0/lambda_p) sqrt(mu_A/eps)
    out.current = v[Key::layers] * sqrt(permittivity * mu) * pi * (outer * outer - inner * inner) * stretch / out.time;
    out.voltage = v[Key::drive_voltage];

    auto& p = out.parameters;
    p[membrane::lambda_p] = stretch;
    p[membrane::mu_ratio] = v[Key::maxwell_modulus] / mu;
    p[membrane::alpha_a] = v[Key::ogden_exponent];
    p[membrane::alpha_b] = v[Key::maxwell_exponent];
    p[membrane::delta_a] = v[Key::kelvin_viscosity] / (out.time * mu * stretch);
    p[membrane::delta_b] = 3.0 * v[Key::maxwell_viscosity] / (out.time * v[Key::maxwell_modulus]);
    p[membrane::length] = v[Key::rod_length] / out.length;
    p[membrane::gap] = v[Key::stop_gap] / out.length;
    p[membrane::stiffness] = v[Key::stop_stiffness] * out.length / out.force;  // K Gamma^2 / m
    p[membrane::damping] = v[Key::stop_damping] * out.time / mass;
    p[membrane::voltage] = v[Key::drive_voltage] * stretch / (thickness * out.field);
    p[membrane::layers] = v[Key::layers];
    p[membrane::omega] = 2.0 * pi * v[Key::drive_frequency] * out.time;
    if (number(v[Key::maxwell_modulus]) == 0.0) { switch_maxwell_branch_off(out); }
    return out;
}

template <class T>
ScaledValues<T> scale_nondimensional(const Values<T>& v) {
    ScaledValues<T> out;
    auto& p = out.parameters;
    p[membrane::lambda_p] = v[Key::nd_lambda_p];
    p[membrane::mu_ratio] = v[Key::nd_mu_ratio];
    p[membrane::alpha_a] = v[Key::nd_alpha_a];
    p[membrane::alpha_b] = v[Key::nd_alpha_b];
    p[membrane::delta_a] = v[Key::nd_delta_a];
    p[membrane::delta_b] = v[Key::nd_delta_b];
    p[membrane::length] = v[Key::nd_length];
    p[membrane::gap] = v[Key::nd_gap];
    p[membrane::stiffness] = v[Key::nd_stiffness];
    p[membrane::damping] = v[Key::nd_damping];
    p[membrane::voltage] = v[Key::nd_voltage];
    p[membrane::layers] = v[Key::nd_layers];
    p[membrane::omega] = v[Key::nd_omega];
    if (number(v[Key::nd_mu_ratio]) == 0.0) { switch_maxwell_branch_off(out); }
    return out;
}

/// Length that displacements are measured in: the gap if there is one, else the static deflection under the force.
template <class T>
T spring_length(const Values<T>& v) {
    if (v.law != StopLaw::none && number(v[Key::stop_gap]) > 0.0) { return v[Key::stop_gap]; }
    if (!(number(v[Key::sm_force]) > 0.0)) { return 1.0; }
    if (number(v[Key::sm_stiffness]) > 0.0) { return v[Key::sm_force] / v[Key::sm_stiffness]; }
    return cbrt(v[Key::sm_force] / v[Key::sm_cubic]);
}

/// m x'' + c x' + k1 x + k3 x^3 + f_stop = F cos(theta) divided by m X / T^2, with x = X y and t = T tau.
template <class T>
ScaledValues<T> scale_spring(const Values<T>& v) {
    const T& mass = v[Key::sm_mass];
    const T& stiffness = v[Key::sm_stiffness];
    const T& cubic = v[Key::sm_cubic];
    const T length = spring_length(v);

    ScaledValues<T> out;
    out.length = length;
    out.time = sqrt(mass / (number(stiffness) > 0.0 ? stiffness : cubic * length * length));
    const T per_stiffness = out.time * out.time / mass;
    const T per_damping = out.time / mass;
    out.force = length / per_stiffness;

    auto& p = out.parameters;
    p[spring::damping] = v[Key::sm_damping] * per_damping;
    p[spring::stiffness] = stiffness * per_stiffness;
    p[spring::cubic] = cubic * length * length * per_stiffness;
    p[spring::force] = v[Key::sm_force] / out.force;
    p[spring::gap] = v[Key::stop_gap] / length;
    p[spring::stop_stiffness] = v[Key::stop_stiffness] * per_stiffness;
    p[spring::stop_damping] = v[Key::stop_damping] * per_damping;
    p[spring::omega] = (2.0 * pi * v[Key::drive_frequency] + v[Key::sm_omega]) * out.time;  // one of them is zero
    return out;
}

template <class T>
ScaledValues<T> scale_values(Family family, const Values<T>& values) {
    switch (family) {
        case Family::dielectric_elastomer_si: return scale_dielectric(values);
        case Family::dielectric_elastomer_nondimensional: return scale_nondimensional(values);
        case Family::spring_mass: return scale_spring(values);
    }
    throw std::invalid_argument("model: unknown family");
}

template <class T, class Part>
Scaled collect(const ScaledValues<T>& values, Part part) {
    Scaled out;
    for (std::size_t i = 0; i < out.parameters.size(); ++i) { out.parameters[i] = part(values.parameters[i]); }
    out.scales = {part(values.length), part(values.time),    part(values.force),
                  part(values.field),  part(values.current), part(values.voltage)};
    return out;
}

}  // namespace

Scaled scale(const Specification& spec) {
    return collect(scale_values(spec.family, Values<double>(spec)), [](double x) { return x; });
}

Scaled scale_derivative(const Specification& spec, Key key) {
    Values<ForwardDual> values(spec);
    values.at[static_cast<std::size_t>(key)].derivative = 1.0;
    if (!values.frequency_given && (key == Key::drive_frequency || key == Key::nd_omega || key == Key::sm_omega)) {
        throw std::invalid_argument(std::string(key_info(key).name) + " is not given: nothing to differentiate by");
    }
    return collect(scale_values(spec.family, values), [](const ForwardDual& x) { return x.derivative; });
}

}  // namespace percuss::model
