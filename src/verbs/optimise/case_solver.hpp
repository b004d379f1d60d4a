#pragma once
/// \file
/// The nonlinear program of one integer case: solved, and what came of it verified.

#include "design/evaluate.hpp"
#include "numerics/cancel.hpp"
#include "verbs/optimise/integer_case.hpp"
#include "verbs/study.hpp"

#include <vector>

namespace percuss::verbs {

class CaseSolver {
public:
    /// Rows of the evaluated designs go to `rows`, which may be null.
    CaseSolver(const StudyProblem& problem, RowSink* rows, numerics::CancelRequest cancelled);

    /// The best design of a case by multi-start, evaluated once more, cold, at a tighter tolerance, with its
    /// certificate there. `warm_starts` are solved from first; `exclusions` are constraints besides the limits. When it
    /// is cancelled, the status is budget and the best design seen is still verified.
    IntegerCase solve(const model::Specification& fixed, const std::vector<optimise::Vector>& warm_starts,
                      const std::vector<Exclusion>& exclusions);

    /// Of the search: at tier 1 at most.
    [[nodiscard]] const design::Evaluator& evaluator() const { return evaluator_; }
    /// Of the objective: its order of magnitude, known once a case was solved.
    [[nodiscard]] double objective_scale() const { return scale_; }

private:
    [[nodiscard]] double objective_scale(const model::Specification& fixed) const;
    void solve_fixed(IntegerCase& c, DesignNlp& nlp);
    void solve_continuous(IntegerCase& c, DesignNlp& nlp, const std::vector<optimise::Vector>& warm_starts);
    [[nodiscard]] optimise::MultiStartOptions options_for(const IntegerCase& c,
                                                          const std::vector<optimise::Vector>& warm_starts) const;
    void verify(IntegerCase& c, const DesignNlp& nlp);
    void settle(IntegerCase& c, const DesignNlp& nlp) const;

    const StudyProblem& problem_;
    design::Problem design_;
    design::Evaluator evaluator_;
    design::Evaluator tight_evaluator_;
    RowSink* rows_;
    numerics::CancelRequest cancelled_;
    double scale_ = 0.0;
};

/// The problem with an integrator a hundred times tighter, at which a claimed optimum is verified.
design::Problem tightened(design::Problem problem);

}  // namespace percuss::verbs
