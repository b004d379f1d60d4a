#include "design/integrators.hpp"

#include "kernels/kernels.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <stdexcept>
#include <string>

namespace percuss::design {
namespace {

using model::Specification;

/// The way is found at this tolerance, in fewer and cheaper steps; everything met on it is refined at the problem's
/// own.
constexpr double scout_tolerance = 1e-8;

std::unique_ptr<flow::Integrator> make_integrator(const Problem& problem, double tolerance) {
    const Specification& spec = problem.actuator;
    kernels::IntegratorOptions options;
    options.integrator = integrator_in_use(problem);
    options.instruction_set = problem.solver.instruction_set;
    options.tolerance = tolerance;
    return kernels::make_integrator(spec.type->scene(spec), spec.law, options);
}

}  // namespace

std::string integrator_in_use(const Problem& problem) {
    const Specification& spec = problem.actuator;
    return kernels::choose_integrator(problem.solver.integrator, spec.type->scene(spec), spec.law,
                                      model::scale(spec).parameters);
}

Integrators make_integrators(const Problem& problem) {
    const double tolerance = problem.solver.tolerance;
    // Below 1e-16 a tolerance asks for less than rounding. A scout tighter than the problem itself would be of no use.
    return {make_integrator(problem, tolerance), make_integrator(problem, std::max(1e-16, 1e-2 * tolerance)),
            make_integrator(problem, std::max(scout_tolerance, tolerance))};
}

std::optional<double> given_omega(const Specification& spec, const model::Scaled& scaled,
                                  const flow::Integrator& integrator) {
    if (!model::has_frequency(spec)) { return std::nullopt; }
    return scaled.parameters[static_cast<std::size_t>(integrator.info().omega)];
}

double drive_frequency(double omega, const model::Scales& scales) {
    return omega / (2.0 * std::numbers::pi * scales.time);
}

std::vector<double> state_scales(const model::Scales& scales, int states) {
    return {scales.state.begin(), scales.state.begin() + states};
}

std::vector<double> to_user(const flow::State& y, const model::Scales& scales, int states) {
    std::vector<double> out = state_scales(scales, states);
    for (std::size_t k = 0; k < out.size(); ++k) { out[k] *= y[k]; }
    return out;
}

flow::State from_user(const std::vector<double>& given, std::string_view key, const model::Actuator& actuator,
                      const model::Scales& scales, int states) {
    const std::string name(key);
    if (given.size() != static_cast<std::size_t>(states)) {
        throw std::invalid_argument(name + " has " + std::to_string(given.size()) + " entries: expected " +
                                    std::to_string(states));
    }
    const std::vector<double> factors = state_scales(scales, states);
    flow::State y{};
    for (std::size_t k = 0; k < given.size(); ++k) {
        if (!std::isfinite(given[k])) { throw std::invalid_argument(name + ": every entry must be a finite number"); }
        y[k] = given[k] / factors[k];
    }
    for (std::size_t k = 0; k < given.size(); ++k) {
        if (actuator.states[k].positive && !(y[k] > 0.0)) {
            throw std::invalid_argument(name + ": " + std::string(actuator.positive_states) + " must be positive");
        }
    }
    return y;
}

}  // namespace percuss::design
