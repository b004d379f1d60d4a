#include "io/documents.hpp"

#include "io/derived_parameters.hpp"
#include "io/setting_table.hpp"

#include <cmath>

#include <nlohmann/json.hpp>

namespace percuss::io {

namespace {

using Json = nlohmann::ordered_json;  // prints NaN as null and numbers so that they read back exactly
using design::Evaluation;
using design::Quantity;

constexpr int indentation = 2;

Json design_of(const design::Problem& problem) {
    Json out = Json::object();
    const auto add = [&](model::Key key) {
        if (problem.actuator.has(key)) { out[std::string(model::key_info(key).name)] = problem.actuator.value(key); }
    };
    if (problem.variables.empty()) {
        for (const model::Key key : problem.actuator.type->keys) { add(key); }
    }
    for (const design::DesignVariable& variable : problem.variables) { add(variable.key); }
    return out;
}

Json design_of(const std::vector<std::pair<model::Key, double>>& values) {
    Json out = Json::object();
    for (const auto& [key, value] : values) { out[std::string(model::key_info(key).name)] = value; }
    return out;
}

Json per_quantity(const std::array<double, design::quantity_count>& values, const model::Actuator& family) {
    Json out = Json::object();
    for (const Quantity quantity : design::reported_quantities(family)) {
        out[std::string(design::quantity_info(quantity).name)] = values[static_cast<std::size_t>(quantity)];
    }
    return out;
}

Json operating_point_of(const design::OperatingPoint& point) {
    return {{"drive_frequency", point.drive_frequency},
            {"omega", point.omega},
            {"edge_kind", design::to_string(point.edge_kind)},
            {"edge_omega", point.edge_omega},
            {"fold_offset", point.fold_offset},
            {"margin", point.margin}};
}

Json orbit_of(const design::OrbitReport& orbit) {
    Json multipliers = Json::array();
    for (const auto& multiplier : orbit.multipliers) {
        multipliers.push_back(Json::array({multiplier.real(), multiplier.imag()}));
    }
    return {{"state", orbit.state},       {"period", orbit.period},
            {"contacts", orbit.contacts}, {"x_max", orbit.x_max},
            {"x_min", orbit.x_min},       {"multipliers", std::move(multipliers)},
            {"residual", orbit.residual}, {"state_error", orbit.state_error}};
}

Json attractor_of(const design::Attractor& attractor) {
    return {{"period", attractor.period},
            {"kind", attractor.kind},
            {"state", attractor.state},
            {"peak_force", attractor.peak_force},
            {"amplitude", attractor.amplitude},
            {"share", attractor.share},
            {"max_multiplier", attractor.max_multiplier}};
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

Json derivatives(const std::vector<model::Key>& keys, const std::vector<double>& values) {
    Json out = Json::object();
    for (std::size_t i = 0; i < keys.size() && i < values.size(); ++i) {
        out[std::string(model::key_info(keys[i]).name)] = values[i];
    }
    return out;
}

Json gradients_of(const Evaluation& evaluation, const model::Actuator& family, bool with_edge) {
    Json out = Json::object();
    const auto add = [&](std::string_view name, const std::vector<double>& values) {
        if (!values.empty()) { out[std::string(name)] = derivatives(evaluation.gradient_keys, values); }
    };
    for (const Quantity quantity : design::reported_quantities(family)) {
        add(design::quantity_info(quantity).name, evaluation.gradients.quantity[static_cast<std::size_t>(quantity)]);
    }
    add("operating_point.omega", evaluation.gradients.omega);
    add("operating_point.drive_frequency", evaluation.gradients.drive_frequency);
    if (with_edge) { add("operating_point.edge_omega", evaluation.gradients.edge_omega); }
    return out;
}

Json beginning(const ProblemFile& problem, std::string_view schema) {
    return {{"schema", schema}, {"units", units_of(problem)}};
}

Json evaluation_document(const ProblemFile& problem, std::string_view schema, const Evaluation& evaluation,
                         double seconds, bool with_edge) {
    const model::Actuator& family = *problem.study.design.actuator.type;
    Json out = beginning(problem, schema);
    out["status"] = design::to_string(evaluation.status);
    out["reason"] = evaluation.reason;
    out["design"] = design_of(problem.study.design);
    out["operating_point"] = operating_point_of(evaluation.operating_point);
    if (!with_edge) {
        out["operating_point"].erase("edge_kind");
        out["operating_point"].erase("edge_omega");
    }
    out["quantities"] = per_quantity(evaluation.quantities, family);
    if (!evaluation.band_reasons[0].empty() || !evaluation.band_reasons[1].empty()) {
        out["band"] = {{"lower", evaluation.band_reasons[0]}, {"upper", evaluation.band_reasons[1]}};
    }
    out["orbit"] = orbit_of(evaluation.orbit);
    out["uniqueness"] = uniqueness_of(evaluation.uniqueness);
    out["gradients"] = gradients_of(evaluation, family, with_edge);
    out["error_estimate"] = per_quantity(evaluation.error_estimates, family);
    out["cost"] = {{"seconds", seconds}, {"periods", evaluation.periods}};
    return out;
}

Json limit_of(const study::LimitReport& limit) {
    return {{"name", limit.name},   {"text", limit.text},     {"value", limit.value},          {"limit", limit.limit},
            {"upper", limit.upper}, {"active", limit.active}, {"multiplier", limit.multiplier}};
}

Json integer_case_of(const study::IntegerCaseReport& report) {
    return {{"layers", report.layers},
            {"status", report.status},
            {"objective", report.objective},
            {"kkt_residual", report.kkt_residual},
            {"design", design_of(report.design)},
            {"reason", report.reason}};
}

Json counterexample_of(const study::Counterexample& found) {
    return {{"layers", found.layers},         {"design", design_of(found.design)},
            {"objective", found.objective},   {"period", found.period},
            {"peak_force", found.peak_force}, {"window", {found.window_lower, found.window_upper}},
            {"remedy", found.remedy}};
}

std::string_view origin_text(Origin origin) {
    switch (origin) {
        case Origin::file: return "file";
        case Origin::option: return "option";
        case Origin::fallback: return "default";
    }
    return "unknown";
}

Json setting_of(const ResolvedSetting& setting) {
    return {{"value", std::isnan(setting.value) ? Json(setting.text) : Json(setting.value)},
            {"unit", setting.unit},
            {"text", setting.text},
            {"origin", origin_text(setting.origin)},
            {"trouble", setting.trouble}};
}

/// Repeatable keys become arrays.
Json settings_of(const ProblemFile& problem) {
    Json out = Json::object();
    for (const ResolvedSetting& setting : problem.settings) {
        const SettingInfo* info = find_setting(setting.name);
        if (info != nullptr && info->repeatable) {
            out[setting.name].push_back(setting_of(setting));
        } else {
            out[setting.name] = setting_of(setting);
        }
    }
    return out;
}

std::string printed(const Json& document) {
    return document.dump(indentation, ' ', false, Json::error_handler_t::replace) + "\n";
}

}  // namespace

std::string check_document(const ProblemFile& problem) {
    Json out = beginning(problem, "percuss/check/1");
    out["problem"] = problem.name;
    out["hash"] = problem_hash(problem);
    out["settings"] = settings_of(problem);
    out["derived"] = Json::object();
    for (const DerivedParameter& parameter : derived_parameters(problem)) {
        out["derived"][parameter.name] = {
            {"value", parameter.value}, {"unit", parameter.unit}, {"meaning", parameter.meaning}};
    }
    out["troubles"] = problem.troubles;
    return printed(out);
}

std::string evaluate_document(const ProblemFile& problem, const study::EvaluateStudyResult& result) {
    return printed(evaluation_document(problem, "percuss/evaluate/1", result.evaluation, result.seconds, true));
}

std::string orbit_document(const ProblemFile& problem, const study::OrbitStudyResult& result) {
    return printed(evaluation_document(problem, "percuss/orbit/1", result.evaluation, result.seconds, false));
}

std::string optimise_document(const ProblemFile& problem, const study::OptimiseStudyResult& result) {
    const model::Actuator& family = *problem.study.design.actuator.type;
    Json out = beginning(problem, "percuss/optimise/1");
    out["status"] = result.status;
    out["reason"] = result.reason;
    out["objective"] = Json::object();
    for (const design::Objective& objective : problem.study.design.objectives) {
        out["objective"] = {{"quantity", design::quantity_info(objective.quantity).name},
                            {"maximise", objective.maximise},
                            {"value", result.best.value(objective.quantity)},
                            {"error", result.objective_error}};
    }
    out["design"] = design_of(result.design);
    out["quantities"] = per_quantity(result.best.quantities, family);
    out["gradients"] = gradients_of(result.best, family, true);
    out["operating_point"] = operating_point_of(result.best.operating_point);
    out["limits"] = Json::array();
    for (const study::LimitReport& limit : result.limits) { out["limits"].push_back(limit_of(limit)); }
    out["kkt_residual"] = result.kkt_residual;
    out["objective_error"] = result.objective_error;
    out["orbit"] = orbit_of(result.best.orbit);
    out["uniqueness"] = uniqueness_of(result.best.uniqueness);
    out["per_layers"] = Json::array();
    for (const study::IntegerCaseReport& report : result.per_layers) {
        out["per_layers"].push_back(integer_case_of(report));
    }
    out["counterexamples"] = Json::array();
    for (const study::Counterexample& found : result.counterexamples) {
        out["counterexamples"].push_back(counterexample_of(found));
    }
    out["objective_unrefuted"] = result.objective_unrefuted;
    out["error_estimate"] = per_quantity(result.best.error_estimates, family);
    out["evaluations"] = result.evaluations;
    out["seconds"] = result.seconds;
    return printed(out);
}

}  // namespace percuss::io
