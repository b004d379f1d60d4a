#include "attractor/cloud.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

namespace percuss::attractor {
namespace {

/// Points looked at of a set of others: enough for quantiles good to a third.
constexpr std::size_t looked_at = 128;
/// The 90 % quantile rests on a tenth of the distances and scatters more than the median: it is allowed more.
constexpr double same_median = 2.0;
constexpr double same_ninety = 3.0;
/// In units of the scale: a motion on a curve fills it so densely that one still settling on it would seem apart.
constexpr double resolution = 1e-3;

double squared_distance(const flow::State& a, const flow::State& b, const flow::State& scale, std::size_t states) {
    double sum = 0.0;
    for (std::size_t k = 0; k < states; ++k) {
        const double d = (a[k] - b[k]) / scale[k];
        sum += d * d;
    }
    return sum;
}

}  // namespace

Cloud::Cloud(std::vector<flow::State> points, const flow::State& scale, int states)
    : points_(std::move(points)),
      scale_(scale),
      states_(states),
      own_(distances(points_, true)) {}

Cloud::Quantiles Cloud::distances(const std::vector<flow::State>& others, bool own) const {
    std::vector<double> nearest;
    const std::size_t count = std::min(looked_at, others.size());
    for (std::size_t k = 0; k < count; ++k) {
        // Evenly over the whole run: its beginning may still be settling.
        const std::size_t i = k * others.size() / count;
        double smallest = std::numeric_limits<double>::infinity();
        for (std::size_t j = 0; j < points_.size(); ++j) {
            // A point of the cloud is at no distance from itself: the nearest other one counts.
            if (own && i == j) { continue; }
            smallest =
                std::min(smallest, squared_distance(others[i], points_[j], scale_, static_cast<std::size_t>(states_)));
        }
        nearest.push_back(std::sqrt(smallest));
    }
    if (nearest.empty()) { return {}; }
    std::sort(nearest.begin(), nearest.end());
    return {nearest[nearest.size() / 2], nearest[nearest.size() * 9 / 10]};
}

bool Cloud::holds(const std::vector<flow::State>& others) const {
    if (points_.empty() || others.empty()) { return false; }
    const Quantiles theirs = distances(others, false);
    return theirs.median <= same_median * std::max(own_.median, resolution) &&
           theirs.ninety <= same_ninety * std::max(own_.ninety, resolution);
}

}  // namespace percuss::attractor
