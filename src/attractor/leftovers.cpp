#include "attractor/leftovers.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace percuss::attractor {
namespace {

/// A long period is believed only when the motion recurs as nearly as this, in units of the box.
constexpr double long_recurrence = 1e-3;
constexpr double same_set = 2.0;
/// Shorter histories say little about where a motion goes.
constexpr std::size_t shortest_cloud = 32;

using Cloud = std::vector<flow::State>;

double squared_distance(const flow::State& a, const flow::State& b, const flow::State& scale, int states) {
    double sum = 0.0;
    for (std::size_t k = 0; k < static_cast<std::size_t>(states); ++k) {
        const double d = (a[k] - b[k]) / scale[k];
        sum += d * d;
    }
    return sum;
}

/// Median over the points of `from` of the distance to the nearest point of `to`; a point is not its own neighbour.
double median_distance(const Cloud& from, const Cloud& to, const flow::State& scale, int states) {
    const bool own = &from == &to;
    std::vector<double> nearest;
    for (std::size_t i = 0; i < from.size(); ++i) {
        double smallest = std::numeric_limits<double>::infinity();
        for (std::size_t j = 0; j < to.size(); ++j) {
            if (own && i == j) { continue; }
            smallest = std::min(smallest, squared_distance(from[i], to[j], scale, states));
        }
        nearest.push_back(std::sqrt(smallest));
    }
    const auto middle = nearest.begin() + static_cast<std::ptrdiff_t>(nearest.size() / 2);
    std::nth_element(nearest.begin(), middle, nearest.end());
    return *middle;
}

}  // namespace

LeftoverJudge::Verdict LeftoverJudge::judge(const Cloud& history) {
    if (const auto orbit = settling_on(history)) { return {*orbit, -1}; }
    if (const auto orbit = long_period(history)) { return {*orbit, -1}; }
    if (const auto motion = met_before(history)) { return {-1, *motion}; }
    return follow_on(history);
}

/// The whole of the last period, and three cycles at least, inside a trap and contracting.
std::optional<int> LeftoverJudge::settling_on(const Cloud& history) const {
    std::vector<const Trap*> traps;
    for (const auto& orbit : known_) { traps.push_back(&orbit->trap); }
    Watch watch;
    for (const flow::State& z : history) {
        if (const auto trap = watch.see(z, traps)) { return trap; }
    }
    return std::nullopt;
}

std::optional<int> LeftoverJudge::long_period(const Cloud& history) {
    const Recurrence r = recurrence(history, systems_.exact.states(), scale_, 1, options_.longest_period);
    if (r.period == 0 || !(r.distance < long_recurrence)) { return std::nullopt; }
    const auto orbit = stable_orbit(systems_.exact, history.back(), r.period);
    if (!orbit) { return std::nullopt; }
    auto learnt = make_known(systems_, *orbit, scale_);
    if (!find_known(known_, *learnt)) { known_.push_back(std::move(learnt)); }
    return settling_on(history);
}

std::optional<int> LeftoverJudge::met_before(const Cloud& history) const {
    if (history.size() < shortest_cloud) { return std::nullopt; }
    const int states = systems_.exact.states();
    const double own = median_distance(history, history, scale_, states);
    for (std::size_t i = 0; i < clouds_.size(); ++i) {
        const Cloud& other = clouds_[i];
        if (median_distance(history, other, scale_, states) <= same_set * own &&
            median_distance(other, history, scale_, states) <=
                same_set * median_distance(other, other, scale_, states)) {
            return static_cast<int>(i);
        }
    }
    return std::nullopt;
}

LeftoverJudge::Verdict LeftoverJudge::follow_on(const Cloud& history) {
    if (static_cast<int>(aperiodic_.size()) >= options_.most_aperiodic || history.size() < shortest_cloud) {
        return {};
    }
    std::vector<const Trap*> traps;
    for (const auto& orbit : known_) { traps.push_back(&orbit->trap); }
    Watch watch;
    std::optional<int> captured;
    const auto leave = [&](const flow::State& z) {
        captured = watch.see(z, traps);
        return captured.has_value();
    };
    const Wander seen = wander(systems_.exact, history.back(), options_.exponent, leave);
    if (captured) { return {*captured, -1}; }
    const auto motion = measure(seen);
    if (!motion) { return {}; }
    aperiodic_.push_back(*motion);
    clouds_.push_back(history);
    return {-1, static_cast<int>(aperiodic_.size()) - 1};
}

}  // namespace percuss::attractor
