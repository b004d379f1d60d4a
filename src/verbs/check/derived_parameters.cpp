#include "verbs/check/derived_parameters.hpp"

#include <span>
#include <string_view>

namespace percuss::verbs {

std::vector<DerivedParameter> derived_parameters(const problem::ProblemFile& problem) {
    if (!problem.troubles.empty()) { return {}; }
    const model::Specification& spec = problem.design.actuator;
    const model::Scaled scaled = model::scale(spec);
    const bool is_spring = model::actuator_kind(spec.family) == model::ActuatorKind::spring_mass;

    std::vector<DerivedParameter> out;
    if (spec.family != model::Family::dielectric_elastomer_nondimensional) {
        out.push_back({"length_unit", scaled.scales.length, "m", "one nondimensional length"});
        out.push_back({"time_unit", scaled.scales.time, "s", "one nondimensional time, Gamma"});
        out.push_back({"force_unit", scaled.scales.force, "N", "one nondimensional force"});
    }
    const std::span<const std::string_view> names = is_spring
                                                      ? std::span<const std::string_view>(model::spring::names)
                                                      : std::span<const std::string_view>(model::membrane::names);
    for (std::size_t i = 0; i < names.size(); ++i) {
        const bool at_edge = names[i] == "omega" && !model::has_frequency(spec);
        const bool of_stop = names[i] == "g" || names[i] == "gap" || names[i] == "k" || names[i] == "delta_i";
        if (!at_edge && !(of_stop && spec.law == model::StopLaw::none)) {
            out.push_back({std::string(names[i]), scaled.parameters.at(i), "", "nondimensional parameter"});
        }
    }
    return out;
}

}  // namespace percuss::verbs
