#pragma once
/// \file
/// Scalar signals along the motion whose turning points matter: the overlap with the stop, the force on the stop, the
/// acceleration, and the peak signals of the actuator.

#include "flow/augmented_system.hpp"
#include "flow/bracketed_root.hpp"
#include "flow/stepper.hpp"

#include <array>
#include <cstdint>
#include <limits>

namespace percuss::flow {

enum class SignalKind : std::uint8_t { overlap, stop_force, acceleration, peak };

struct Signal {
    SignalKind kind = SignalKind::overlap;
    int peak = 0;  ///< which peak signal of the system, and which of its parts
    int part = 0;
};

/// A signal at one point: value and slope with respect to t.
struct SignalSample {
    double value = 0.0;
    double slope = 0.0;
};

/// A point of the motion and the direction in which it goes, per unit of t.
struct MotionPoint {
    double t = 0.0;
    State values{};
    bool touching = false;
    Direction along;
};

/// A smooth stretch of motion inside the last step of a stepper.
struct Piece {
    Stepper& stepper;
    double left = 0.0;
    double right = 0.0;
    State left_values{};
    State right_values{};
    bool touching = false;
};

/// Where a signal turns.
struct TurningPoint {
    double t = 0.0;
    bool maximum = false;
};

/// At most two turning points of a signal in one piece, in the order in which they are passed.
struct TurningPoints {
    std::array<TurningPoint, 2> points{};
    int count = 0;
    [[nodiscard]] const TurningPoint* begin() const { return points.data(); }
    [[nodiscard]] const TurningPoint* end() const { return points.data() + count; }
};

/// Only turning points that could matter are polished: all of them, or maxima that may exceed a level, or those that
/// may exceed it in modulus.
struct Wanted {
    enum class Kind : std::uint8_t { all, maxima, largest_modulus };
    Kind kind = Kind::all;
    double level = -std::numeric_limits<double>::infinity();
};

MotionPoint motion_point(const AugmentedSystem& system, double t, const State& values, bool touching);

SignalSample sample(const AugmentedSystem& system, Signal signal, const MotionPoint& point);

/// The overlap with the stop needs no right-hand side.
SignalSample overlap_sample(const AugmentedSystem& system, const State& values);

/// Value of a signal and its derivatives along the directions at fixed t.
Sensitive sensitive(const AugmentedSystem& system, Signal signal, double t, const Extended& y, bool touching);

/// Turning points of a signal inside a piece (its left end excluded, its right end included), located to the accuracy
/// of the stepper. A pair that the cubic through both ends does not show is missed; steps are short enough to make such
/// pairs shallower than the tolerance of the method.
TurningPoints turning_points(const AugmentedSystem& system, Signal signal, const Piece& piece, const SignalSample& left,
                             const SignalSample& right, const Wanted& wanted);

}  // namespace percuss::flow
