#pragma once
/// \file
/// One run of a step-by-step method through contacts: step, look for the first event in the step, observe up to it,
/// cross it, start again behind it.
///
/// Events are found between turning points of their own function, so an overshoot shorter than a step is not missed:
/// the overlap x - x_stop is tested at every turning point of x, each located to the accuracy of the method. On the
/// monotone stretches in between a sign decides, and a function that is zero at the start of a stretch cannot fire
/// again there.

#include "flow/augmented_system.hpp"
#include "flow/flow.hpp"
#include "flow/signals.hpp"
#include "flow/step_observer.hpp"
#include "flow/stepper.hpp"
#include "model/contact_law.hpp"

#include <cstdint>
#include <optional>

namespace percuss::flow {

class StepwiseRun {
public:
    /// Nothing is copied: all four must outlive the run.
    StepwiseRun(const AugmentedSystem& system, Stepper& stepper, const Request& request, Result& result);

    /// Fills the result. Numerical trouble ends as a status.
    void run();

private:
    using Phase = model::ContactPhase;
    struct Event {
        const model::Transition* row = nullptr;  ///< of the contact law's table
        double t = 0.0;
    };

    [[nodiscard]] bool touching() const { return phase_ == Phase::contact; }
    [[nodiscard]] bool ongoing() const { return result_.status == Status::not_run; }
    [[nodiscard]] bool hybrid() const;
    [[nodiscard]] double limit() const { return request_.duration; }

    void begin();
    [[nodiscard]] Phase first_phase() const;
    void restart();
    bool advance();
    [[nodiscard]] Piece step_as_piece();
    [[nodiscard]] std::optional<Event> first_event(const Piece& step, const TurningPoints& turns);
    [[nodiscard]] std::optional<double> first_crossing(SignalKind kind, bool upward, const Piece& step,
                                                       const TurningPoints& turns);
    /// Of the overlap or of the force on the stop.
    [[nodiscard]] SignalSample sample_at(SignalKind kind, double t, const State& values) const;
    [[nodiscard]] TurningPoints turns_of(SignalKind kind, const Piece& piece) const;
    void observe(Piece piece, TurningPoints turns, const std::optional<Event>& event);
    void cross(const Event& event);
    [[nodiscard]] Crossing crossing(const Event& event) const;
    void finish();
    /// divided_gap and divided_force of a held run; at duration zero their limits for a start on the surface.
    void divide();

    const AugmentedSystem& system_;
    Stepper& stepper_;
    const Request& request_;
    const model::ContactRules& rules_;
    Result& result_;
    StepObserver observer_;
    Phase phase_ = Phase::free;
    double t_ = 0.0;  ///< phase since the start, and the numbers there: at the last restart, and at the end
    Extended y_{};
    int events_ = 0;
};

}  // namespace percuss::flow
