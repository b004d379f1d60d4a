#pragma once
/// \file
/// Verb `evaluate`.
#include "verbs/study.hpp"

namespace percuss::verbs {

struct EvaluateResult {
    Ending ending = Ending::not_run;  ///< verified: status ok or not-unique; infeasible: no-impact; else some_failed
    design::Evaluation evaluation;
    double seconds = 0.0;
};
/// gradients: with respect to the problem's design variables; without any, to every key of the family that has a
/// derivative.
EvaluateResult run_evaluate(const StudyProblem& problem, bool gradients, const numerics::CancelRequest& cancelled = {});
/// Whether an evaluation ended early because it was cancelled.
bool was_cancelled(const design::Evaluation& evaluation, const numerics::CancelRequest& cancelled);
/// Every quantity of the family that is worth its cost: band_lower and band_upper only where starts are followed anyway
/// (single_stable = sampled, refuted) or a limit or objective asks for them.
std::vector<design::Quantity> quantities_to_report(const design::Problem& problem);
/// The keys meant above.
std::vector<model::Key> gradient_keys(const design::Problem& problem);

}  // namespace percuss::verbs
