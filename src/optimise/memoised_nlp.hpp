#pragma once
/// \file
/// Memory, budget and archive around an expensive problem.

#include "numerics/cancel.hpp"
#include "optimise/nlp.hpp"

#include <optional>
#include <stdexcept>
#include <string>
#include <unordered_map>

namespace percuss::optimise {

/// Thrown by MemoisedNlp::evaluate instead of a further evaluation; also the reason why a Guard ended a run.
class Halt : public std::runtime_error {
public:
    enum class Reason { budget, cancelled, circling };
    Halt(Reason reason, const std::string& message) : std::runtime_error(message), reason_(reason) {}
    [[nodiscard]] Reason reason() const { return reason_; }

private:
    Reason reason_;
};

struct Limits {
    int max_evaluations = 2000;
    double feasibility_tolerance = 1e-9;
    numerics::CancelRequest cancelled{};  ///< asked before each new evaluation
};

/// An evaluated point.
struct Visited {
    Vector x;
    double objective = std::numeric_limits<double>::quiet_NaN();
    Vector constraints;
    double infeasibility = std::numeric_limits<double>::infinity();
};

/// Wraps a problem: clips x to the bounds, evaluates each x (exact bits) once, counts, keeps the best feasible and the
/// least infeasible point, and throws Halt when the budget is spent.
///
/// A value asked for first and a gradient later cost two evaluations; a gradient first makes the value free. A point
/// whose value failed is not asked for its gradient. An Evaluation with entries that are not finite counts as failed;
/// one with wrong sizes throws std::logic_error. Not for use from two threads at once.
class MemoisedNlp final : public Nlp {
public:
    /// Throws std::invalid_argument naming the first bound with not (lower < upper), or the limit out of range.
    MemoisedNlp(Nlp& nlp, Limits limits);

    [[nodiscard]] int variables() const override { return static_cast<int>(lower_.size()); }
    [[nodiscard]] int constraints() const override { return constraints_; }
    [[nodiscard]] Vector lower() const override { return lower_; }
    [[nodiscard]] Vector upper() const override { return upper_; }

    /// As look_up, by value.
    Evaluation evaluate(const Vector& x, bool want_gradient) override { return look_up(x, want_gradient); }

    /// The evaluation at clip(x); the reference stays valid as long as this object. `ok` is false where x has a NaN or
    /// evaluation failed. Throws Halt, and whatever the wrapped problem throws.
    const Evaluation& look_up(const Vector& x, bool want_gradient);

    /// The nearest point within the bounds.
    [[nodiscard]] Vector clip(const Vector& x) const { return x.cwiseMax(lower_).cwiseMin(upper_); }

    [[nodiscard]] int evaluations() const { return evaluations_; }
    [[nodiscard]] int remaining() const { return std::max(0, limits_.max_evaluations - evaluations_); }
    [[nodiscard]] const Limits& limits() const { return limits_; }
    /// Sets a new total budget, counted from the construction.
    void allow(int max_evaluations) { limits_.max_evaluations = max_evaluations; }

    /// Feasible point of lowest objective so far; the first of equals.
    [[nodiscard]] const std::optional<Visited>& best_feasible() const { return best_feasible_; }
    /// Point of lowest infeasibility so far; of equals the one with the lower objective, then the first.
    [[nodiscard]] const std::optional<Visited>& least_infeasible() const { return least_infeasible_; }

private:
    struct Entry {
        Evaluation evaluation;
        bool gradient_failed = false;
    };

    Evaluation call(const Vector& x, bool want_gradient);
    void archive(const Vector& x, const Evaluation& evaluation);

    Nlp& nlp_;
    Limits limits_;
    Vector lower_;
    Vector upper_;
    int constraints_ = 0;
    int evaluations_ = 0;
    std::unordered_map<std::string, Entry> known_;  ///< key: the bits of x
    std::optional<Visited> best_feasible_;
    std::optional<Visited> least_infeasible_;
};

}  // namespace percuss::optimise
