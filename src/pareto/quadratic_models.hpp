#pragma once
/// \file
/// Quadratic models of all objectives and constraints around the latest point.

#include "pareto/unit_problem.hpp"

#include <vector>

namespace percuss::pareto {

/// q_i(u) = v_i + g_i . (u - base) + 1/2 (u - base)^T H_i (u - base) for objectives (i < k) and constraints (k <= i < k
/// + m): exact values and gradients at the base, and Hessians by the symmetric rank-one update (Conn, Gould and Toint,
/// Math. Prog. 50, 1991; Nocedal and Wright 2006, equation 6.24) from the gradients met so far.
///
/// One Hessian a function, rather than one of the Lagrangian: along a front the weights move from one end to the other,
/// and what was learnt stays right.
class QuadraticModels {
public:
    QuadraticModels(int variables, int functions);

    /// Moves the base to u; where there was one, its gradients and these update the Hessians. The evaluation must have
    /// gradients.
    void move_to(const Vector& u, const VectorEvaluation& here);
    /// Hessians only, from two points of known gradients.
    void learn(const Vector& u, const VectorEvaluation& here, const Vector& from, const VectorEvaluation& there);

    [[nodiscard]] bool has_base() const { return base_.size() > 0; }
    [[nodiscard]] const Vector& base() const { return base_; }
    [[nodiscard]] const VectorEvaluation& at_base() const { return at_base_; }
    [[nodiscard]] int functions() const { return static_cast<int>(hessians_.size()); }
    [[nodiscard]] Vector values(const Vector& step) const;          ///< of all functions at base + step
    [[nodiscard]] Matrix gradients(const Vector& step) const;       ///< functions x n
    [[nodiscard]] Matrix hessian(const Vector& multipliers) const;  ///< sum_i multipliers_i H_i

private:
    std::vector<Matrix> hessians_;
    Vector base_;
    VectorEvaluation at_base_;
    Vector value_;     ///< objectives, then constraints, at the base
    Matrix gradient_;  ///< likewise
};

/// Feeds the archived points with gradients within `radius` of u (infinity norm), the nearest last, at most `most`.
void learn_from_archive(QuadraticModels& models, const UnitProblem& problem, const Vector& u, double radius, int most);

}  // namespace percuss::pareto
