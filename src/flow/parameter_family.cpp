#include "flow/parameter_family.hpp"

namespace percuss::flow {

ParameterFamily along_frequency(const System& base, double unit) {
    const auto index = static_cast<std::size_t>(base.integrator->info().omega);
    ParameterFamily family;
    family.base = base;
    family.units = {unit};
    family.parameters = [base, index](std::span<const double> p) {
        ParameterVector parameters = base.parameters;
        parameters[index] = p[0];
        return parameters;
    };
    family.directions = [index](std::span<const double>) {
        ParameterVector direction{};
        direction[index] = 1.0;
        return std::vector<ParameterVector>{direction};
    };
    return family;
}

}  // namespace percuss::flow
