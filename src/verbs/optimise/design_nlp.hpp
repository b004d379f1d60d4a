#pragma once
/// \file
/// A design problem as a nonlinear program: variables mapped to [0, 1], objective and limits scaled to order one.

#include "design/evaluate.hpp"
#include "numerics/cancel.hpp"
#include "optimise/nlp.hpp"
#include "verbs/optimise/exclusion.hpp"
#include "verbs/study.hpp"

#include <map>

namespace percuss::verbs {

/// One design variable that the solver moves: its range, linear or logarithmic.
struct ContinuousVariable {
    model::Key key{};
    double lower = 0.0;
    double upper = 1.0;
    bool logarithmic = false;
    [[nodiscard]] double value(double unit) const;     ///< from [0, 1] to the key's unit
    [[nodiscard]] double unit_of(double value) const;  ///< and back
    [[nodiscard]] double slope(double unit) const;     ///< d(value)/d(unit)
};

/// minimise -+objective/scale subject to limits: (q - bound)/|bound| <= 0 or the other way round. A design whose status
/// is not ok (no impact, unstable, not alone) is a failed evaluation; so is one whose uniqueness was asked for and
/// could not be settled.
class DesignNlp final : public optimise::Nlp {
public:
    /// `fixed`: the actuator with the enumerated integers set. objective_scale > 0.
    /// exclusions: constraints after the limits, in their order. An evaluation that is cancelled fails and leaves no
    /// row.
    DesignNlp(const design::Evaluator& evaluator, model::Specification fixed, double objective_scale, RowSink* rows,
              std::vector<Exclusion> exclusions = {}, numerics::CancelRequest cancelled = {});

    [[nodiscard]] int variables() const override { return static_cast<int>(variables_.size()); }
    [[nodiscard]] int constraints() const override;
    [[nodiscard]] optimise::Vector lower() const override;
    [[nodiscard]] optimise::Vector upper() const override;
    optimise::Evaluation evaluate(const optimise::Vector& x, bool want_gradient) override;

    [[nodiscard]] model::Specification specification(const optimise::Vector& x) const;
    [[nodiscard]] optimise::Vector point(const model::Specification& spec) const;
    [[nodiscard]] const std::vector<ContinuousVariable>& continuous() const { return variables_; }
    [[nodiscard]] double objective_scale() const { return objective_scale_; }
    /// Scale of limit i: its bound's magnitude.
    [[nodiscard]] double limit_scale(std::size_t i) const;
    /// Value, gradient and limits of a finished evaluation, in the program's scaling.
    [[nodiscard]] optimise::Evaluation translate(const design::Evaluation& evaluation, const optimise::Vector& x,
                                                 bool with_gradient) const;
    [[nodiscard]] design::Demand demand(bool with_gradient) const;
    /// How often each status occurred.
    [[nodiscard]] const std::map<design::EvaluationStatus, long>& statuses() const { return statuses_; }

private:
    [[nodiscard]] const design::Problem& problem() const { return evaluator_.problem(); }
    /// Constraint values and derivatives of the exclusions from row `first` on.
    void add_exclusions(const design::Evaluation& evaluation, const optimise::Vector& x, bool with_gradient, int first,
                        optimise::Evaluation& out) const;
    void write_row(const model::Specification& spec, const design::Evaluation& evaluation);

    const design::Evaluator& evaluator_;
    model::Specification fixed_;
    std::vector<ContinuousVariable> variables_;
    double objective_scale_;
    RowSink* rows_;
    std::vector<Exclusion> exclusions_;
    numerics::CancelRequest cancelled_;
    std::map<design::EvaluationStatus, long> statuses_;
};

/// Columns of the rows that DesignNlp writes: variables, objective, limited quantities, status (0 ok, 1 no impact,
/// 2 not unique, 3 unstable, 4 failed).
std::vector<Column> design_columns(const design::Problem& problem);

/// Quantities that the objective and the limits speak of, each once.
std::vector<design::Quantity> wanted_quantities(const design::Problem& problem);

}  // namespace percuss::verbs
