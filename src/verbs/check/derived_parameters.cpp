#include "verbs/check/derived_parameters.hpp"

#include <string>

namespace percuss::verbs {

std::vector<DerivedParameter> derived_parameters(const problem::ProblemFile& problem) {
    if (!problem.troubles.empty()) { return {}; }
    const model::Specification& spec = problem.design.actuator;
    const model::Scaled scaled = model::scale(spec);
    const model::Actuator& actuator = *spec.type;

    std::vector<DerivedParameter> out;
    if (!actuator.nondimensional) {
        out.push_back({"length_unit", scaled.scales.length, "m", "one nondimensional length"});
        out.push_back({"time_unit", scaled.scales.time, "s", "one nondimensional time, Gamma"});
        out.push_back({"force_unit", scaled.scales.force, "N", "one nondimensional force"});
    }
    const model::ParameterRoles& roles = actuator.roles;
    for (std::size_t i = 0; i < actuator.parameters.size(); ++i) {
        const int index = static_cast<int>(i);
        // An omega that is to be found by computing, and parameters of a stop that is not there, have no value to be
        // shown.
        const bool at_edge = index == roles.omega && !model::has_frequency(spec);
        const bool of_stop = index == roles.gap || index == roles.stop_stiffness || index == roles.stop_damping;
        if (!at_edge && !(of_stop && !model::has_stop(spec.law))) {
            out.push_back(
                {std::string(actuator.parameters[i]), scaled.parameters.at(i), "", "nondimensional parameter"});
        }
    }
    return out;
}

}  // namespace percuss::verbs
