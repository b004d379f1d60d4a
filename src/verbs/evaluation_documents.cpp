#include "verbs/evaluation_results.hpp"

#include "design/quantity.hpp"

#include <numbers>

namespace percuss::verbs {

using design::Evaluation;
using design::Quantity;
using problem::ProblemFile;
using results::Json;

namespace {

Json attractor_of(const design::Attractor& attractor) {
    return {{"period", attractor.period},
            {"kind", attractor.kind},
            {"state", attractor.state},
            {"peak_force", attractor.peak_force},
            {"amplitude", attractor.amplitude},
            {"share", attractor.share},
            {"max_multiplier", attractor.max_multiplier}};
}

Json derivatives(const std::vector<model::Key>& keys, const std::vector<double>& values) {
    Json out = Json::object();
    for (std::size_t i = 0; i < keys.size() && i < values.size(); ++i) {
        out[std::string(model::key_info(keys[i]).name)] = values[i];
    }
    return out;
}

/// Derivatives of an angular frequency in rad/s. With omega = w / Gamma and f = w / (2 pi Gamma) at the operating
/// point, d(Gamma)/Gamma = d(w)/w - d(f)/f; so d(omega) = omega (d(own)/own - d(Gamma)/Gamma) for any frequency `own`.
std::vector<double> in_radians_per_second(const Evaluation& evaluation, double own, const std::vector<double>& d_own) {
    const design::OperatingPoint& point = evaluation.operating_point;
    const auto& d_omega = evaluation.gradients.omega;
    const auto& d_frequency = evaluation.gradients.drive_frequency;
    if (d_own.size() != d_omega.size() || d_own.size() != d_frequency.size()) { return {}; }
    std::vector<double> out;
    for (std::size_t i = 0; i < d_own.size(); ++i) {
        const double d_time = d_omega[i] / point.omega - d_frequency[i] / point.drive_frequency;
        out.push_back(own / time_unit(point) * (d_own[i] / own - d_time));
    }
    return out;
}

}  // namespace

Json document_beginning(const ProblemFile& problem, std::string_view schema) {
    return {{"schema", schema}, {"units", problem::units_of(problem)}};
}

Json design_of(const DesignValues& values) {
    Json out = Json::object();
    for (const auto& [key, value] : values) { out[model::key_info(key).name] = value; }
    return out;
}

Json quantities_of(const std::array<double, design::quantity_count>& values, const ProblemFile& problem) {
    Json out = Json::object();
    for (const Quantity quantity : design::reported_quantities(*problem.design.actuator.type)) {
        out[design::quantity_info(quantity).name] = values[static_cast<std::size_t>(quantity)];
    }
    return out;
}

Json multipliers_of(const std::vector<std::complex<double>>& multipliers) {
    Json out = Json::array();
    for (const auto& multiplier : multipliers) { out.push_back(Json::array({multiplier.real(), multiplier.imag()})); }
    return out;
}

Json orbit_of(const design::OrbitReport& orbit) {
    return {{"state", orbit.state},       {"period", orbit.period},
            {"contacts", orbit.contacts}, {"x_max", orbit.x_max},
            {"x_min", orbit.x_min},       {"multipliers", multipliers_of(orbit.multipliers)},
            {"residual", orbit.residual}, {"state_error", orbit.state_error}};
}

Json uniqueness_of(const design::Uniqueness& uniqueness) {
    Json attractors = Json::array();
    for (const design::Attractor& attractor : uniqueness.attractors) { attractors.push_back(attractor_of(attractor)); }
    return {{"tier", uniqueness.tier},
            {"verdict", design::to_string(uniqueness.verdict)},
            {"checked", uniqueness.checked},
            {"starts", uniqueness.starts},
            {"missed_share_bound", uniqueness.missed_share_bound},
            {"attractors", std::move(attractors)}};
}

Json gradients_of(const Evaluation& evaluation, const ProblemFile& problem, WithEdge edge) {
    Json out = Json::object();
    const auto add = [&](std::string_view name, const std::vector<double>& values) {
        if (!values.empty()) { out[name] = derivatives(evaluation.gradient_keys, values); }
    };
    const auto add_frequency = [&](const std::string& name, double own, const std::vector<double>& d_own) {
        if (problem::is_nondimensional(problem.design)) { return add(name, d_own); }
        add(name, in_radians_per_second(evaluation, own, d_own));
        add(name + "_nondimensional", d_own);
    };
    for (const Quantity quantity : design::reported_quantities(*problem.design.actuator.type)) {
        add(design::quantity_info(quantity).name, evaluation.gradients.quantity[static_cast<std::size_t>(quantity)]);
    }
    add_frequency("operating_point.omega", evaluation.operating_point.omega, evaluation.gradients.omega);
    add("operating_point.drive_frequency", evaluation.gradients.drive_frequency);
    if (edge == WithEdge::yes) {
        add_frequency("operating_point.edge_omega", evaluation.operating_point.edge_omega,
                      evaluation.gradients.edge_omega);
    }
    return out;
}

Json evaluation_document(const ProblemFile& problem, std::string_view schema, const Evaluation& evaluation,
                         double seconds, WithEdge edge) {
    Json out = document_beginning(problem, schema);
    out["status"] = design::to_string(evaluation.status);
    out["reason"] = evaluation.reason;
    out["design"] = design_of(design_values(problem.design));
    out["operating_point"] = operating_point_of(problem, evaluation.operating_point,
                                                edge == WithEdge::yes ? PointMembers::all : PointMembers::without_edge);
    out["quantities"] = quantities_of(evaluation.quantities, problem);
    if (!evaluation.band_reasons[0].empty() || !evaluation.band_reasons[1].empty()) {
        out["band"] = {{"lower", evaluation.band_reasons[0]}, {"upper", evaluation.band_reasons[1]}};
    }
    out["orbit"] = orbit_of(evaluation.orbit);
    out["uniqueness"] = uniqueness_of(evaluation.uniqueness);
    out["gradients"] = gradients_of(evaluation, problem, edge);
    out["error_estimate"] = quantities_of(evaluation.error_estimates, problem);
    out["cost"] = {{"seconds", seconds}, {"periods", evaluation.periods}};
    return out;
}

}  // namespace percuss::verbs
