#pragma once
/// \file
/// A problem made ready to integrate: kernels chosen once, and the conversions between the user's units and the
/// nondimensional state.

#include "design/problem.hpp"
#include "flow/flow.hpp"

#include <memory>
#include <optional>
#include <vector>

namespace percuss::design {

/// Integrators of the actuator, stop law and material of a problem; parameters may vary.
struct Integrators {
    std::unique_ptr<flow::Integrator> own;      ///< at the problem's tolerance
    std::unique_ptr<flow::Integrator> tighter;  ///< a hundred times tighter, for error estimates
    std::unique_ptr<flow::Integrator> scout;    ///< looser, for finding the way; its errors reach no result
};

/// Throws std::invalid_argument for a specification that cannot be scaled or an integrator that does not exist.
Integrators make_integrators(const Problem& problem);

/// The drive frequency of a specification, omega = 2 pi f Gamma; nothing when it is operated at its edge.
std::optional<double> given_omega(const model::Specification& spec, const model::Scaled& scaled,
                                  const flow::Integrator& integrator);

/// Drive frequency in the user's unit (Hz; rad per nondimensional time without scales: omega / 2 pi) of omega.
double drive_frequency(double omega, const model::Scales& scales);

/// A nondimensional state in the problem's units.
std::vector<double> to_user(const flow::State& y, const model::Scales& scales, int states);
/// Factor from nondimensional state to the problem's units, per entry.
std::vector<double> state_scales(const model::Scales& scales, int states);
/// A state in the problem's units made nondimensional. Throws std::invalid_argument naming `key` for a wrong number of
/// entries, a number that is not finite, a state that must be positive and is not.
flow::State from_user(const std::vector<double>& given, std::string_view key, const model::Actuator& actuator,
                      const model::Scales& scales, int states);

}  // namespace percuss::design
