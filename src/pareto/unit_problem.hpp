#pragma once
/// \file
/// Memory, budget, archive and scaling around an expensive vector problem.

#include "numerics/cancel.hpp"
#include "pareto/multi_objective.hpp"

#include <string>
#include <unordered_map>
#include <vector>

namespace percuss::pareto {

struct Budget {
    int max_evaluations = 20000;
    numerics::CancelRequest cancelled = {};  ///< asked before each new evaluation
};

/// The problem with variables u = (x - l)/(u - l) in [0, 1]^n and objectives y_k = (f_k - origin_k)/range_k; each u
/// (exact bits) is evaluated once. Constraints stay as they are. All derivatives are with respect to u.
///
/// A value asked for first and a gradient later cost two evaluations. An evaluation with entries that are not finite
/// counts as failed; one with wrong sizes throws std::logic_error. Not for two threads at once.
class UnitProblem {
public:
    /// Throws std::invalid_argument naming the first bound that is not finite or not (lower < upper), for other than 2
    /// or 3 objectives, and for a negative budget.
    UnitProblem(MultiObjective& problem, Budget budget);

    [[nodiscard]] int variables() const { return static_cast<int>(lower_.size()); }
    [[nodiscard]] int objectives() const { return objectives_; }
    [[nodiscard]] int constraints() const { return constraints_; }

    /// The evaluation at u, clipped to the box. Throws optimise::Halt when the budget is spent or `cancelled` is true,
    /// and whatever the problem throws.
    VectorEvaluation evaluate(const Vector& u, bool want_gradient);
    /// The same with objectives in the problem's own units, for a u that has been evaluated (std::out_of_range else).
    [[nodiscard]] const VectorEvaluation& raw(const Vector& u) const;

    /// From now on y_k = (f_k - origin_k)/range_k. Throws std::invalid_argument unless every range is positive.
    void scale_objectives(const Vector& origin, const Vector& range);
    [[nodiscard]] const Vector& origin() const { return origin_; }
    [[nodiscard]] const Vector& range() const { return range_; }

    [[nodiscard]] Vector point(const Vector& u) const;  ///< x of u
    [[nodiscard]] const Vector& width() const { return width_; }
    [[nodiscard]] int evaluations() const { return evaluations_; }
    [[nodiscard]] int failures() const { return failures_; }
    /// Whether a further evaluation would be refused.
    [[nodiscard]] bool halted() const;

    /// An evaluated point, in units of the problem's objectives.
    struct Visited {
        Vector u;
        VectorEvaluation raw;
        bool gradient_failed = false;
    };
    /// All points that could be evaluated or not, in the order in which they were first seen.
    [[nodiscard]] const std::vector<Visited>& archive() const { return archive_; }
    /// The same evaluation with scaled objectives.
    [[nodiscard]] VectorEvaluation scaled(const VectorEvaluation& raw) const;

private:
    VectorEvaluation call(const Vector& u, bool want_gradient);

    MultiObjective& problem_;
    Budget budget_;
    Vector lower_, upper_, width_;
    int objectives_ = 0;
    int constraints_ = 0;
    Vector origin_, range_;
    int evaluations_ = 0;
    int failures_ = 0;
    std::vector<Visited> archive_;
    std::unordered_map<std::string, std::size_t> known_;  ///< bits of u -> place in the archive
};

}  // namespace percuss::pareto
