#pragma once
/// \file
/// Where a front ends: the optimum of each objective alone, and the scale that these give.

#include "pareto/epsilon_constraint.hpp"
#include "pareto/front.hpp"

#include <string>
#include <vector>

namespace percuss::pareto {

struct Anchor {
    Vector u;
    optimise::Outcome::Status status = optimise::Outcome::Status::not_run;
    int evaluations = 0;
};

struct Anchors {
    /// One for each objective, empty u where nothing feasible was found.
    std::vector<Anchor> anchors;
    /// An objective does not vary between the anchors: the front is a single point (or the scale unknown).
    bool single = false;
    bool found = false;
    std::string message;
};

/// Anchor j: minimise y_j by multi-start; then, where that leaves a choice, the next objectives in turn with those
/// before held (lexicographic), so that an anchor is not only weakly optimal. Held to within 1e-9 of the range; the
/// later solve is taken only if it gains more than 2e-4 of the range of its objective, as a unique optimum too gives
/// way a little when its objective may (by about the square root of 1e-9).
///
/// Afterwards the objectives of `problem` are scaled so that the ideal point is 0 and the worst values at the anchors
/// are 1. `found` is false, with the reason in `message`, when an objective has no feasible optimum.
[[nodiscard]] Anchors find_anchors(UnitProblem& problem, const SearchOptions& options);

}  // namespace percuss::pareto
