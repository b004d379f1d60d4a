#pragma once
/// \file
/// Verb `optimise`: layers (and other integer variables) enumerated, one nonlinear program each, the best certified.
#include "verbs/study.hpp"

namespace percuss::verbs {

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
    std::string status;   ///< optimal | infeasible | not-certified | budget
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
    std::string status;                                 ///< optimal | infeasible | not-certified | budget
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
                                 const StopRequest& stop);

}  // namespace percuss::verbs
