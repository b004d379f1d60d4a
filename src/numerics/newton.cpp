#include "numerics/newton.hpp"

#include <stdexcept>
#include <string>

namespace percuss::numerics {
namespace {

template <class T>
void demand(bool fine, const char* field, T value, const char* range) {
    if (fine) { return; }
    throw std::invalid_argument("Newton's method: " + std::string(field) + " = " + std::to_string(value) +
                                ", must be " + range);
}

}  // namespace

std::string_view to_string(NewtonStatus status) {
    switch (status) {
        case NewtonStatus::not_run: return "not run";
        case NewtonStatus::converged: return "converged";
        case NewtonStatus::evaluation_failed: return "evaluation failed";
        case NewtonStatus::singular: return "singular";
        case NewtonStatus::no_progress: return "no progress";
        case NewtonStatus::iteration_limit: return "iteration limit";
    }
    return "not run";
}

void check(const NewtonOptions& o) {
    demand(o.max_iterations > 0, "max_iterations", o.max_iterations, "above 0");
    demand(o.min_iterations > 0 && o.min_iterations <= o.max_iterations, "min_iterations", o.min_iterations,
           "1 to max_iterations");
    demand(o.max_halvings >= 0, "max_halvings", o.max_halvings, "0 or more");
    demand(o.residual_tolerance > 0.0, "residual_tolerance", o.residual_tolerance, "above 0");
    demand(o.step_tolerance > 0.0, "step_tolerance", o.step_tolerance, "above 0");
    demand(o.max_step > 0.0, "max_step", o.max_step, "above 0");
}

}  // namespace percuss::numerics
