#include "design/families.hpp"

#include <algorithm>
#include <stdexcept>
#include <string>

namespace percuss::design {
namespace {

using flow::ParameterVector;
using model::Key;
using model::Specification;

Specification with_value(Specification spec, Key key, double value) {
    spec.set(key, value);
    return spec;
}

void require_key(const Specification& spec, Key key) {
    const auto keys = spec.type->keys;
    if (std::find(keys.begin(), keys.end(), key) == keys.end() || !spec.has(key)) {
        throw std::invalid_argument(std::string(model::key_info(key).name) +
                                    " is not a key of this problem: it cannot be varied");
    }
}

}  // namespace

double motion_size(const flow::System& system) {
    // A stop that touches or presses at rest leaves no gap to measure by: 1e-3 keeps the unit positive.
    return std::max(system.stop_position() - system.integrator->rest_state(system.parameters)[0], 1e-3);
}

flow::ParameterFamily frequency_family(const flow::System& system) {
    return flow::along_frequency(system, system.integrator->linear_resonance(system.parameters));
}

flow::ParameterFamily key_family(const flow::System& system, const Specification& spec, Key key, double unit) {
    require_key(spec, key);
    flow::ParameterFamily family;
    family.base = system;
    family.units = {unit};
    family.parameters = [spec, key](std::span<const double> p) {
        return model::scale(with_value(spec, key, p[0])).parameters;
    };
    family.directions = [spec, key](std::span<const double> p) {
        return std::vector<ParameterVector>{model::scale_derivative(with_value(spec, key, p[0]), key).parameters};
    };
    return family;
}

flow::ParameterFamily frequency_and_key_family(const flow::System& system, const Specification& spec, Key key,
                                               double unit) {
    require_key(spec, key);
    const auto omega = static_cast<std::size_t>(system.integrator->info().omega);
    flow::ParameterFamily family;
    family.base = system;
    family.units = {system.integrator->linear_resonance(system.parameters), unit};
    family.parameters = [spec, key, omega](std::span<const double> p) {
        ParameterVector parameters = model::scale(with_value(spec, key, p[1])).parameters;
        parameters[omega] = p[0];
        return parameters;
    };
    family.directions = [spec, key, omega](std::span<const double> p) {
        ParameterVector by_omega{};
        by_omega[omega] = 1.0;
        ParameterVector by_key = model::scale_derivative(with_value(spec, key, p[1]), key).parameters;
        by_key[omega] = 0.0;
        return std::vector<ParameterVector>{by_omega, by_key};
    };
    return family;
}

}  // namespace percuss::design
