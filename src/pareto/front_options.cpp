#include "pareto/trace.hpp"

#include <sstream>
#include <stdexcept>

namespace percuss::pareto {

const char* to_string(Front::Status status) {
    switch (status) {
        case Front::Status::not_run: return "not run";
        case Front::Status::converged: return "converged";
        case Front::Status::points: return "points";
        case Front::Status::unresolved: return "unresolved";
        case Front::Status::single: return "single";
        case Front::Status::infeasible: return "infeasible";
        case Front::Status::budget: return "budget";
    }
    return "unknown";
}

void check(const FrontOptions& options) {
    std::ostringstream message;
    if (!(options.tolerance > 0 && options.tolerance < 1)) {
        message << "tolerance = " << options.tolerance << ", must be in (0, 1)";
    } else if (options.points < 2) {
        message << "points = " << options.points << ", must be >= 2";
    } else if (!(options.certificate_tolerance > 0)) {
        message << "certificate_tolerance = " << options.certificate_tolerance << ", must be > 0";
    } else if (options.search.candidates < 1) {
        message << "candidates = " << options.search.candidates << ", must be >= 1";
    } else {
        return;
    }
    throw std::invalid_argument(message.str());
}

}  // namespace percuss::pareto
