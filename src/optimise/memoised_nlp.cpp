#include "optimise/memoised_nlp.hpp"

#include <sstream>
#include <utility>

namespace percuss::optimise {
namespace {

const Evaluation failed_evaluation{};

/// The key of a point: the same number in other bits (-0.0) is at worst evaluated twice.
std::string bits_of(const Vector& x) {
    return {reinterpret_cast<const char*>(x.data()), static_cast<std::size_t>(x.size()) * sizeof(double)};
}

[[noreturn]] void wrong_size(const char* what, Eigen::Index got, Eigen::Index expected) {
    std::ostringstream message;
    message << "Nlp::evaluate: " << what << " has " << got << " entries, expected " << expected;
    throw std::logic_error(message.str());
}

void check_bounds(const Vector& lower, const Vector& upper) {
    if (lower.size() != upper.size() || lower.size() == 0) {
        std::ostringstream message;
        message << "bounds: " << lower.size() << " lower and " << upper.size()
                << " upper, must be the same number and at least 1";
        throw std::invalid_argument(message.str());
    }
    for (Eigen::Index j = 0; j < lower.size(); ++j) {
        if (lower[j] < upper[j]) continue;
        std::ostringstream message;
        message << "bounds of variable " << j << ": [" << lower[j] << ", " << upper[j]
                << "] is empty, lower must be below upper";
        throw std::invalid_argument(message.str());
    }
}

void check_limits(const Limits& limits) {
    std::ostringstream message;
    if (limits.max_evaluations < 0) {
        message << "max_evaluations = " << limits.max_evaluations << ", must be >= 0";
    } else if (!(limits.feasibility_tolerance >= 0)) {
        message << "feasibility_tolerance = " << limits.feasibility_tolerance << ", must be >= 0";
    } else {
        return;
    }
    throw std::invalid_argument(message.str());
}

}  // namespace

MemoisedNlp::MemoisedNlp(Nlp& nlp, Limits limits)
    : nlp_(nlp),
      limits_(std::move(limits)),
      lower_(nlp.lower()),
      upper_(nlp.upper()),
      constraints_(nlp.constraints()) {
    check_limits(limits_);
    check_bounds(lower_, upper_);
    if (nlp.variables() != variables()) wrong_size("the vector of bounds", variables(), nlp.variables());
}

const Evaluation& MemoisedNlp::look_up(const Vector& x, bool want_gradient) {
    if (x.size() != lower_.size()) wrong_size("x", x.size(), lower_.size());
    if (x.hasNaN()) return failed_evaluation;
    const Vector inside = clip(x);
    const std::string key = bits_of(inside);

    const auto found = known_.find(key);
    if (found != known_.end()) {
        Entry& entry = found->second;
        const bool has_gradient = entry.evaluation.gradient.size() > 0;
        if (!want_gradient || !entry.evaluation.ok || has_gradient) return entry.evaluation;
        // The value stays known and usable; only who wants a gradient sees a failure, and the attempt is not made
        // twice.
        if (entry.gradient_failed) return failed_evaluation;
        Evaluation upgraded = call(inside, true);
        entry.gradient_failed = !upgraded.ok;
        if (!upgraded.ok) return failed_evaluation;
        entry.evaluation = std::move(upgraded);
        return entry.evaluation;
    }
    Entry& entry = known_[key];
    try {
        entry.evaluation = call(inside, want_gradient);
    } catch (...) {
        // Halted or thrown: the point was not evaluated, and must not be remembered as failed.
        known_.erase(key);
        throw;
    }
    return entry.evaluation;
}

/// One counted evaluation, checked for sizes and finite entries. A gradient that is not finite fails the whole.
Evaluation MemoisedNlp::call(const Vector& x, bool want_gradient) {
    if (limits_.cancelled && limits_.cancelled()) throw Halt(Halt::Reason::cancelled, "cancelled");
    if (remaining() == 0) {
        throw Halt(Halt::Reason::budget, "max_evaluations = " + std::to_string(limits_.max_evaluations) + " spent");
    }
    ++evaluations_;
    Evaluation evaluation = nlp_.evaluate(x, want_gradient);
    if (!evaluation.ok) return Evaluation{};

    const Eigen::Index n = variables();
    const Eigen::Index m = constraints_;
    if (evaluation.constraints.size() != m) wrong_size("constraints", evaluation.constraints.size(), m);
    if (!std::isfinite(evaluation.objective) || !evaluation.constraints.allFinite()) return Evaluation{};
    if (want_gradient || evaluation.gradient.size() > 0) {  // one that came unasked is kept too
        if (evaluation.gradient.size() != n) wrong_size("gradient", evaluation.gradient.size(), n);
        if (evaluation.jacobian.rows() != m || (m > 0 && evaluation.jacobian.cols() != n)) {
            wrong_size("jacobian", evaluation.jacobian.size(), m * n);
        }
        if (!evaluation.gradient.allFinite() || !evaluation.jacobian.allFinite()) return Evaluation{};
        if (m == 0) evaluation.jacobian.resize(0, n);
    } else {
        evaluation.gradient.resize(0);
        evaluation.jacobian.resize(0, 0);
    }
    archive(x, evaluation);
    return evaluation;
}

void MemoisedNlp::archive(const Vector& x, const Evaluation& evaluation) {
    const double infeasibility = infeasibility_of(evaluation.constraints);
    const auto visited = [&] { return Visited{x, evaluation.objective, evaluation.constraints, infeasibility}; };
    const auto& best = best_feasible_;
    if (infeasibility <= limits_.feasibility_tolerance && (!best || evaluation.objective < best->objective)) {
        best_feasible_ = visited();
    }
    const auto& least = least_infeasible_;
    if (!least || infeasibility < least->infeasibility ||
        (infeasibility == least->infeasibility && evaluation.objective < least->objective)) {
        least_infeasible_ = visited();
    }
}

}  // namespace percuss::optimise
