#pragma once
/// \file
/// One point of a branch of periodic motions, looked at with the hybrid flow: what the motion does, whether it is
/// stable, and whether its contacts are the ones its form assumes.

#include "boundary/boundary.hpp"
#include "flow/parameter_family.hpp"
#include "orbit/motion.hpp"

#include <cstdint>
#include <vector>

namespace percuss::branch {

/// Everything nondimensional.
struct Point {
    double parameter = 0.0;
    double omega = 0.0;
    orbit::Motion motion;
    numerics::SmallComplexVector multipliers;  ///< of the whole period, largest modulus first
    double x_max = 0.0;
    double x_min = 0.0;
    double peak_force = 0.0;
    std::vector<flow::Contact> contacts;  ///< over one period from a strobe phase in flight
    flow::State state{};                  ///< at that strobe phase
    double phase = 0.0;                   ///< that strobe phase
    /// Multipliers that boundaries are told by: those of the half-cycle map where the motion is mirrored.
    numerics::SmallComplexVector map_multipliers;
    /// How many of them lie outside the unit circle: real ones beyond +1, beyond -1, and complex pairs.
    int beyond_plus = 0;
    int beyond_minus = 0;
    int pairs_beyond = 0;
    /// The map keeps volumes of states: no damping at work. Its multipliers come in pairs mu, 1/mu; a pair of complex
    /// ones stays on the unit circle, and rounding decides on which side of it.
    bool neutral = false;

    [[nodiscard]] double amplitude() const { return 0.5 * (x_max - x_min); }
    [[nodiscard]] double max_multiplier() const { return std::abs(multipliers[0]); }
    [[nodiscard]] bool stable() const { return !neutral && max_multiplier() < 1.0; }
    [[nodiscard]] int unstable_dimension() const { return beyond_plus + beyond_minus + 2 * pairs_beyond; }
};

/// What came of looking: the point is complete when `ok`; when the motion does not close, its contacts are those that
/// the hybrid flow met, for a motion of free form those that the stop taken away would have had.
struct Look {
    enum class Status : std::uint8_t { flow_failed, not_closed, ok };
    Status status = Status::flow_failed;
    Point point;
    [[nodiscard]] bool ok() const { return status == Status::ok; }
};

/// Follows the motion for one period. A motion of free form is followed without the stop, so that it can be looked at
/// beyond grazing; its contacts then come from the hybrid flow. A sequence does not close (1e-6) when its contacts are
/// other than assumed.
Look look(const flow::ParameterFamily& family, const orbit::Motion& motion, double parameter);

/// Whether two points of one parameter are the same motion: extremes, peak force and largest multiplier agree to 1e-6,
/// the multiplier to 1e-4.
bool same_motion(const Point& a, const Point& b, double size);

/// State at phase 0 of the drive.
flow::State state_at_zero(const flow::System& system, const Point& point);

}  // namespace percuss::branch
