#include "design/band_quantities.hpp"

#include "design/band.hpp"

#include <algorithm>
#include <numbers>

namespace percuss::design {
namespace {

/// Where the free motion begins to graze, above the operating point.
struct Edge {
    double omega = absent;
    std::vector<double> d_omega;
};

std::vector<flow::ParameterVector> directions_of(std::span<const KeyDirection> keys) {
    std::vector<flow::ParameterVector> directions;
    for (const KeyDirection& key : keys) { directions.push_back(key.parameters); }
    return directions;
}

/// The edge of the operating point; at a given frequency there is none yet and it is searched for.
Edge edge_of(const BandRequest& r) {
    if (r.operation.edge) { return {r.operation.edge->omega, r.operation.edge->d_omega}; }
    boundary::FreeBranch branch(r.operation.scout);
    const boundary::Edge edge = boundary::find_edge(branch, r.operation.system, {}, directions_of(r.keys));
    return {edge.status == boundary::EdgeStatus::found ? edge.boundary.omega : absent, edge.boundary.d_omega};
}

/// The ends lie where they lie, wherever the design is driven.
std::vector<flow::ParameterVector> directions_at_fixed_frequency(const BandRequest& r) {
    std::vector<flow::ParameterVector> directions = directions_of(r.keys);
    const auto omega = static_cast<std::size_t>(r.operation.system.integrator->info().omega);
    for (flow::ParameterVector& direction : directions) { direction[omega] = 0.0; }
    return directions;
}

void report_end(const BandRequest& r, Quantity q, const BandEnd& end, Evaluation& evaluation) {
    if (!end.found) { return; }
    const auto at = static_cast<std::size_t>(q);
    // f = omega/(2 pi T), so df = (d omega - omega dT/T)/(2 pi T), T the scale of time.
    const double per_omega = 1.0 / (2.0 * std::numbers::pi * r.scales.time);
    evaluation.quantities[at] = end.omega * per_omega;
    if (r.demand.error_estimates) { evaluation.error_estimates[at] = end.error * per_omega; }
    auto& gradient = evaluation.gradients.quantity[at];
    gradient.clear();
    for (std::size_t i = 0; i < r.keys.size(); ++i) {
        const double d = i < end.d_omega.size() ? end.d_omega[i] : absent;
        gradient.push_back(per_omega * (d - end.omega * r.keys[i].scales.time / r.scales.time));
    }
}

}  // namespace

bool wants_band(const Demand& demand) {
    return std::any_of(demand.quantities.begin(), demand.quantities.end(),
                       [](Quantity q) { return q == Quantity::band_lower || q == Quantity::band_upper; });
}

void measure_band(const BandRequest& r, Evaluation& evaluation) {
    const Edge edge = edge_of(r);
    const std::vector<flow::ParameterVector> directions = directions_at_fixed_frequency(r);
    // The band is searched by as much evidence as the verdict at the operating point rests on.
    const bool sample = r.problem.single_stable > SingleStable::orbit;
    const Band band = single_stable_band({r.operation.system, r.operation.scout, r.orbit, edge.omega, edge.d_omega,
                                          directions, sample ? &r.problem.sampling : nullptr},
                                         r.actuator);
    report_end(r, Quantity::band_lower, band.lower, evaluation);
    report_end(r, Quantity::band_upper, band.upper, evaluation);
    evaluation.band_reasons = {band.lower.reason, band.upper.reason};
}

}  // namespace percuss::design
