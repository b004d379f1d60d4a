#include "model/specification.hpp"

#include "model/number_text.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>

namespace percuss::model {

namespace {

std::string assignment(const KeyInfo& info, double value) {
    std::string text = std::string(info.name) + " = " + number_text(value, 9);
    if (info.unit != "1") {
        text += ' ';
        text += info.unit;
    }
    return text;
}

/// The value in force: the given one, else the default, else NaN.
double effective(const Specification& spec, Key key) {
    return spec.has(key) ? spec.value(key) : key_info(key).fallback.value_or(std::numeric_limits<double>::quiet_NaN());
}

bool is_stop_key(Key key) {
    return key == Key::stop_gap || key == Key::stop_stiffness || key == Key::stop_damping || key == Key::nd_gap ||
           key == Key::nd_stiffness || key == Key::nd_damping;
}

bool is_frequency_key(Key key) { return key == Key::drive_frequency || key == Key::nd_omega || key == Key::sm_omega; }

bool is_maxwell_detail(Key key) {
    return key == Key::maxwell_exponent || key == Key::maxwell_viscosity || key == Key::nd_alpha_b ||
           key == Key::nd_delta_b;
}

bool maxwell_branch_is_off(const Specification& spec) {
    const Key key = spec.family == Family::dielectric_elastomer_si ? Key::maxwell_modulus : Key::nd_mu_ratio;
    return effective(spec, key) == 0.0;
}

void check_value(const KeyInfo& info, double value, std::vector<std::string>& found) {
    const bool above = info.lowest_allowed ? value >= info.lowest : value > info.lowest;
    if (!(std::isfinite(value) && above && value <= info.highest)) {
        found.push_back(assignment(info, value) + " is out of range: must be " + allowed_range(info));
    }
}

void check_radii(const Specification& spec, std::vector<std::string>& found) {
    const double inner = spec.value(Key::inner_radius);
    const double outer = spec.value(Key::outer_radius);
    if (outer <= inner) {
        found.push_back(assignment(key_info(Key::outer_radius), outer) + " is out of range: must be above " +
                        assignment(key_info(Key::inner_radius), inner));
    }
}

void check_maxwell_branch(const Specification& spec, Key viscosity, std::vector<std::string>& found) {
    if (!maxwell_branch_is_off(spec) && spec.value(viscosity) == 0.0) {
        found.push_back(assignment(key_info(viscosity), 0.0) +
                        " is out of range: must be above 0 unless the Maxwell branch is off");
    }
}

void check_suspension(const Specification& spec, std::vector<std::string>& found) {
    const double stiffness = spec.value(Key::sm_stiffness);
    if (stiffness == 0.0 && effective(spec, Key::sm_cubic) <= 0.0) {
        found.push_back(assignment(key_info(Key::sm_stiffness), stiffness) +
                        " is out of range: must be above 0 unless spring-mass.cubic is above 0");
    }
    if (spec.has(Key::drive_frequency) && spec.has(Key::sm_omega)) {
        found.emplace_back("drive.frequency and spring-mass.omega are both given: give one of them");
    }
}

}  // namespace

Specification::Specification() { values.fill(std::numeric_limits<double>::quiet_NaN()); }

bool Specification::has(Key key) const { return !std::isnan(value(key)); }

bool is_required(const Specification& spec, Key key) {
    if (is_frequency_key(key) || key_info(key).fallback) { return false; }
    if (is_stop_key(key) && spec.law == StopLaw::none) { return false; }
    return !(is_maxwell_detail(key) && maxwell_branch_is_off(spec));
}

bool has_frequency(const Specification& spec) {
    return spec.has(Key::drive_frequency) || spec.has(Key::nd_omega) || spec.has(Key::sm_omega);
}

void apply_defaults(Specification& spec) {
    for (const Key key : keys_of(spec.family)) {
        if (!spec.has(key) && key_info(key).fallback) { spec.set(key, *key_info(key).fallback); }
    }
}

std::vector<std::string> violations(const Specification& spec) {
    std::vector<std::string> found;
    const auto keys = keys_of(spec.family);
    for (std::size_t i = 0; i < key_count; ++i) {
        const Key key = static_cast<Key>(i);
        const bool belongs = std::find(keys.begin(), keys.end(), key) != keys.end();
        if (spec.has(key) && belongs) {
            check_value(key_info(key), spec.value(key), found);
        } else if (spec.has(key)) {
            found.push_back(std::string(key_info(key).name) + " does not belong to this kind of problem");
        }
    }
    switch (spec.family) {
        case Family::dielectric_elastomer_si:
            check_radii(spec, found);
            check_maxwell_branch(spec, Key::maxwell_viscosity, found);
            break;
        case Family::dielectric_elastomer_nondimensional: check_maxwell_branch(spec, Key::nd_delta_b, found); break;
        case Family::spring_mass: check_suspension(spec, found); break;
    }
    for (const Key key : keys) {
        if (!spec.has(key) && is_required(spec, key)) {
            const KeyInfo& info = key_info(key);
            found.push_back(std::string(info.name) + " is missing (" + std::string(info.meaning) + ")");
        }
    }
    return found;
}

void validate(const Specification& spec) {
    const auto found = violations(spec);
    if (!found.empty()) { throw std::invalid_argument(found.front()); }
}

ActuatorKind actuator_kind(Family family) {
    return family == Family::spring_mass ? ActuatorKind::spring_mass : ActuatorKind::dielectric_elastomer;
}

}  // namespace percuss::model
