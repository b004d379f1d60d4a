#include "flow/signals.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>

namespace percuss::flow {
namespace {

constexpr std::size_t at(int i) { return static_cast<std::size_t>(i); }

/// The states of each column, values first; integrals follow them in memory and are not looked at.
Columns state_columns(const AugmentedSystem& system, const Extended& y) {
    Columns columns{};
    for (int c = 0; c < system.columns(); ++c) { columns[at(c)] = y.data() + c * system.block(); }
    return columns;
}

/// The cubic through values and slopes at both ends, on s in [0, 1].
class Cubic {
public:
    Cubic(double h, const SignalSample& a, const SignalSample& b)
        : value_(a.value),
          slope_(a.slope * h),
          c2_(3.0 * (b.value - a.value) - h * (2.0 * a.slope + b.slope)),
          c3_(h * (a.slope + b.slope) - 2.0 * (b.value - a.value)) {}

    [[nodiscard]] double value(double s) const { return value_ + s * (slope_ + s * (c2_ + s * c3_)); }
    [[nodiscard]] double slope(double s) const { return slope_ + s * (2.0 * c2_ + 3.0 * s * c3_); }
    /// Where the slope is extreme; outside [0, 1] or NaN when it is monotone inside.
    [[nodiscard]] double inflection() const { return -c2_ / (3.0 * c3_); }
    /// Value at the turning point between two places where the slope has opposite signs.
    [[nodiscard]] double value_at_turn(double low, double high) const {
        // To 2^-12 of the stretch. The value is flat there, so it is far better than the 2 % that may_matter() allows
        // for.
        for (int i = 0; i < 12; ++i) {
            const double middle = 0.5 * (low + high);
            (opposite_signs(slope(low), slope(middle)) ? high : low) = middle;
        }
        return value(0.5 * (low + high));
    }

private:
    double value_, slope_, c2_, c3_;
};

/// Whether a turning point estimated at `value`, a maximum or not, is worth polishing. The estimate may fall short by
/// its whole height above the ends and by another 2 %.
bool may_matter(const Wanted& wanted, bool maximum, double value, double left, double right) {
    if (wanted.kind == Wanted::Kind::all) { return true; }
    if (wanted.kind == Wanted::Kind::maxima) {
        return maximum && value + 0.02 * std::abs(value) + std::abs(value - std::max(left, right)) > wanted.level;
    }
    const double highest = std::max(std::abs(left), std::abs(right));
    const double height = std::abs(value);
    return maximum == (value > 0.0) && 1.02 * height + std::abs(height - highest) > wanted.level;
}

}  // namespace

MotionPoint motion_point(const AugmentedSystem& system, double t, const State& values, bool touching) {
    MotionPoint point{t, values, touching, {}};
    system.state_rate(t, values.data(), touching, point.along.state.data());
    point.along.phase = 1.0;
    return point;
}

SignalSample overlap_sample(const AugmentedSystem& system, const State& values) {
    return {values[0], values[1] / system.omega()};
}

SignalSample sample(const AugmentedSystem& system, Signal signal, const MotionPoint& point) {
    const State& rate = point.along.state;
    switch (signal.kind) {
        case SignalKind::overlap: return {point.values[0], rate[0]};
        case SignalKind::stop_force:
            return {system.stop_force(point.values), system.stiffness() * rate[0] + system.damping() * rate[1]};
        case SignalKind::acceleration: {
            State second{};
            system.rhs().rate_derivative(system.parameters(), system.phase(point.t), system.state(point.values),
                                         point.touching, point.along, second);
            return {system.omega() * rate[1], system.omega() * second[1]};
        }
        case SignalKind::peak: break;
    }
    SignalSample result;
    result.value = system.rhs().peak(signal.peak, signal.part, system.parameters(), system.phase(point.t),
                                     system.state(point.values), {&point.along, 1}, &result.slope);
    return result;
}

Sensitive sensitive(const AugmentedSystem& system, Signal signal, double t, const Extended& y, bool touching) {
    Sensitive result;
    const State values = system.values(y);
    switch (signal.kind) {
        case SignalKind::overlap:
            result.value = values[0];
            for (int lane = 0; lane < system.lanes(); ++lane) { result.d[at(lane)] = system.entry(y, 1 + lane, 0); }
            return result;
        case SignalKind::stop_force:
            result.value = system.stop_force(values);
            for (int lane = 0; lane < system.lanes(); ++lane) {
                result.d[at(lane)] =
                    system.stiffness_d(lane) * values[0] + system.stiffness() * system.entry(y, 1 + lane, 0) +
                    system.damping_d(lane) * values[1] + system.damping() * system.entry(y, 1 + lane, 1);
            }
            return result;
        case SignalKind::acceleration: {
            State rate{};
            std::array<State, at(max_lanes)> rate_d{};
            system.rhs().rates(system.parameters(), system.phase(t), system.state(values), touching,
                               system.directions(state_columns(system, y)), rate, rate_d.data());
            result.value = system.omega() * rate[1];
            for (int lane = 0; lane < system.lanes(); ++lane) {
                result.d[at(lane)] = system.omega() * rate_d[at(lane)][1] + system.omega_d(lane) * rate[1];
            }
            return result;
        }
        case SignalKind::peak: break;
    }
    result.value =
        system.rhs().peak(signal.peak, signal.part, system.parameters(), system.phase(t), system.state(values),
                          system.directions(state_columns(system, y)), result.d.data());
    return result;
}

TurningPoints turning_points(const AugmentedSystem& system, Signal signal, const Piece& piece, const SignalSample& left,
                             const SignalSample& right, const Wanted& wanted) {
    TurningPoints found;
    const double h = piece.right - piece.left;
    const Cubic cubic(h, left, right);
    const auto end_at = [&](double t, const State& values) -> RootEnd {
        const MotionPoint point = motion_point(system, t, values, piece.touching);
        RootEnd end{t, {sample(system, signal, point).slope}};
        // The slope of the overlap is x'/omega, and the derivative of that is known: Newton instead of the secant.
        if (signal.kind == SignalKind::overlap) { end.sample.slope = point.along.state[1] / system.omega(); }
        return end;
    };
    const auto slope_at = [&](double t) -> RootSample {
        State values{};
        piece.stepper.values(t, values);
        return end_at(t, values).sample;
    };
    const auto visit = [&](const RootEnd& a, const RootEnd& b) {
        // Per unit of t the slope falls through zero at a maximum; run backwards in t it rises.
        const bool maximum = (h > 0.0) == (a.sample.value > 0.0);
        const double value = cubic.value_at_turn((a.at - piece.left) / h, (b.at - piece.left) / h);
        if (may_matter(wanted, maximum, value, left.value, right.value)) {
            const double t = b.sample.value == 0.0 ? b.at : bracketed_root(a, b, slope_at);
            found.points[at(found.count++)] = {t, maximum};
        }
    };

    if (left.slope == 0.0 || h == 0.0) {
        return found;  // turned at the end of the previous piece, or stands still
    }
    // An odd number of turning points, taken for one. A slope of zero at the right end counts here, and at the left end
    // of the next piece no more, so that none is seen twice.
    if (opposite_signs(left.slope, right.slope) || right.slope == 0.0) {
        visit(end_at(piece.left, piece.left_values), end_at(piece.right, piece.right_values));
        return found;
    }
    // Slopes of one sign at both ends: none, or a pair. The cubic says where the slope comes nearest to the other sign;
    // the slope of the motion itself there decides.
    const double s = cubic.inflection();
    if (s > 0.0 && s < 1.0 && opposite_signs(cubic.slope(s) / h, left.slope)) {
        const double t = piece.left + s * h;
        const RootEnd middle{t, slope_at(t)};
        if (opposite_signs(middle.sample.value, left.slope)) {
            visit(end_at(piece.left, piece.left_values), middle);
            visit(middle, end_at(piece.right, piece.right_values));
        }
    }
    return found;
}

}  // namespace percuss::flow
