#include "verbs/explore/survey.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace percuss::verbs {

namespace {

void count(std::vector<std::pair<std::string, std::int64_t>>& counts, const std::string& name) {
    const auto place = std::lower_bound(counts.begin(), counts.end(), name,
                                        [](const auto& entry, const std::string& n) { return entry.first < n; });
    if (place != counts.end() && place->first == name) {
        ++place->second;
    } else {
        counts.insert(place, {name, 1});
    }
}

double distance_to(const design::Limit& limit, double value) {
    const double scale = limit.bound == 0.0 ? 1.0 : std::abs(limit.bound);
    return (limit.upper ? limit.bound - value : value - limit.bound) / scale;
}

/// The least distance; a limit whose quantity is absent is not met.
double least(const std::vector<double>& distances) {
    double least = std::numeric_limits<double>::infinity();
    for (const double distance : distances) {
        least = std::isnan(distance) ? -std::numeric_limits<double>::infinity() : std::min(least, distance);
    }
    return least;
}

}  // namespace

Survey::Survey(const design::Problem& problem, const TableLayout& layout)
    : problem_(problem),
      layout_(layout),
      limits_(problem.limits.size()) {}

std::int64_t Survey::with_status(design::EvaluationStatus status) const {
    for (const auto& [name, times] : statuses_) {
        if (name == design::to_string(status)) { return times; }
    }
    return 0;
}

void Survey::add(std::int64_t number, const results::Row& row) {
    ++rows_;
    count(statuses_, layout_.status(row));
    if (layout_.status(row) != design::to_string(design::EvaluationStatus::ok)) { return; }
    count(edge_kinds_, layout_.edge_kind(row));

    std::vector<double> distances;
    for (const design::Limit& limit : problem_.limits) {
        distances.push_back(distance_to(limit, layout_.value(row, limit.quantity)));
    }
    const auto is_violated = [](double distance) { return !(distance >= 0.0); };
    const auto violations = std::count_if(distances.begin(), distances.end(), is_violated);
    for (std::size_t i = 0; i < distances.size(); ++i) {
        if (!is_violated(distances[i])) { continue; }
        ++limits_[i].violated;
        limits_[i].alone += violations == 1 ? 1 : 0;
    }
    // A cause beside ok: its uniqueness could not be settled.
    if (!layout_.cause(row).empty()) { return; }
    if (violations > 0) {
        if (!nearest_.exists() || least(distances) > least(nearest_.distances)) {
            nearest_ = {number, row, std::move(distances)};
        }
        return;
    }
    ++feasible_;
    if (problem_.objectives.empty()) { return; }
    const design::Objective& objective = problem_.objectives.front();
    const double sign = objective.maximise ? 1.0 : -1.0;
    const double value = sign * layout_.value(row, objective.quantity);
    if (std::isnan(value)) { return; }
    if (!best_.exists() || value > sign * layout_.value(best_.cells, objective.quantity)) {
        best_ = {number, row, std::move(distances)};
    }
}

}  // namespace percuss::verbs
