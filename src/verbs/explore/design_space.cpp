#include "verbs/explore/design_space.hpp"

#include "problem/problem_error.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>

namespace percuss::verbs {

namespace {

using design::DesignVariable;

/// One variable at one coordinate of a point.
struct Place {
    double value = 0.0;
    double input = 0.0;
    double slope = std::numeric_limits<double>::quiet_NaN();
};

double levels_of(const DesignVariable& variable) { return variable.upper - variable.lower + 1.0; }

Place continuous_place(const DesignVariable& variable, double unit) {
    const double span = variable.upper - variable.lower;
    if (!variable.logarithmic) { return {std::lerp(variable.lower, variable.upper, unit), unit, span}; }
    const double ratio = variable.upper / variable.lower;
    const double value = std::clamp(variable.lower * std::pow(ratio, unit), variable.lower, variable.upper);
    return {value, unit, value * std::log(ratio)};
}

/// Every value has the same share of [0, 1].
Place equal_share_place(const DesignVariable& variable, double unit) {
    const double levels = levels_of(variable);
    const double level = std::min(std::floor(unit * levels), levels - 1.0);
    return {variable.lower + level, (level + 0.5) / levels};
}

/// The value k has the share of k - 1/2 .. k + 1/2 on the logarithmic axis.
Place log_share_place(const DesignVariable& variable, double unit) {
    const double low = variable.lower - 0.5;
    const double log_ratio = std::log((variable.upper + 0.5) / low);
    const double value = std::clamp(std::round(low * std::exp(unit * log_ratio)), variable.lower, variable.upper);
    const auto share_below = [&](double x) { return std::log(x / low) / log_ratio; };
    return {value, std::clamp(0.5 * (share_below(value - 0.5) + share_below(value + 0.5)), 0.0, 1.0)};
}

numerics::SamplingRequest request_of(const std::vector<DesignVariable>& variables, const ExploreOptions& options,
                                     std::uint64_t seed) {
    numerics::SamplingRequest request;
    for (const DesignVariable& variable : variables) {
        request.levels.push_back(variable.integer ? static_cast<int>(levels_of(variable)) : 0);
    }
    request.samples = static_cast<std::uint64_t>(options.samples);
    request.seed = seed;
    return request;
}

}  // namespace

const numerics::Sampling& sampling_of(const std::string& name) {
    for (const numerics::Sampling& sampling : numerics::samplings()) {
        if (sampling.name == name) { return sampling; }
    }
    throw std::out_of_range("explore.sampling = " + name + " is none of the samplings");
}

DesignSpace::DesignSpace(const std::vector<DesignVariable>& variables, const ExploreOptions& options,
                         std::uint64_t seed)
    : variables_(variables) {
    if (variables.empty()) {
        throw problem::ProblemError("design.variable is missing: explore needs at least one, as in "
                                    "'stop.gap in 0.2 mm .. 1.6 mm'");
    }
    const numerics::Sampling& sampling = sampling_of(options.sampling);
    in_levels_ = sampling.takes_levels;
    try {
        points_ = sampling.make(request_of(variables, options, seed));
    } catch (const std::invalid_argument& error) {
        throw problem::ProblemError("explore.sampling = " + options.sampling + ": explore." + error.what());
    }
    rows_ = static_cast<std::int64_t>(std::min(points_->size(), static_cast<std::uint64_t>(options.samples)));
}

std::vector<DesignPoint> DesignSpace::points(std::int64_t first, std::int64_t count) const {
    const numerics::Matrix units = points_->rows(static_cast<std::uint64_t>(first), count);
    std::vector<DesignPoint> points(static_cast<std::size_t>(count));
    for (std::size_t i = 0; i < points.size(); ++i) {
        for (std::size_t j = 0; j < variables_.size(); ++j) {
            const DesignVariable& variable = variables_[j];
            const double unit = units(static_cast<Eigen::Index>(i), static_cast<Eigen::Index>(j));
            const bool equal_shares = in_levels_ || !variable.logarithmic;
            const Place place = !variable.integer ? continuous_place(variable, unit)
                              : equal_shares      ? equal_share_place(variable, unit)
                                                  : log_share_place(variable, unit);
            points[i].values.push_back(place.value);
            points[i].inputs.push_back(place.input);
            points[i].slopes.push_back(place.slope);
        }
    }
    return points;
}

}  // namespace percuss::verbs
