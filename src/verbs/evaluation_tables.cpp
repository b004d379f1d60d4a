#include "verbs/evaluation_results.hpp"

#include "results/csv_table.hpp"

namespace percuss::verbs {

using design::Quantity;
using problem::ProblemFile;
using results::cell;
using results::Column;
using results::csv_text;
using results::si_unit;
using results::unit_of;

namespace {

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

DesignValues design_values(const design::Problem& problem) {
    DesignValues values;
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

std::string quantities_csv(const ProblemFile& problem, const DesignValues& design,
                           const design::Evaluation& evaluation) {
    Row row;
    for (const auto& [key, value] : design) {
        row.add(std::string(model::key_info(key).name), unit_of(problem, key), value);
    }
    const design::OperatingPoint& point = evaluation.operating_point;
    const std::string radians = si_unit(problem, "rad/s");
    row.add("omega", radians, in_user_units(problem, point.omega, time_unit(point)));
    row.add("edge_omega", radians, in_user_units(problem, point.edge_omega, time_unit(point)));
    if (!radians.empty()) {
        row.add("omega_nondimensional", "", point.omega);
        row.add("edge_omega_nondimensional", "", point.edge_omega);
    }
    const auto quantities = design::reported_quantities(*problem.design.actuator.type);
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
        for (const Quantity quantity : design::reported_quantities(*problem.design.actuator.type)) {
            add(std::string(design::quantity_info(quantity).name), unit_of(problem, quantity),
                evaluation.gradients.quantity[static_cast<std::size_t>(quantity)]);
        }
        add("omega_nondimensional", "", evaluation.gradients.omega);
        add("edge_omega_nondimensional", "", evaluation.gradients.edge_omega);
    }
    return csv_text(columns, rows);
}

void start_evaluation(Session& session) {
    std::vector<std::string> files = {"quantities.csv"};
    if (session.gradients()) { files.emplace_back("gradients.csv"); }
    session.start(std::move(files));
}

void store_evaluation(const Session& session, const design::Evaluation& evaluation) {
    const ProblemFile& problem = session.problem();
    session.write("quantities.csv", quantities_csv(problem, design_values(problem.design), evaluation));
    if (session.gradients()) { session.write("gradients.csv", gradients_csv(problem, evaluation)); }
}

}  // namespace percuss::verbs
