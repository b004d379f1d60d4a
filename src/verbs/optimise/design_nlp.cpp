#include "verbs/optimise/design_nlp.hpp"

#include <algorithm>
#include <cmath>

namespace percuss::verbs {

using design::Quantity;
using optimise::Vector;

double ContinuousVariable::value(double unit) const {
    // Solvers step over their bounds by rounding (Ipopt by 1e-8), and at a bound the value must be the one that was
    // given.
    if (unit <= 0.0) { return lower; }
    if (unit >= 1.0) { return upper; }
    return logarithmic ? lower * std::pow(upper / lower, unit) : lower + unit * (upper - lower);
}
double ContinuousVariable::unit_of(double value) const {
    const double unit =
        logarithmic ? std::log(value / lower) / std::log(upper / lower) : (value - lower) / (upper - lower);
    return std::clamp(unit, 0.0, 1.0);
}
double ContinuousVariable::slope(double unit) const {
    return logarithmic ? value(unit) * std::log(upper / lower) : upper - lower;
}

std::vector<Quantity> wanted_quantities(const design::Problem& problem) {
    std::vector<Quantity> wanted;
    const auto add = [&](Quantity q) {
        if (std::find(wanted.begin(), wanted.end(), q) == wanted.end()) { wanted.push_back(q); }
    };
    for (const design::Objective& o : problem.objectives) { add(o.quantity); }
    for (const design::Limit& l : problem.limits) { add(l.quantity); }
    return wanted;
}

std::vector<Column> design_columns(const design::Problem& problem) {
    std::vector<Column> columns;
    for (const design::DesignVariable& v : problem.variables) {
        const model::KeyInfo& info = model::key_info(v.key);
        columns.push_back({std::string(info.name), std::string(info.unit)});
    }
    for (Quantity q : wanted_quantities(problem)) {
        const design::QuantityInfo& info = design::quantity_info(q);
        columns.push_back({std::string(info.name), std::string(info.unit)});
    }
    columns.push_back({"status", "1"});
    return columns;
}

DesignNlp::DesignNlp(const design::Evaluator& evaluator, model::Specification fixed, double objective_scale,
                     RowSink* rows, std::vector<Exclusion> exclusions, numerics::CancelRequest cancelled)
    : evaluator_(evaluator),
      fixed_(fixed),
      objective_scale_(objective_scale),
      rows_(rows),
      exclusions_(std::move(exclusions)),
      cancelled_(std::move(cancelled)) {
    for (const design::DesignVariable& v : problem().variables) {
        if (!v.integer) { variables_.push_back({v.key, v.lower, v.upper, v.logarithmic}); }
    }
}

int DesignNlp::constraints() const { return static_cast<int>(problem().limits.size() + exclusions_.size()); }
Vector DesignNlp::lower() const { return Vector::Zero(variables()); }
Vector DesignNlp::upper() const { return Vector::Ones(variables()); }

model::Specification DesignNlp::specification(const Vector& x) const {
    model::Specification spec = fixed_;
    for (std::size_t j = 0; j < variables_.size(); ++j) {
        spec.set(variables_[j].key, variables_[j].value(x[static_cast<int>(j)]));
    }
    return spec;
}

Vector DesignNlp::point(const model::Specification& spec) const {
    Vector x(variables());
    for (std::size_t j = 0; j < variables_.size(); ++j) {
        x[static_cast<int>(j)] = variables_[j].unit_of(spec.value(variables_[j].key));
    }
    return x;
}

double DesignNlp::limit_scale(std::size_t i) const {
    // Limits relative to their bounds are of one size whatever their unit; a bound of zero gives no size.
    const double bound = std::abs(problem().limits[i].bound);
    return bound > 0.0 ? bound : 1.0;
}

design::Demand DesignNlp::demand(bool with_gradient) const {
    design::Demand demand;
    demand.quantities = wanted_quantities(problem());
    if (with_gradient) {
        for (const ContinuousVariable& v : variables_) { demand.gradients.push_back(v.key); }
    }
    return demand;
}

optimise::Evaluation DesignNlp::translate(const design::Evaluation& evaluation, const Vector& x,
                                          bool with_gradient) const {
    optimise::Evaluation out;
    if (evaluation.status != design::EvaluationStatus::ok) { return out; }
    const bool must_be_alone = problem().single_stable != design::SingleStable::off;
    // A design whose motion is not known to be alone counts as one that cannot be evaluated: there is no gradient that
    // leads away from it.
    if (must_be_alone && evaluation.uniqueness.verdict != design::Verdict::unique) { return out; }
    const int n = variables();
    const int m = constraints();
    const design::Objective& objective = problem().objectives.front();
    const double sign = (objective.maximise ? -1.0 : 1.0) / objective_scale_;
    const auto gradient_of = [&](Quantity q, int j) {
        return evaluation.gradients.quantity[static_cast<std::size_t>(q)][static_cast<std::size_t>(j)] *
               variables_[static_cast<std::size_t>(j)].slope(x[j]);
    };
    out.objective = sign * evaluation.value(objective.quantity);
    out.constraints.resize(m);
    if (with_gradient) {
        out.gradient.resize(n);
        out.jacobian.resize(m, n);
        for (int j = 0; j < n; ++j) { out.gradient[j] = sign * gradient_of(objective.quantity, j); }
    }
    const int limits = static_cast<int>(problem().limits.size());
    for (int i = 0; i < limits; ++i) {
        const design::Limit& limit = problem().limits[static_cast<std::size_t>(i)];
        const double factor = (limit.upper ? 1.0 : -1.0) / limit_scale(static_cast<std::size_t>(i));
        out.constraints[i] = factor * (evaluation.value(limit.quantity) - limit.bound);
        for (int j = 0; with_gradient && j < n; ++j) { out.jacobian(i, j) = factor * gradient_of(limit.quantity, j); }
    }
    add_exclusions(evaluation, x, with_gradient, limits, out);
    // An end of the band that was not found, or only bracketed, has no value or no gradient.
    out.ok = std::isfinite(out.objective) && out.constraints.allFinite() &&
             (!with_gradient || (out.gradient.allFinite() && out.jacobian.allFinite()));
    return out;
}

void DesignNlp::add_exclusions(const design::Evaluation& evaluation, const Vector& x, bool with_gradient, int first,
                               optimise::Evaluation& out) const {
    if (exclusions_.empty()) { return; }
    flow::Cost cost;
    cost.cancelled = cancelled_;
    cost.step_budget = design::default_step_budget;
    const model::Specification spec = specification(x);
    std::vector<model::Key> keys;
    if (with_gradient) {
        for (const ContinuousVariable& v : variables_) { keys.push_back(v.key); }
    }
    for (std::size_t i = 0; i < exclusions_.size(); ++i) {
        const int row = first + static_cast<int>(i);
        const ExclusionValue value =
            verbs::evaluate(exclusions_[i], evaluator_.system(spec, &cost), spec, evaluation.operating_point.omega,
                            evaluation.gradients.omega, keys);
        if (cost.allowance() != flow::Status::ok) {
            out.constraints[row] = design::absent;  // the window is not known here: the evaluation fails
            return;
        }
        out.constraints[row] = value.value;
        for (std::size_t j = 0; j < keys.size(); ++j) {
            const int column = static_cast<int>(j);
            out.jacobian(row, column) = value.gradient[j] * variables_[j].slope(x[column]);
        }
    }
}

optimise::Evaluation DesignNlp::evaluate(const Vector& x, bool /*want_gradient*/) {
    // Gradients come at a few percent of an evaluation, so there is always one: solvers ask for it at most points.
    const model::Specification spec = specification(x);
    design::Demand demanded = demand(true);
    demanded.cancelled = cancelled_;
    const design::Evaluation evaluation = evaluator_.evaluate(spec, demanded);
    if (cancelled_ && cancelled_()) { return {}; }
    ++statuses_[evaluation.status];
    write_row(spec, evaluation);
    return translate(evaluation, x, true);
}

void DesignNlp::write_row(const model::Specification& spec, const design::Evaluation& evaluation) {
    if (rows_ == nullptr) { return; }
    std::vector<double> row;
    for (const design::DesignVariable& v : problem().variables) { row.push_back(spec.value(v.key)); }
    for (Quantity q : wanted_quantities(problem())) { row.push_back(evaluation.value(q)); }
    // As a number, 0 for ok: tables hold nothing else.
    row.push_back(static_cast<double>(evaluation.status) - static_cast<double>(design::EvaluationStatus::ok));
    rows_->row(row);
}

}  // namespace percuss::verbs
