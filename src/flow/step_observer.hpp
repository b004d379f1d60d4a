#pragma once
/// \file
/// Observables of a run that advances by steps, with gradients. A smooth maximum needs no derivative of the time at
/// which it is reached (envelope theorem); a value that sits at an event moves with it, on the surface by
/// dt_e = -(dx - dx_stop)/(dx/dt). Integrals are integrated along with the motion; their jumps at events are applied by
/// saltate() and divide by nothing.

#include "flow/augmented_system.hpp"
#include "flow/flow.hpp"
#include "flow/signals.hpp"

#include <array>
#include <cstdint>
#include <optional>

namespace percuss::flow {

/// The largest value offered so far.
struct Peak {
    Sensitive best;
    double t = 0.0;
    bool found = false;
    /// Keeps the larger of what it has and the candidate.
    void raise(const Sensitive& candidate, double at);
    [[nodiscard]] double level() const;
};

/// An event as the observables see it.
struct Crossing {
    double t = 0.0;
    Lanes shift{};  ///< derivative of t along the directions
};

class StepObserver {
public:
    StepObserver(const AugmentedSystem& system, std::uint32_t mask, Result& result);

    /// Whether anything is read off the steps at all, and off the turning points of x.
    [[nodiscard]] bool watches_steps() const { return watched_ != 0 || watches_extrema(); }
    [[nodiscard]] bool watches_extrema() const { return (mask_ & observe_extrema) != 0U; }

    /// Start and end of the run. A contact under way is opened or closed there.
    void begin(double t, const Extended& y, bool touching);
    void end(double t, const Extended& y, bool touching);

    /// A smooth stretch; `turns` are the turning points of x in it (empty when they are not needed).
    void piece(const Piece& piece, const TurningPoints& turns);

    /// The mass enters the stop, y just before with the overlap zero; `with_impact`: through the surface, not by the
    /// force of a no-tension stop becoming positive again inside the zone.
    void enter(const Crossing& crossing, const Extended& y, bool with_impact);
    /// The force ends, y just before.
    void leave(const Crossing& crossing, const Extended& y);
    /// Just after an event that is a corner of the acceleration and of peak signals that are not smooth there.
    void corner(const Crossing& crossing, const Extended& y, bool touching);

private:
    static constexpr int max_parts = 4;
    static constexpr int max_signals = 1 + model::max_peaks * max_parts;  ///< acceleration, and all parts

    [[nodiscard]] bool observes(std::uint32_t bit) const { return (mask_ & bit) != 0U; }
    [[nodiscard]] Peak& peak_of(const Signal& signal);
    /// Whether the largest modulus counts rather than the largest value.
    [[nodiscard]] bool has_modulus(const Signal& signal) const;
    void watch(Signal signal, Peak& peak, std::optional<SignalSample>& left, const Piece& piece,
               const MotionPoint& right);
    void offer_ends(double t, const Extended& y, bool touching);
    void open_contact(double t, const Extended& y, bool open);
    void close_contact(const Crossing& crossing, const Extended& y, bool open);

    const AugmentedSystem& system_;
    std::uint32_t mask_;
    Result& result_;
    Observables& out_;
    std::array<Signal, max_signals> signals_{};
    int watched_ = 0;
    /// Samples at the left end of the next piece, when they are the same as at the right end of the last one.
    std::array<std::optional<SignalSample>, max_signals> left_{};
    std::optional<SignalSample> force_left_;
    Peak x_max_, x_min_negative_, acceleration_, contact_force_, force_, impact_;
    std::array<Peak, model::max_peaks> peaks_{};
    Crossing opened_;
};

/// Jumps of the derivative lanes where the mass passes the surface with the velocity x' and the force of a stop that
/// acts on one side jumps by delta_i x': S = I + saltation delta_i e_v e_x^T (-1 entry, +1 exit, 0 nothing) and its
/// counterparts for the impulse and the stop work, all times the lanes' own overlap.
void saltate(const AugmentedSystem& system, Extended& y, int saltation);

}  // namespace percuss::flow
