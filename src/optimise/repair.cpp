#include "optimise/repair.hpp"

#include <vector>

namespace percuss::optimise {
namespace {

/// Of 0 .. count - 1, in order.
std::vector<Eigen::Index> indices_where(Eigen::Index count, const auto& condition) {
    std::vector<Eigen::Index> indices;
    for (Eigen::Index i = 0; i < count; ++i) {
        if (condition(i)) indices.push_back(i);
    }
    return indices;
}

/// The bounded least-norm step d with J_V d = r_V; in the least-squares sense if there is none.
Vector least_norm_step(const Matrix& jacobian, const Vector& wanted, const Vector& room_below,
                       const Vector& room_above) {
    const Eigen::Index n = jacobian.cols();
    Vector step = Vector::Zero(n);
    std::vector<bool> held(static_cast<std::size_t>(n), false);
    // Every round holds at least one more variable at its bound, or is the last.
    for (Eigen::Index round = 0; round < n; ++round) {
        const auto free = indices_where(n, [&](Eigen::Index j) { return !held[static_cast<std::size_t>(j)]; });
        if (free.empty()) break;
        for (const Eigen::Index j : free) step[j] = 0;
        const Matrix columns = jacobian(Eigen::all, free);
        // Least norm also where gradients are dependent or constraints fewer than variables.
        const Vector part = columns.completeOrthogonalDecomposition().solve(wanted - jacobian * step);
        bool clipped = false;
        for (std::size_t k = 0; k < free.size(); ++k) {
            const Eigen::Index j = free[k];
            const double asked = part[static_cast<Eigen::Index>(k)];
            step[j] = std::clamp(asked, room_below[j], room_above[j]);
            if (step[j] != asked) held[static_cast<std::size_t>(j)] = clipped = true;
        }
        if (!clipped) break;
    }
    return step;
}

}  // namespace

std::optional<Vector> repaired(Guard& guard, const Vector& start, const RepairOptions& options) {
    const MemoisedNlp& nlp = guard.nlp();
    const double tolerance = nlp.limits().feasibility_tolerance;
    const Vector lower = nlp.lower();
    const Vector upper = nlp.upper();

    Vector x = nlp.clip(start);
    for (int iteration = 0; iteration <= options.iterations; ++iteration) {
        const Evaluation& here = guard(x, true);
        const double infeasibility = infeasibility_of(here.constraints);
        if (!here.ok || !(infeasibility <= options.reach)) return std::nullopt;
        if (infeasibility <= tolerance) return x;
        const auto violated =
            // Active ones too: a step that mends one constraint must not push another out.
            indices_where(here.constraints.size(), [&](Eigen::Index i) { return here.constraints[i] > -tolerance; });
        const Vector values = here.constraints(violated);
        // Half a tolerance inside the limit, so that what a linear step leaves over does not end just outside again.
        const Vector wanted = Vector::Constant(values.size(), -0.5 * std::max(tolerance, 1e-14)) - values;
        x = nlp.clip(x + least_norm_step(here.jacobian(violated, Eigen::all), wanted, lower - x, upper - x));
    }
    return std::nullopt;
}

}  // namespace percuss::optimise
