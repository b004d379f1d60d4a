#pragma once
/// \file
/// Verb `optimise`: layers (and other integer variables) enumerated, one nonlinear program each, the best certified.
#include "numerics/cancel.hpp"
#include "verbs/study.hpp"

#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace percuss::verbs {

/// How the search for the best design, or of one integer case, ended.
enum class OptimiseStatus : std::uint8_t {
    not_run,
    optimal,        ///< feasible and certified (a KKT point, verified at a tighter tolerance)
    infeasible,     ///< no design was found that meets every limit
    not_certified,  ///< feasible, but without certificate, or refuted by another motion
    budget,         ///< cut short: evaluations spent, or cancelled
};
std::string_view to_string(OptimiseStatus status);
Ending ending_of(OptimiseStatus status);

struct LimitReport {
    std::string name;  ///< quantity, or key for a bound of a design variable
    std::string text;  ///< "amplitude <= 0.45 mm"
    double value = 0.0;
    double limit = 0.0;
    bool upper = true;
    bool active = false;
    double multiplier = 0.0;  ///< d(objective)/d(limit): what one unit more room would gain, >= 0 for maximise
};

struct IntegerCaseReport {
    double layers = 0.0;  ///< value of the enumerated variable (NaN if none)
    OptimiseStatus status = OptimiseStatus::not_run;
    double objective = design::absent;
    double kkt_residual = design::absent;
    std::vector<std::pair<model::Key, double>> design;
    std::string reason;  ///< for infeasible: the limit that cannot be met
};

/// A motion that refuted a design which was the best so far, and what became of it.
struct Counterexample {
    double layers = 0.0;  ///< value of the enumerated variable (NaN if none)
    std::vector<std::pair<model::Key, double>> design;
    double objective = design::absent;  ///< of the refuted design
    int period = 0;                     ///< drive cycles, 0 for aperiodic motions
    double peak_force = design::absent;
    double window_lower = design::absent;  ///< drive frequencies between which the motion exists there [Hz]
    double window_upper = design::absent;
    std::string remedy;  ///< "operate below the window", "operate above the window" or why nothing could be done
};

struct OptimiseStudyResult {
    Ending ending = Ending::not_run;
    OptimiseStatus status = OptimiseStatus::not_run;
    std::string reason;                                 ///< one sentence when not optimal
    std::vector<std::pair<model::Key, double>> design;  ///< design variables at the best point, SI
    design::Evaluation best;  ///< re-evaluated cold at a tighter tolerance, all quantities, with error estimates
    std::vector<LimitReport> limits;
    double kkt_residual = design::absent;
    double objective_error = design::absent;
    std::vector<IntegerCaseReport> per_layers;
    std::vector<Counterexample> counterexamples;  ///< single_stable sampled and refuted
    double objective_unrefuted = design::absent;  ///< of the best design before the first counterexample
    long evaluations = 0;
    double seconds = 0.0;
};

/// Throws std::invalid_argument for a problem without variables or without exactly one objective.
/// Rows: every evaluated design (variables, objective, limits, status).
OptimiseStudyResult run_optimise(const StudyProblem& problem, RowSink* rows, const Observer& observer,
                                 const numerics::CancelRequest& cancelled);

}  // namespace percuss::verbs
