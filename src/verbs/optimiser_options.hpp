#pragma once
/// \file
/// [optimiser], for every verb that optimises.

#include "problem/row.hpp"

#include <string>

namespace percuss::verbs {

struct OptimiserOptions {
    std::string method = "ipopt";  ///< names of optimise::methods()
    int starts = 2;                ///< local solves per layer count
    int samples = 32;              ///< space-filling designs looked at before, per layer count
    int max_evaluations = 4000;    ///< per layer count
    double tolerance = 1e-6;       ///< KKT residual at which a point is certified
};

problem::Section optimiser_section();

}  // namespace percuss::verbs
