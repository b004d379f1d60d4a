#include "verbs/optimiser_options.hpp"

#include "optimise/solve.hpp"
#include "problem/row_types.hpp"

namespace percuss::verbs {

problem::Section optimiser_section() {
    using namespace problem;
    using Options = OptimiserOptions;
    return section_of<Options>({
        word<Options>("optimiser.method", &Options::method, optimise::methods(), "optimiser"),
        count<Options>("optimiser.starts", &Options::starts, Whole{1}, "local solves per layer count"),
        count<Options>("optimiser.samples", &Options::samples, Whole{0},
                       "space-filling designs looked at before, per layer count"),
        count<Options>("optimiser.max_evaluations", &Options::max_evaluations, Whole{1}, "budget per layer count"),
        number<Options>("optimiser.tolerance", &Options::tolerance, Between{0.0, 1.0},
                        "KKT residual at which a point is certified"),
    });
}

}  // namespace percuss::verbs
