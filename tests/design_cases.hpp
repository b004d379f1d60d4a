#pragma once
/// \file
/// Designs as variations of the shipped problems, evaluated.

#include "design/evaluate.hpp"
#include "shipped_problem.hpp"

#include <utility>
#include <vector>

namespace percuss::test {

using Changes = std::vector<std::pair<model::Key, double>>;

inline model::Specification changed(model::Specification spec, const Changes& changes) {
    for (const auto& [key, value] : changes) { spec.set(key, value); }
    return spec;
}

inline design::Demand everything(const model::Specification& spec) {
    design::Demand demand;
    const auto all = design::reported_quantities(*spec.type);
    demand.quantities.assign(all.begin(), all.end());
    std::erase_if(demand.quantities, [](design::Quantity q) {  // needs branches to be traced: tests of their own
        return q == design::Quantity::band_lower || q == design::Quantity::band_upper;
    });
    return demand;
}

inline design::Problem nondimensional(double margin = 0.01) {
    design::Problem problem = shipped_problem("wu2022-nondimensional").design;
    problem.margin = margin;
    return problem;
}

inline design::Evaluation evaluate(const design::Problem& problem, const Changes& changes = {}) {
    const design::Evaluator evaluator(problem);
    const model::Specification spec = changed(problem.actuator, changes);
    return evaluator.evaluate(spec, everything(spec));
}

}  // namespace percuss::test
