#pragma once
/// \file
/// One objective minimised with limits on the others, by the optimisers of optimise/.

#include "optimise/multi_start.hpp"
#include "pareto/unit_problem.hpp"

#include <cstdint>
#include <vector>

namespace percuss::pareto {

/// The epsilon-constraint problem (Haimes, Lasdon and Wismer, IEEE Trans. SMC 1, 1971):
///
///     minimise y_j(u)   subject to   y_k(u) <= limit_k (k != j),   c(u) <= 0,   0 <= u <= 1
///
/// An infinite limit is none. Constraints: those of the problem, then the limits in order of their objective.
class EpsilonNlp final : public optimise::Nlp {
public:
    /// `limits`: k entries; that of objective j is not used. Throws std::invalid_argument for sizes and j.
    EpsilonNlp(UnitProblem& problem, int objective, const Vector& limits);

    [[nodiscard]] int variables() const override { return problem_.variables(); }
    [[nodiscard]] int constraints() const override;
    [[nodiscard]] Vector lower() const override { return Vector::Zero(variables()); }
    [[nodiscard]] Vector upper() const override { return Vector::Ones(variables()); }
    optimise::Evaluation evaluate(const Vector& u, bool want_gradient) override;

private:
    UnitProblem& problem_;
    int objective_;
    std::vector<int> limited_;
    Vector limits_;
};

struct SearchOptions {
    std::string method = "slsqp";
    int candidates = 32;        ///< as optimise::MultiStartOptions; the same points in every search, so paid for once
    int starts = 2;             ///< likewise
    int max_evaluations = 400;  ///< of one search, known points included
    double feasibility_tolerance = 1e-9;
    std::uint64_t seed = 1;
};

/// optimise::multi_start on an EpsilonNlp, from the warm starts first.
[[nodiscard]] optimise::MultiStartResult search(UnitProblem& problem, int objective, const Vector& limits,
                                                const std::vector<Vector>& warm_starts, const SearchOptions& options);

}  // namespace percuss::pareto
