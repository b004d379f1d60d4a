#include "io/result_tables.hpp"

#include "io/csv_table.hpp"
#include "model/number_text.hpp"

#include <cmath>

namespace percuss::io {

namespace {

using design::Quantity;
using study::Column;

std::string cell(double value) { return std::isnan(value) ? "" : model::exact_text(value); }

bool is_plain(const ProblemFile& problem) { return units_of(problem) == "nondimensional"; }

std::string unit_of(const ProblemFile& problem, Quantity quantity) {
    return is_plain(problem) ? "" : std::string(design::quantity_info(quantity).unit);
}

std::string unit_of(const ProblemFile& problem, model::Key key) {
    return is_plain(problem) ? "" : std::string(model::key_info(key).unit);
}

/// A table of one row under construction.
struct Row {
    std::vector<Column> columns;
    std::vector<std::string> cells;
    void add(std::string name, std::string unit, double value) {
        columns.push_back({std::move(name), std::move(unit)});
        cells.push_back(cell(value));
    }
};

}  // namespace

std::vector<std::pair<model::Key, double>> design_values(const design::Problem& problem) {
    std::vector<std::pair<model::Key, double>> values;
    for (const design::DesignVariable& variable : problem.variables) {
        values.emplace_back(variable.key, problem.actuator.value(variable.key));
    }
    if (values.empty()) {
        for (const model::Key key : problem.actuator.type->keys) {
            if (problem.actuator.has(key)) { values.emplace_back(key, problem.actuator.value(key)); }
        }
    }
    return values;
}

std::string quantities_csv(const ProblemFile& problem, const std::vector<std::pair<model::Key, double>>& design,
                           const design::Evaluation& evaluation) {
    Row row;
    for (const auto& [key, value] : design) {
        row.add(std::string(model::key_info(key).name), unit_of(problem, key), value);
    }
    row.add("omega", "", evaluation.operating_point.omega);
    row.add("edge_omega", "", evaluation.operating_point.edge_omega);
    const auto quantities = design::reported_quantities(*problem.study.design.actuator.type);
    for (const Quantity quantity : quantities) {
        row.add(std::string(design::quantity_info(quantity).name), unit_of(problem, quantity),
                evaluation.value(quantity));
    }
    for (const Quantity quantity : quantities) {
        row.add("error of " + std::string(design::quantity_info(quantity).name), unit_of(problem, quantity),
                evaluation.error_estimates[static_cast<std::size_t>(quantity)]);
    }
    return csv_text(row.columns, {row.cells});
}

std::string gradients_csv(const ProblemFile& problem, const design::Evaluation& evaluation) {
    std::vector<Column> columns = {{"with respect to", ""}, {"unit of the key", ""}};
    std::vector<std::vector<std::string>> rows;
    for (const model::Key key : evaluation.gradient_keys) {
        const std::string unit = unit_of(problem, key);
        rows.push_back({std::string(model::key_info(key).name), unit.empty() ? "1" : unit});
    }
    const auto add = [&](const std::string& name, const std::string& unit, const std::vector<double>& values) {
        if (values.size() != rows.size()) { return; }
        columns.push_back({"d(" + name + ")", (unit.empty() ? "1" : unit) + " per unit of the key"});
        for (std::size_t i = 0; i < rows.size(); ++i) { rows[i].push_back(cell(values[i])); }
    };
    if (!rows.empty()) {
        for (const Quantity quantity : design::reported_quantities(*problem.study.design.actuator.type)) {
            add(std::string(design::quantity_info(quantity).name), unit_of(problem, quantity),
                evaluation.gradients.quantity[static_cast<std::size_t>(quantity)]);
        }
        add("omega", "", evaluation.gradients.omega);
        add("edge_omega", "", evaluation.gradients.edge_omega);
    }
    return csv_text(columns, rows);
}

std::string layers_csv(const ProblemFile& problem, const study::OptimiseStudyResult& result) {
    std::vector<Column> columns = {{"layers", ""}, {"status", ""}};
    for (const design::Objective& objective : problem.study.design.objectives) {
        columns.push_back(
            {std::string(design::quantity_info(objective.quantity).name), unit_of(problem, objective.quantity)});
    }
    columns.push_back({"KKT residual", ""});
    for (const design::DesignVariable& variable : problem.study.design.variables) {
        columns.push_back({std::string(model::key_info(variable.key).name), unit_of(problem, variable.key)});
    }
    columns.push_back({"reason", ""});
    std::vector<std::vector<std::string>> rows;
    for (const study::IntegerCaseReport& report : result.per_layers) {
        std::vector<std::string> row = {cell(report.layers), report.status, cell(report.objective),
                                        cell(report.kkt_residual)};
        for (const design::DesignVariable& variable : problem.study.design.variables) {
            double value = design::absent;
            for (const auto& [key, at] : report.design) { value = key == variable.key ? at : value; }
            row.push_back(cell(value));
        }
        row.push_back(report.reason);
        rows.push_back(std::move(row));
    }
    return csv_text(columns, rows);
}

std::string limits_csv(const ProblemFile& problem, const study::OptimiseStudyResult& result) {
    const std::vector<Column> columns = {{"limit", ""},
                                         {"unit", ""},
                                         {"value", "in that unit"},
                                         {"bound", "in that unit"},
                                         {"active", ""},
                                         {"multiplier", "objective per that unit"}};
    std::vector<std::vector<std::string>> rows;
    for (const study::LimitReport& limit : result.limits) {
        std::string unit;
        if (const auto quantity = design::find_quantity(limit.name)) {
            unit = unit_of(problem, *quantity);
        } else if (const auto key = model::find_key(limit.name)) {
            unit = unit_of(problem, *key);
        }
        rows.push_back({limit.text.empty() ? limit.name : limit.text, unit.empty() ? "1" : unit, cell(limit.value),
                        cell(limit.limit), limit.active ? "1" : "0", cell(limit.multiplier)});
    }
    return csv_text(columns, rows);
}

}  // namespace percuss::io
