#pragma once
/// \file
/// One design evaluated: operating point, orbit, quantities with exact gradients, uniqueness.

#include "design/evaluation.hpp"
#include "flow/flow.hpp"

#include <functional>
#include <memory>
#include <optional>

namespace percuss::design {

/// A problem made ready: kernels chosen, key directions known. Evaluations are independent of each other; an
/// Evaluator may be shared between threads.
class Evaluator {
public:
    /// Throws std::invalid_argument for a specification out of range or a quantity that this family does not have.
    explicit Evaluator(Problem problem);
    ~Evaluator();
    Evaluator(Evaluator&&) noexcept;
    Evaluator& operator=(Evaluator&&) noexcept;

    [[nodiscard]] const Problem& problem() const;

    /// The nondimensional system of a specification, with the problem's integrator; its omega is the specification's, 0
    /// without one. Lives as long as the evaluator. Its work is charged to `cost`, within the limits there.
    [[nodiscard]] flow::System system(const model::Specification& actuator, flow::Cost* cost = nullptr) const;

    /// The design of the problem with some keys replaced. drive.frequency absent: operate at the edge.
    [[nodiscard]] Evaluation evaluate(const model::Specification& actuator, const Demand& demand) const;
    [[nodiscard]] Evaluation evaluate(const Demand& demand) const;

    /// The periodic orbit at the given frequency: `start` (state at theta = 0 in the problem's units) polished by
    /// Newton's method, or without it the motion reached from rest. Quantities of the demand included; its status is
    /// ok, unstable (the orbit is unstable) or failed.
    [[nodiscard]] Evaluation orbit(const model::Specification& actuator,
                                   const std::optional<std::vector<double>>& start, int period,
                                   const Demand& demand) const;

private:
    struct Implementation;
    std::unique_ptr<Implementation> implementation_;
};

}  // namespace percuss::design
