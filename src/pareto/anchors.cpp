#include "pareto/anchors.hpp"

#include "optimise/halton.hpp"

#include <cmath>
#include <limits>

namespace percuss::pareto {
namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();
constexpr double held_within = 1e-9;     // see the header
constexpr double least_gain = 2e-4;      // see the header
constexpr double smallest_range = 1e-9;  // of an objective, relative to its magnitude: below this it does not vary

/// The first scale: what the objectives range over among points that fill the box.
void scale_by_candidates(UnitProblem& problem, const SearchOptions& options) {
    const optimise::Halton sequence(problem.variables(), options.seed);
    Vector lowest = Vector::Constant(problem.objectives(), infinity);
    Vector highest = -lowest;
    for (int k = 0; k < options.candidates; ++k) {
        const VectorEvaluation here = problem.evaluate(sequence.point(static_cast<std::uint64_t>(k)), false);
        if (!here.ok) continue;
        lowest = lowest.cwiseMin(here.objectives);
        highest = highest.cwiseMax(here.objectives);
    }
    Vector range = highest - lowest;
    for (double& r : range) r = std::isfinite(r) && r > 0 ? r : 1.0;
    problem.scale_objectives(lowest.array().isFinite().select(lowest, 0.0), range);
}

Anchor find_anchor(UnitProblem& problem, int first, const SearchOptions& options) {
    Anchor anchor;
    const int before = problem.evaluations();
    Vector limits = Vector::Constant(problem.objectives(), infinity);
    for (int turn = 0; turn < problem.objectives(); ++turn) {
        const int objective = (first + turn) % problem.objectives();
        std::vector<Vector> warm;
        if (turn > 0) warm.push_back(anchor.u);
        const optimise::MultiStartResult result = search(problem, objective, limits, warm, options);
        if (turn == 0) {
            anchor.status = result.best.status;
            if (!result.best.feasible) break;
            anchor.u = result.best.x;
        } else {
            const double now = problem.evaluate(anchor.u, false).objectives[objective];
            if (result.best.feasible && result.best.objective < now - least_gain) anchor.u = result.best.x;
        }
        limits[objective] = problem.evaluate(anchor.u, false).objectives[objective] + held_within;
    }
    anchor.evaluations = problem.evaluations() - before;
    return anchor;
}

}  // namespace

Anchors find_anchors(UnitProblem& problem, const SearchOptions& options) {
    Anchors result;
    scale_by_candidates(problem, options);
    for (int j = 0; j < problem.objectives(); ++j) {
        result.anchors.push_back(find_anchor(problem, j, options));
        if (result.anchors.back().u.size() > 0) continue;
        result.message =
            std::string("objective ") + std::to_string(j) + ": " + optimise::to_string(result.anchors.back().status);
        return result;
    }
    result.found = true;
    Vector ideal = Vector::Constant(problem.objectives(), infinity);
    Vector nadir = -ideal;
    for (const Anchor& anchor : result.anchors) {
        const Vector& f = problem.raw(anchor.u).objectives;
        ideal = ideal.cwiseMin(f);
        nadir = nadir.cwiseMax(f);
    }
    const Vector range = nadir - ideal;
    result.single =
        !(range.array() > smallest_range * nadir.cwiseAbs().cwiseMax(ideal.cwiseAbs()).cwiseMax(1e-300).array()).all();
    if (!result.single) problem.scale_objectives(ideal, range);
    return result;
}

}  // namespace percuss::pareto
