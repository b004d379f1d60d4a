#pragma once
/// \file
/// Strobed states of a motion as a sample of the set it moves on.

#include "flow/flow.hpp"

#include <vector>

namespace percuss::attractor {

/// Other strobed states are taken to be of the same set when their distances to the nearest point of the cloud are
/// distributed as those between points of the cloud: the median at most twice, the 90 % quantile at most three times as
/// large, distances below 1e-3 of the scale counting as that. (A stable motion apart from the set keeps a distance from
/// all of it.)
class Cloud {
public:
    Cloud() = default;
    /// Distances are measured in `scale`, one length per state.
    Cloud(std::vector<flow::State> points, const flow::State& scale, int states);
    [[nodiscard]] bool holds(const std::vector<flow::State>& others) const;

private:
    struct Quantiles {
        double median = 0.0;
        double ninety = 0.0;
    };
    /// Of the distances of some of the others, evenly spread, to the nearest point that is not the same one.
    [[nodiscard]] Quantiles distances(const std::vector<flow::State>& others, bool own) const;

    std::vector<flow::State> points_;
    flow::State scale_{};
    int states_ = 0;
    Quantiles own_;
};

}  // namespace percuss::attractor
