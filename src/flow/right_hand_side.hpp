#pragma once
/// \file
/// Equations of motion as a function that is evaluated point by point: what the step-by-step backends integrate.
/// Everything is nondimensional; theta = omega tau is the drive phase.

#include "flow/flow.hpp"
#include "model/contact_law.hpp"

#include <array>
#include <span>

namespace percuss::flow {

/// Work per unit of tau: done by the drive, and turned into heat in the actuator (stop excluded).
struct Powers {
    double drive = 0.0;
    double loss = 0.0;
};
using Means = std::array<double, model::max_means>;  ///< mean signals, per unit of tau

class RightHandSide {
public:
    RightHandSide() = default;
    RightHandSide(const RightHandSide&) = delete;
    RightHandSide& operator=(const RightHandSide&) = delete;
    virtual ~RightHandSide() = default;

    [[nodiscard]] virtual const SystemInfo& info() const = 0;
    [[nodiscard]] int states() const { return info().states; }
    [[nodiscard]] virtual model::ContactLaw contact_law() const = 0;

    /// rate = d(state)/d(theta), and its exact derivative along each direction (state, parameters and phase moving
    /// together; at most max_lanes of them) in rate_d[0 .. directions.size()). `touching`: the force of the stop acts,
    /// whatever its sign. Outside the model's domain the result holds NaN.
    virtual void rates(const ParameterVector& p, double theta, const State& state, bool touching,
                       std::span<const Direction> directions, State& rate, State* rate_d) const = 0;

    /// Powers at a point of the motion, and their derivatives likewise.
    virtual void powers(const ParameterVector& p, double theta, const State& state,
                        std::span<const Direction> directions, Powers& value, Powers* value_d) const = 0;

    /// Value (signed) of a peak signal in one of its parts, and its derivatives likewise in value_d.
    [[nodiscard]] virtual double peak(int signal, int part, const ParameterVector& p, double theta, const State& state,
                                      std::span<const Direction> directions, double* value_d) const = 0;
    /// Values of all mean signals, and their derivatives likewise. Only called where info().means > 0.
    virtual void means(const ParameterVector& p, double theta, const State& state,
                       std::span<const Direction> directions, Means& value, Means* value_d) const = 0;

    /// Whether the model means anything at this state; false for NaN.
    [[nodiscard]] virtual bool meaningful(const State& state) const = 0;

    /// Position x of the mass at rest, and its derivative along a parameter direction.
    [[nodiscard]] virtual double centre(const ParameterVector& p) const = 0;
    [[nodiscard]] virtual double centre_derivative(const ParameterVector& p, const ParameterVector& dp) const = 0;
    /// As in Integrator.
    [[nodiscard]] virtual State rest_state(const ParameterVector& p) const = 0;
    [[nodiscard]] virtual StateRange internal_range(const ParameterVector& /*p*/, double /*reach*/) const { return {}; }
    [[nodiscard]] virtual double linear_resonance(const ParameterVector& p) const = 0;
    [[nodiscard]] virtual bool symmetric(const ParameterVector& p) const = 0;

    void rate(const ParameterVector& p, double theta, const State& state, bool touching, State& out) const {
        rates(p, theta, state, touching, {}, out, nullptr);
    }
    /// Derivative of rate() along one direction.
    void rate_derivative(const ParameterVector& p, double theta, const State& state, bool touching,
                         const Direction& direction, State& out) const {
        State value{};
        rates(p, theta, state, touching, {&direction, 1}, value, &out);
    }
};

}  // namespace percuss::flow
