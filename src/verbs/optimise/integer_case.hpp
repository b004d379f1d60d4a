#pragma once
/// \file
/// One value of the enumerated variables: its nonlinear program, what came of it, and words for why nothing did.

#include "optimise/multi_start.hpp"
#include "verbs/optimise/design_nlp.hpp"
#include "verbs/optimise/optimise.hpp"

#include <optional>
#include <string>
#include <vector>

namespace percuss::verbs {

/// One integer case solved.
struct IntegerCase {
    model::Specification fixed;
    optimise::MultiStartResult solved;
    std::optional<design::Evaluation> verified;  ///< at the tighter tolerance, all quantities
    optimise::Certificate certificate;           ///< of the verified values
    IntegerCaseReport report;
    optimise::Vector x;
    std::vector<Exclusion> exclusions;  ///< constraints made of counterexamples
    long evaluations = 0;
    bool looked_at = false;  ///< by starts (tiers 2 and 3)
    [[nodiscard]] bool optimal() const { return report.status == OptimiseStatus::optimal; }
};

/// A limit within this relative distance of its bound is active.
inline constexpr double activity = 1e-6;

/// The limits of the problem at a solved case, the windows of motions that it must avoid as limits on omega, and the
/// bounds of design variables that it presses on; multipliers in the objective's unit per unit of the limit.
std::vector<LimitReport> report_limits(const design::Problem& problem, const design::Evaluator& evaluator,
                                       const IntegerCase& best, double objective_scale);

/// Whether the objective of a is better than that of b.
bool better(const design::Problem& problem, const IntegerCase& a, const IntegerCase& b);

/// The best certified case; without one the best that could be verified; null if there is none.
const IntegerCase* best_of(const design::Problem& problem, const std::vector<IntegerCase>& cases);
IntegerCase* best_of(const design::Problem& problem, std::vector<IntegerCase>& cases);

/// All combinations of the integer variables, in order.
std::vector<model::Specification> enumerate_integers(const design::Problem& problem);

/// Value of the first integer variable; NaN without one.
double first_integer_value(const design::Problem& problem, const model::Specification& spec);

std::string describe_failures(const DesignNlp& nlp);

/// The limits that cannot be met together: those with a multiplier of the elastic problem, else the most violated one.
std::string describe_infeasible(const design::Problem& problem, const optimise::MultiStartResult& solved);

}  // namespace percuss::verbs
