#include "verbs/explore/table_layout.hpp"

#include "results/presentation.hpp"
#include "verbs/evaluate/evaluate.hpp"

#include <algorithm>
#include <limits>
#include <stdexcept>

namespace percuss::verbs {

namespace {

using design::Quantity;
using problem::ProblemFile;

constexpr std::size_t no_place = std::numeric_limits<std::size_t>::max();

std::string name_of(Quantity quantity) { return std::string(design::quantity_info(quantity).name); }
std::string name_of(model::Key key) { return std::string(model::key_info(key).name); }

template <class Item>
void add_once(std::vector<Item>& list, const Item& item) {
    if (std::find(list.begin(), list.end(), item) == list.end()) { list.push_back(item); }
}

}  // namespace

std::vector<std::string> default_columns(const design::Problem& problem) {
    std::vector<std::string> names;
    for (const design::Objective& objective : problem.objectives) { add_once(names, name_of(objective.quantity)); }
    for (const design::Limit& limit : problem.limits) { add_once(names, name_of(limit.quantity)); }
    if (names.empty()) {
        for (const Quantity quantity : quantities_to_report(problem)) { add_once(names, name_of(quantity)); }
    }
    for (const std::string& name :
         {name_of(Quantity::drive_frequency), std::string(status_column), std::string(cause_column)}) {
        add_once(names, name);
    }
    return names;
}

TableLayout::TableLayout(const ProblemFile& problem, const ExploreOptions& options)
    : judges_(problem.design.single_stable != design::SingleStable::off &&
              model::has_stop(problem.design.actuator.law)) {
    const std::vector<std::string> asked = options.columns.empty() ? default_columns(problem.design) : options.columns;
    for (const design::DesignVariable& variable : problem.design.variables) { add_key(problem, variable.key); }
    for (const std::string& name : asked) {
        if (const auto key = model::find_key(name)) { add_key(problem, *key); }
    }
    for (const std::string& name : asked) {
        if (const auto quantity = design::find_quantity(name)) { add_quantity(problem, *quantity); }
    }
    for (const design::Objective& objective : problem.design.objectives) { add_quantity(problem, objective.quantity); }
    for (const design::Limit& limit : problem.design.limits) { add_quantity(problem, limit.quantity); }
    if (options.sensitivities) { add_derivatives(problem); }
    for (const std::string_view name : {edge_kind_column, status_column, cause_column}) {
        columns_.push_back({std::string(name), "", true});
    }
    for (std::size_t i = 0; i < problem.design.variables.size(); ++i) { shown_.push_back(i); }
    for (const std::string& name : asked) { add_once(shown_, place_of(name)); }
}

void TableLayout::add_key(const ProblemFile& problem, model::Key key) {
    if (std::find(keys_.begin(), keys_.end(), key) != keys_.end()) { return; }
    keys_.push_back(key);
    columns_.push_back({name_of(key), results::unit_of(problem, key), false});
}

void TableLayout::add_quantity(const ProblemFile& problem, Quantity quantity) {
    if (std::find(quantities_.begin(), quantities_.end(), quantity) != quantities_.end()) { return; }
    quantities_.push_back(quantity);
    columns_.push_back({name_of(quantity), results::unit_of(problem, quantity), false});
}

void TableLayout::add_derivatives(const ProblemFile& problem) {
    const auto& variables = problem.design.variables;
    for (std::size_t i = 0; i < variables.size(); ++i) {
        if (variables[i].integer) { continue; }
        gradient_keys_.push_back(variables[i].key);
        variable_of_gradient_.push_back(i);
    }
    for (const Quantity quantity : quantities_) {
        auto& places = derivative_places_.emplace_back(variables.size(), no_place);
        if (!design::quantity_info(quantity).smooth) { continue; }
        for (std::size_t g = 0; g < gradient_keys_.size(); ++g) {
            places[variable_of_gradient_[g]] = columns_.size();
            const bool plain = problem::is_nondimensional(problem.design);
            columns_.push_back({"d(" + name_of(quantity) + ")/d(" + name_of(gradient_keys_[g]) + ")",
                                plain ? "" : "SI per SI", false});
        }
    }
}

std::size_t TableLayout::place_of(std::string_view column) const {
    const auto found = std::find_if(columns_.begin(), columns_.end(),
                                    [&](const results::JournalColumn& each) { return each.name == column; });
    if (found == columns_.end()) { throw std::logic_error("explore: no column " + std::string(column)); }
    return static_cast<std::size_t>(found - columns_.begin());
}

design::Demand TableLayout::demand() const {
    design::Demand demand;
    demand.quantities = quantities_;
    demand.gradients = gradient_keys_;
    return demand;
}

results::Row TableLayout::row_of_keys(const model::Specification& actuator) const {
    results::Row row;
    row.reserve(columns_.size());
    for (const model::Key key : keys_) { row.emplace_back(actuator.effective(key)); }
    return row;
}

results::Row TableLayout::row(const model::Specification& actuator, const design::Evaluation& evaluation) const {
    results::Row row = row_of_keys(actuator);
    for (const Quantity quantity : quantities_) { row.emplace_back(evaluation.value(quantity)); }
    for (std::size_t q = 0; q < derivative_places_.size(); ++q) {
        if (!design::quantity_info(quantities_[q]).smooth) { continue; }
        const auto& gradient = evaluation.gradients.quantity[static_cast<std::size_t>(quantities_[q])];
        for (std::size_t g = 0; g < gradient_keys_.size(); ++g) {
            row.emplace_back(g < gradient.size() ? gradient[g] : design::absent);
        }
    }
    // A stable motion that nothing is known about beside it is no answer to what was asked.
    const bool unsettled = judges_ && evaluation.status == design::EvaluationStatus::ok &&
                           evaluation.uniqueness.verdict == design::Verdict::not_checked;
    row.emplace_back(std::string(design::to_string(evaluation.operating_point.edge_kind)));
    row.emplace_back(std::string(design::to_string(evaluation.status)));
    row.emplace_back(unsettled ? "uniqueness not checked: " + evaluation.uniqueness.checked : evaluation.reason);
    return row;
}

results::Row TableLayout::failed_row(const model::Specification& actuator, const std::string& cause) const {
    results::Row row = row_of_keys(actuator);
    row.resize(columns_.size() - 3, design::absent);
    row.emplace_back(std::string(design::to_string(design::EdgeKind::none)));
    row.emplace_back(std::string(design::to_string(design::EvaluationStatus::failed)));
    row.emplace_back(cause);
    return row;
}

double TableLayout::number(const results::Row& row, std::size_t place) { return std::get<double>(row.at(place)); }

double TableLayout::value(const results::Row& row, Quantity quantity) const {
    const auto found = std::find(quantities_.begin(), quantities_.end(), quantity);
    if (found == quantities_.end()) { return design::absent; }
    return number(row, keys_.size() + static_cast<std::size_t>(found - quantities_.begin()));
}

double TableLayout::variable(const results::Row& row, std::size_t i) const { return number(row, i); }

double TableLayout::derivative(const results::Row& row, std::size_t q, std::size_t i) const {
    const std::size_t place = q < derivative_places_.size() ? derivative_places_[q].at(i) : no_place;
    return place == no_place ? design::absent : number(row, place);
}

const std::string& TableLayout::edge_kind(const results::Row& row) const {
    return std::get<std::string>(row.at(columns_.size() - 3));
}
const std::string& TableLayout::status(const results::Row& row) const {
    return std::get<std::string>(row.at(columns_.size() - 2));
}
const std::string& TableLayout::cause(const results::Row& row) const {
    return std::get<std::string>(row.at(columns_.size() - 1));
}

}  // namespace percuss::verbs
