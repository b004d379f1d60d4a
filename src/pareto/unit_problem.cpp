#include "pareto/unit_problem.hpp"

#include "optimise/memoised_nlp.hpp"

#include <cmath>
#include <sstream>
#include <stdexcept>
#include <utility>

namespace percuss::pareto {
namespace {

std::string bits_of(const Vector& u) {
    return {reinterpret_cast<const char*>(u.data()), static_cast<std::size_t>(u.size()) * sizeof(double)};
}

void check_size(const char* what, Eigen::Index got, Eigen::Index expected) {
    if (got == expected) return;
    std::ostringstream message;
    message << "MultiObjective: " << what << " has " << got << " entries, expected " << expected;
    throw std::logic_error(message.str());
}

void check_bounds(const Vector& lower, const Vector& upper) {
    std::ostringstream message;
    if (lower.size() != upper.size() || lower.size() == 0) {
        message << "bounds: " << lower.size() << " lower and " << upper.size()
                << " upper, must be the same number and at least 1";
        throw std::invalid_argument(message.str());
    }
    for (Eigen::Index j = 0; j < lower.size(); ++j) {
        if (std::isfinite(lower[j]) && std::isfinite(upper[j]) && lower[j] < upper[j]) continue;
        message << "bounds of variable " << j << ": [" << lower[j] << ", " << upper[j]
                << "], must be finite, lower below upper";
        throw std::invalid_argument(message.str());
    }
}

}  // namespace

UnitProblem::UnitProblem(MultiObjective& problem, Budget budget)
    : problem_(problem),
      budget_(std::move(budget)),
      lower_(problem.lower()),
      upper_(problem.upper()),
      objectives_(problem.objectives()),
      constraints_(problem.constraints()) {
    check_bounds(lower_, upper_);
    check_size("the vector of bounds", lower_.size(), problem.variables());
    if (objectives_ != 2 && objectives_ != 3) {
        throw std::invalid_argument("objectives = " + std::to_string(objectives_) + ", must be 2 or 3");
    }
    if (budget_.max_evaluations < 0) {
        throw std::invalid_argument("max_evaluations = " + std::to_string(budget_.max_evaluations) + ", must be >= 0");
    }
    width_ = upper_ - lower_;
    origin_ = Vector::Zero(objectives_);
    range_ = Vector::Ones(objectives_);
}

Vector UnitProblem::point(const Vector& u) const {
    return (lower_ + width_.cwiseProduct(u)).cwiseMax(lower_).cwiseMin(upper_);
}

bool UnitProblem::halted() const {
    return evaluations_ >= budget_.max_evaluations || (budget_.cancelled && budget_.cancelled());
}

void UnitProblem::scale_objectives(const Vector& origin, const Vector& range) {
    check_size("origin", origin.size(), objectives_);
    check_size("range", range.size(), objectives_);
    if (!(range.array() > 0).all() || !range.allFinite() || !origin.allFinite()) {
        std::ostringstream message;
        message << "range of the objectives = (" << range.transpose() << "), must be positive and finite";
        throw std::invalid_argument(message.str());
    }
    origin_ = origin;
    range_ = range;
}

VectorEvaluation UnitProblem::scaled(const VectorEvaluation& raw) const {
    VectorEvaluation e = raw;
    if (!e.ok) return e;
    e.objectives = (raw.objectives - origin_).cwiseQuotient(range_);
    if (raw.gradients.size() > 0) e.gradients = range_.cwiseInverse().asDiagonal() * raw.gradients;
    return e;
}

const VectorEvaluation& UnitProblem::raw(const Vector& u) const {
    return archive_[known_.at(bits_of(u.cwiseMax(0.0).cwiseMin(1.0)))].raw;
}

VectorEvaluation UnitProblem::evaluate(const Vector& u, bool want_gradient) {
    check_size("u", u.size(), variables());
    if (u.hasNaN()) return {};
    const Vector inside = u.cwiseMax(0.0).cwiseMin(1.0);
    const std::string key = bits_of(inside);
    const auto found = known_.find(key);
    if (found == known_.end()) {
        Visited visited{inside, call(inside, want_gradient)};
        known_.emplace(key, archive_.size());
        archive_.push_back(std::move(visited));
        return scaled(archive_.back().raw);
    }
    const std::size_t place = found->second;
    const bool upgrade = want_gradient && archive_[place].raw.ok && archive_[place].raw.gradients.size() == 0;
    if (upgrade && !archive_[place].gradient_failed) {
        VectorEvaluation upgraded = call(inside, true);
        archive_[place].gradient_failed = !upgraded.ok;
        if (upgraded.ok) archive_[place].raw = std::move(upgraded);
    }
    if (want_gradient && archive_[place].gradient_failed) return {};
    return scaled(archive_[place].raw);
}

/// One counted evaluation in units of the problem, derivatives with respect to u, checked for sizes and finite entries.
VectorEvaluation UnitProblem::call(const Vector& u, bool want_gradient) {
    using optimise::Halt;
    if (budget_.cancelled && budget_.cancelled()) throw Halt(Halt::Reason::cancelled, "cancelled");
    if (evaluations_ >= budget_.max_evaluations) {
        throw Halt(Halt::Reason::budget, "max_evaluations = " + std::to_string(budget_.max_evaluations) + " spent");
    }
    ++evaluations_;
    VectorEvaluation e = problem_.evaluate(point(u), want_gradient);
    const auto failed = [&] {
        ++failures_;
        return VectorEvaluation{};
    };
    if (!e.ok) return failed();
    check_size("objectives", e.objectives.size(), objectives_);
    check_size("constraints", e.constraints.size(), constraints_);
    if (!e.objectives.allFinite() || !e.constraints.allFinite()) return failed();
    if (!want_gradient && e.gradients.size() == 0) {
        e.jacobian.resize(0, 0);
        return e;
    }
    check_size("gradients", e.gradients.size(), objectives_ * variables());
    check_size("jacobian", e.jacobian.size(), constraints_ * variables());
    if (!e.gradients.allFinite() || !e.jacobian.allFinite()) return failed();
    if (constraints_ == 0) e.jacobian.resize(0, variables());
    e.gradients = e.gradients * width_.asDiagonal();
    e.jacobian = e.jacobian * width_.asDiagonal();
    return e;
}

}  // namespace percuss::pareto
