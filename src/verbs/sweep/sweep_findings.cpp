#include "verbs/sweep/sweep_findings.hpp"

#include <algorithm>
#include <cmath>
#include <map>

namespace percuss::verbs {
namespace {

/// Times the larger of the steps beside it. Measured on the default step sweeps of wu2022-nondimensional and
/// soft-impact, among steps over 1 % of the range: within one settled motion at most 1.4, where the motion jumps 16 to
/// 54 in the peak force and 2 to 58 in the amplitude.
constexpr double out_of_line = 4.0;
/// Of the range of the whole sweep: where the motion hardly changes, rounding and what settling leaves are out of line
/// too.
constexpr double noticeable = 1e-2;
/// A motion of period up to 12 that strikes does so at least once in so many cycles: a shorter pause may be part of it.
constexpr std::size_t quiet_cycles = 12;

using Value = double SweepPoint::*;

/// A property along the points of a sweep.
class Profile {
public:
    Profile(std::span<const SweepPoint> points, Value value) : points_(points), value_(value) {
        const auto [lowest, highest] =
            std::minmax_element(points.begin(), points.end(),
                                [&](const SweepPoint& a, const SweepPoint& b) { return a.*value < b.*value; });
        range_ = points.empty() ? 0.0 : *highest.*value - *lowest.*value;
    }

    /// Whether the step from point i to the next is a discontinuity as far as can be seen.
    [[nodiscard]] bool jumps_after(std::size_t i) const {
        const double own = step_after(i);
        const double before = i > 0 ? step_after(i - 1) : design::absent;
        const double after = step_after(i + 1);
        if (std::isnan(own) || (std::isnan(before) && std::isnan(after))) { return false; }
        // Compared with the larger neighbour, a steep flank is not taken for a jump: steps along it are alike.
        const double beside = std::fmax(before, after);  // the one that is there, if only one is
        return own > noticeable * range_ && own > out_of_line * beside;
    }

private:
    /// Absent at the end.
    [[nodiscard]] double step_after(std::size_t i) const {
        return i + 1 < points_.size() ? std::abs(points_[i + 1].*value_ - points_[i].*value_) : design::absent;
    }

    std::span<const SweepPoint> points_;
    Value value_;
    double range_ = 0.0;
};

bool other_contacts(const SweepPoint& a, const SweepPoint& b) {
    // Contacts per cycle compared without dividing.
    return a.settled && b.settled && a.contacts * b.period != b.contacts * a.period;
}

/// The largest amplitude and peak force, against which differences are measured.
struct Size {
    double amplitude = 0.0;
    double force = 0.0;

    void include(std::span<const SweepPoint> points) {
        for (const SweepPoint& point : points) {
            amplitude = std::fmax(amplitude, point.amplitude);  // NaN, of a lost motion, does not count
            force = std::fmax(force, point.peak_force);
        }
    }
    [[nodiscard]] double difference(const SweepPoint& a, const SweepPoint& b) const {
        const double moved = std::max(std::abs(a.x_max - b.x_max), std::abs(a.x_min - b.x_min));
        const double harder = std::abs(a.peak_force - b.peak_force);
        return std::max(amplitude > 0.0 ? moved / amplitude : 0.0, force > 0.0 ? harder / force : 0.0);
    }
};

}  // namespace

std::vector<SweepJump> find_jumps(std::span<const SweepPoint> points) {
    std::vector<SweepJump> jumps;
    const Profile amplitude(points, &SweepPoint::amplitude);
    const Profile peak_force(points, &SweepPoint::peak_force);
    for (std::size_t i = 0; i + 1 < points.size(); ++i) {
        if (!points[i].settled && !points[i + 1].settled) { continue; }
        SweepJump jump{i, i + 1};
        jump.period = points[i].period != points[i + 1].period;
        jump.contacts = other_contacts(points[i], points[i + 1]);
        jump.amplitude = amplitude.jumps_after(i);
        jump.peak_force = peak_force.jumps_after(i);
        if (jump.period || jump.contacts || jump.discontinuous()) { jumps.push_back(jump); }
    }
    return jumps;
}

std::vector<SweepJump> find_chirp_jumps(std::span<const SweepPoint> cycles) {
    std::vector<SweepJump> jumps;
    const auto add = [&](std::size_t after) {
        SweepJump jump{after - 1, after};
        jump.contacts = true;
        jumps.push_back(jump);
    };
    std::size_t quiet_since = 0;
    for (std::size_t i = 0; i <= cycles.size(); ++i) {
        if (i < cycles.size() && !(cycles[i].peak_force > 0.0)) { continue; }
        if (i - quiet_since >= quiet_cycles) {  // [quiet_since, i) is a quiet stretch
            if (quiet_since > 0) { add(quiet_since); }
            if (i < cycles.size()) { add(i); }
        }
        quiet_since = i + 1;
    }
    return jumps;
}

SweepComparison compare(std::span<const SweepPoint> forward, std::span<const SweepPoint> backward,
                        double settling_tolerance) {
    SweepComparison comparison;
    // Settling bounds the strobed state; extrema and above all the force of a stiff stop move by many times as much.
    comparison.tolerance = std::max(1e-5, 1e3 * settling_tolerance);
    std::map<double, const SweepPoint*> others;
    for (const SweepPoint& point : backward) { others.emplace(point.omega, &point); }
    Size size;
    size.include(forward);
    size.include(backward);
    bool in_range = false;
    for (const SweepPoint& one : forward) {
        const auto found = others.find(one.omega);
        if (found == others.end()) { continue; }
        const SweepPoint& other = *found->second;
        if (!one.settled || !other.settled) {
            ++comparison.unsettled;
            in_range = false;
            continue;
        }
        ++comparison.compared;
        const double difference = size.difference(one, other);
        const bool same =
            one.period == other.period && one.contacts == other.contacts && difference <= comparison.tolerance;
        if (same) {
            comparison.largest = std::max(comparison.largest, difference);
        } else {
            ++comparison.different;
            if (!in_range) { comparison.ranges.emplace_back(one.omega, one.omega); }
            comparison.ranges.back().second = one.omega;
        }
        in_range = !same;
    }
    return comparison;
}

}  // namespace percuss::verbs
