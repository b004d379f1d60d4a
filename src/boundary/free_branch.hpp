#pragma once
/// \file
/// The symmetric non-impacting orbit followed in the drive frequency, over half a cycle at a time, watching its
/// distance from the stop and its multipliers.

#include "boundary/boundary.hpp"
#include "numerics/arclength.hpp"

#include <memory>

namespace percuss::boundary {

/// A point of the branch.
struct FreePoint {
    flow::State state{};  ///< at phase 0
    double omega = 0.0;
    double clearance = 0.0;        ///< largest displacement minus gap; negative: the stop is out of reach
    double clearance_slope = 0.0;  ///< along the branch, per unit of arclength
    double omega_slope = 0.0;      ///< of the tangent, scaled frequency
    double arclength = 0.0;        ///< along the branch from its start, scaled
    /// Of the half-cycle map: modulus of the largest multiplier, and which boundary lies where it crosses 1.
    double radius = 0.0;
    Kind nearest = Kind::none;
    /// Within the accuracy of a scout a radius of 1 is neutral (an undamped system), which is no loss of stability.
    [[nodiscard]] bool stable() const { return radius < 1.0 + 1e-5; }
};

class FreeBranch {
public:
    /// The map of the free system that a branch is followed with: half a cycle and the mirror image where it is
    /// symmetric, else a whole cycle.
    static orbit::ReturnMap map_of(const flow::System& system);

    explicit FreeBranch(const flow::System& system);

    /// Finds the orbit at `omega` from rest and sets out towards lower frequencies. False if there is no convergence.
    bool start(double omega);
    /// One accepted step along the branch; false when the step length collapses or the flow fails.
    bool advance();
    /// Gives the last step up and halves it; false when it cannot.
    bool retreat();
    [[nodiscard]] const FreePoint& current() const { return current_; }
    [[nodiscard]] const FreePoint& previous() const { return previous_; }
    [[nodiscard]] double step() const { return walker_.step(); }
    void limit_step(double largest) { walker_.limit_step(largest); }

private:
    bool evaluate(const numerics::Vector& u, numerics::Vector& f, numerics::Matrix& jacobian);
    [[nodiscard]] FreePoint describe() const;
    void set_measure(double size);

    flow::System system_;
    [[nodiscard]] numerics::Vector to_scaled(const flow::State& y, double omega) const;
    [[nodiscard]] flow::State to_state(const numerics::Vector& u) const;

    double scale_;         ///< frequencies are divided by this
    flow::State origin_;   ///< rest: states are counted from here
    flow::State measure_;  ///< and states by these, see set_measure()
    orbit::Image image_;
    double image_omega_ = 0.0;
    numerics::ArclengthWalker walker_;
    FreePoint current_, previous_;
};

}  // namespace percuss::boundary
