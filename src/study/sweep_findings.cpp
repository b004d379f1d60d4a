#include "study/sweep_findings.hpp"

#include <algorithm>
#include <cmath>
#include <map>

namespace percuss::study {
namespace {

constexpr double out_of_line = 4.0;
constexpr double noticeable = 1e-2;
constexpr std::size_t steady_cycles = 12;

using Value = double SweepPoint::*;

/// A property along the settled points of a sweep.
class Profile {
public:
    Profile(std::span<const SweepPoint> points, Value value) : points_(points), value_(value) {
        double lowest = 0.0;
        double highest = 0.0;
        bool first = true;
        for (const SweepPoint& point : points) {
            if (!point.settled) { continue; }
            lowest = first ? point.*value : std::min(lowest, point.*value);
            highest = first ? point.*value : std::max(highest, point.*value);
            first = false;
        }
        range_ = highest - lowest;
    }

    /// Whether the step from point i to the next is a discontinuity as far as can be seen.
    [[nodiscard]] bool jumps_after(std::size_t i) const {
        const double own = step_after(i);
        const double before = i > 0 ? step_after(i - 1) : design::absent;
        const double after = step_after(i + 1);
        if (std::isnan(own) || (std::isnan(before) && std::isnan(after))) { return false; }
        const double beside = std::fmax(before, after);  // the one that is there, if only one is
        return own > noticeable * range_ && own > out_of_line * beside;
    }

private:
    /// Absent unless both points are there and settled.
    [[nodiscard]] double step_after(std::size_t i) const {
        if (i + 1 >= points_.size() || !points_[i].settled || !points_[i + 1].settled) { return design::absent; }
        return std::abs(points_[i + 1].*value_ - points_[i].*value_);
    }

    std::span<const SweepPoint> points_;
    Value value_;
    double range_ = 0.0;
};

bool other_contacts(const SweepPoint& a, const SweepPoint& b) {
    return a.settled && b.settled && a.contacts * b.period != b.contacts * a.period;
}

bool steady(std::span<const SweepPoint> cycles, bool striking) {
    return std::all_of(cycles.begin(), cycles.end(),
                       [&](const SweepPoint& cycle) { return (cycle.contacts > 0) == striking; });
}

double relative_difference(const SweepPoint& a, const SweepPoint& b) {
    const double size = std::max(a.amplitude, b.amplitude);
    const double moved = std::max(std::abs(a.x_max - b.x_max), std::abs(a.x_min - b.x_min));
    const double force = std::max(a.peak_force, b.peak_force);
    return std::max(size > 0.0 ? moved / size : 0.0, force > 0.0 ? std::abs(a.peak_force - b.peak_force) / force : 0.0);
}

}  // namespace

std::vector<SweepJump> find_jumps(std::span<const SweepPoint> points) {
    std::vector<SweepJump> jumps;
    const Profile amplitude(points, &SweepPoint::amplitude);
    const Profile peak_force(points, &SweepPoint::peak_force);
    for (std::size_t i = 0; i + 1 < points.size(); ++i) {
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
    for (std::size_t i = steady_cycles; i + steady_cycles <= cycles.size(); ++i) {
        const bool striking = cycles[i].contacts > 0;
        if ((cycles[i - 1].contacts > 0) == striking) { continue; }
        if (steady(cycles.subspan(i, steady_cycles), striking) &&
            steady(cycles.subspan(i - steady_cycles, steady_cycles), !striking)) {
            SweepJump jump{i - 1, i};
            jump.contacts = true;
            jumps.push_back(jump);
        }
    }
    return jumps;
}

SweepComparison compare(std::span<const SweepPoint> forward, std::span<const SweepPoint> backward,
                        double settling_tolerance) {
    SweepComparison comparison;
    comparison.tolerance = std::max(1e-5, 1e3 * settling_tolerance);
    std::map<double, const SweepPoint*> others;
    for (const SweepPoint& point : backward) { others.emplace(point.omega, &point); }
    bool in_range = false;
    for (const SweepPoint& one : forward) {
        const auto found = others.find(one.omega);
        if (found == others.end()) { continue; }
        const SweepPoint& other = *found->second;
        if (!one.settled && !other.settled) {
            ++comparison.unsettled;
            in_range = false;
            continue;
        }
        ++comparison.compared;
        const double difference = relative_difference(one, other);
        const bool same = one.settled && other.settled && one.period == other.period &&
                          one.contacts == other.contacts && difference <= comparison.tolerance;
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

}  // namespace percuss::study
