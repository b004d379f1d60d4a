#pragma once
/// \file
/// A one-step or multistep method as the event machinery sees it: it advances by steps of its own choice and can then
/// be evaluated anywhere inside the last one, to its own accuracy.

#include "flow/augmented_system.hpp"
#include "flow/flow.hpp"

namespace percuss::flow {

class Stepper {
public:
    Stepper() = default;
    Stepper(const Stepper&) = delete;
    Stepper& operator=(const Stepper&) = delete;
    virtual ~Stepper() = default;

    /// Starts, or starts again after an event. Up to `limit`, which is never passed, the motion is smooth.
    virtual bool start(double t, const Extended& y, bool touching, double limit) = 0;
    /// Takes one step; false when the method cannot go on.
    virtual bool advance() = 0;

    /// Ends of the last step, in the direction of integration, and the states there (overlap first).
    [[nodiscard]] double left() const { return left_; }
    [[nodiscard]] double right() const { return right_; }
    [[nodiscard]] const State& left_values() const { return left_values_; }
    [[nodiscard]] const State& right_values() const { return right_values_; }

    /// States, or everything, at a point between left and right.
    virtual void values(double t, State& out) = 0;
    virtual void everything(double t, Extended& out) = 0;

protected:
    double left_ = 0.0;
    double right_ = 0.0;
    State left_values_{};
    State right_values_{};
};

}  // namespace percuss::flow
