#include "verbs/optimise/optimise_results.hpp"

#include "results/csv_table.hpp"
#include "verbs/evaluation_results.hpp"

#include <cmath>
#include <utility>

namespace percuss::verbs {

using design::Quantity;
using problem::ProblemFile;
using results::Block;
using results::cell;
using results::csv_text;
using results::Json;
using results::missing;
using results::number;
using results::Presentation;
using results::quantity_text;
using results::sentence;
using results::unit_of;
using results::value_text;

namespace {

Json limit_of(const LimitReport& limit) {
    return {{"name", limit.name},   {"text", limit.text},     {"value", limit.value},          {"limit", limit.limit},
            {"upper", limit.upper}, {"active", limit.active}, {"multiplier", limit.multiplier}};
}

Json integer_case_of(const IntegerCaseReport& report) {
    return {{"layers", report.layers},
            {"status", to_string(report.status)},
            {"objective", report.objective},
            {"kkt_residual", report.kkt_residual},
            {"design", design_of(report.design)},
            {"reason", report.reason}};
}

Json counterexample_of(const Counterexample& found) {
    return {{"layers", found.layers},         {"design", design_of(found.design)},
            {"objective", found.objective},   {"period", found.period},
            {"peak_force", found.peak_force}, {"window", Json::array({found.window_lower, found.window_upper})},
            {"remedy", found.remedy}};
}

/// A limit may be on a quantity or, as a bound, on a key.
std::string limit_unit(const ProblemFile& problem, const LimitReport& limit) {
    std::string unit;
    if (const auto quantity = design::find_quantity(limit.name)) {
        unit = results::unit_of(problem, *quantity);
    } else if (const auto key = model::find_key(limit.name)) {
        unit = results::unit_of(problem, *key);
    }
    return unit == "1" ? "" : unit;
}

/// Values in the unit of the bound; the multiplier is what the objective gains per that unit.
Block limits_block(const ProblemFile& problem, const OptimiseStudyResult& result) {
    Block block{"Limits", "", {"limit", "value", "bound", "active", "gain per unit of room"}, {}};
    const auto& objectives = problem.design.objectives;
    const std::string gained =
        objectives.empty() ? "" : results::si_unit(problem, design::quantity_info(objectives.front().quantity).unit);
    for (const LimitReport& limit : result.limits) {
        const std::string unit = limit_unit(problem, limit);
        const results::ShownUnit shown = results::shown_unit(limit.limit, unit);
        std::string gain = number(limit.multiplier * shown.size);
        if (gain != missing && limit.multiplier != 0.0) {
            gain += gained.empty() ? "" : " " + gained;
            gain += shown.name.empty() ? "" : " per " + shown.name;
        }
        block.rows.push_back({limit.text.empty() ? limit.name : limit.text, value_text(problem, limit.value, unit),
                              value_text(problem, limit.limit, unit), limit.active ? "active" : "", gain});
    }
    return block;
}

Block integer_cases_block(const ProblemFile& problem, const OptimiseStudyResult& result) {
    Block block{"Integer cases", "", {"layers", "status", "objective", "KKT residual", "remark"}, {}};
    const auto& objectives = problem.design.objectives;
    for (const IntegerCaseReport& report : result.per_layers) {
        const std::string objective = objectives.empty()
                                        ? number(report.objective)
                                        : quantity_text(problem, objectives.front().quantity, report.objective);
        block.rows.push_back({number(report.layers), std::string(to_string(report.status)), objective,
                              number(report.kkt_residual, 2), report.reason});
    }
    return block;
}

Block counterexamples_block(const ProblemFile& problem, const OptimiseStudyResult& result) {
    Block block{"Counterexamples: motions that were found beside the best design so far",
                "",
                {"layers", "objective there", "period", "peak force", "exists from", "to", "remedy"},
                {}};
    const auto& objectives = problem.design.objectives;
    for (const Counterexample& found : result.counterexamples) {
        const std::string objective = objectives.empty()
                                        ? number(found.objective)
                                        : quantity_text(problem, objectives.front().quantity, found.objective);
        block.rows.push_back({number(found.layers), objective,
                              found.period > 0 ? std::to_string(found.period) : "aperiodic",
                              quantity_text(problem, Quantity::peak_force, found.peak_force),
                              quantity_text(problem, Quantity::drive_frequency, found.window_lower),
                              quantity_text(problem, Quantity::drive_frequency, found.window_upper), found.remedy});
    }
    return block;
}

/// What it cost to be alone.
Block price_block(const ProblemFile& problem, const OptimiseStudyResult& result) {
    if (std::isnan(result.objective_unrefuted) || result.status != OptimiseStatus::optimal) { return sentence(""); }
    const Quantity objective = problem.design.objectives.front().quantity;
    const double now = result.best.value(objective);
    return sentence("Price of being the only stable motion found: " +
                    std::string(design::quantity_info(objective).name) + " " + quantity_text(problem, objective, now) +
                    " instead of " + quantity_text(problem, objective, result.objective_unrefuted) + " (" +
                    number(100.0 * (now / result.objective_unrefuted - 1.0), 3) + " %)");
}

}  // namespace

std::string optimise_document(const ProblemFile& problem, const OptimiseStudyResult& result) {
    Json out = document_beginning(problem, "percuss/optimise/1");
    out["status"] = to_string(result.status);
    out["reason"] = result.reason;
    out["objective"] = Json::object();
    for (const design::Objective& objective : problem.design.objectives) {
        out["objective"] = {{"quantity", design::quantity_info(objective.quantity).name},
                            {"maximise", objective.maximise},
                            {"value", result.best.value(objective.quantity)},
                            {"error", result.objective_error}};
    }
    out["design"] = design_of(result.design);
    out["quantities"] = quantities_of(result.best.quantities, problem);
    out["gradients"] = gradients_of(result.best, problem, WithEdge::yes);
    out["operating_point"] = operating_point_of(problem, result.best.operating_point, PointMembers::all);
    out["limits"] = Json::array();
    for (const LimitReport& limit : result.limits) { out["limits"].push_back(limit_of(limit)); }
    out["kkt_residual"] = result.kkt_residual;
    out["objective_error"] = result.objective_error;
    out["orbit"] = orbit_of(result.best.orbit);
    out["uniqueness"] = uniqueness_of(result.best.uniqueness);
    out["per_layers"] = Json::array();
    for (const IntegerCaseReport& report : result.per_layers) { out["per_layers"].push_back(integer_case_of(report)); }
    out["counterexamples"] = Json::array();
    for (const Counterexample& found : result.counterexamples) {
        out["counterexamples"].push_back(counterexample_of(found));
    }
    out["objective_unrefuted"] = result.objective_unrefuted;
    out["error_estimate"] = quantities_of(result.best.error_estimates, problem);
    out["evaluations"] = result.evaluations;
    out["seconds"] = result.seconds;
    return results::printed(out);
}

Presentation present_optimum(const ProblemFile& problem, const OptimiseStudyResult& result) {
    Presentation out;
    out.title = problem.name + ": optimum";
    out.blocks.push_back(results::status_sentence(to_string(result.status), result.reason));
    out.blocks.push_back(design_block(result.design));
    add_evaluation(problem, result.best, WithEdge::yes, out);
    out.blocks.push_back(limits_block(problem, result));
    out.blocks.push_back(integer_cases_block(problem, result));
    out.blocks.push_back(counterexamples_block(problem, result));
    out.blocks.push_back(price_block(problem, result));
    out.blocks.push_back(sentence("KKT residual " + number(result.kkt_residual, 3) + ", " +
                                  std::to_string(result.evaluations) + " evaluations in " + number(result.seconds, 3) +
                                  " s"));
    results::drop_empty_blocks(out);
    return out;
}

std::string layers_csv(const ProblemFile& problem, const OptimiseStudyResult& result) {
    std::vector<Column> columns = {{"layers", ""}, {"status", ""}};
    for (const design::Objective& objective : problem.design.objectives) {
        columns.push_back(
            {std::string(design::quantity_info(objective.quantity).name), unit_of(problem, objective.quantity)});
    }
    columns.push_back({"KKT residual", ""});
    for (const design::DesignVariable& variable : problem.design.variables) {
        columns.push_back({std::string(model::key_info(variable.key).name), unit_of(problem, variable.key)});
    }
    columns.push_back({"reason", ""});
    std::vector<std::vector<std::string>> rows;
    for (const IntegerCaseReport& report : result.per_layers) {
        std::vector<std::string> row = {cell(report.layers), std::string(to_string(report.status)),
                                        cell(report.objective), cell(report.kkt_residual)};
        for (const design::DesignVariable& variable : problem.design.variables) {
            double value = design::absent;
            for (const auto& [key, at] : report.design) { value = key == variable.key ? at : value; }
            row.push_back(cell(value));
        }
        row.push_back(report.reason);
        rows.push_back(std::move(row));
    }
    return csv_text(columns, rows);
}

std::string limits_csv(const ProblemFile& problem, const OptimiseStudyResult& result) {
    const std::vector<Column> columns = {{"limit", ""},
                                         {"unit", ""},
                                         {"value", "in that unit"},
                                         {"bound", "in that unit"},
                                         {"active", ""},
                                         {"multiplier", "objective per that unit"}};
    std::vector<std::vector<std::string>> rows;
    for (const LimitReport& limit : result.limits) {
        const std::string unit = limit_unit(problem, limit);
        rows.push_back({limit.text.empty() ? limit.name : limit.text, unit.empty() ? "1" : unit, cell(limit.value),
                        cell(limit.limit), limit.active ? "1" : "0", cell(limit.multiplier)});
    }
    return csv_text(columns, rows);
}

}  // namespace percuss::verbs
