#pragma once
/// \file

#include <string>
#include <vector>

namespace percuss::verbs {

struct ExploreOptions {
    int samples = 4096;                ///< rows of the table; a grid may have fewer
    std::string sampling = "sobol";    ///< names of numerics::samplings()
    std::vector<std::string> columns;  ///< quantities, keys, edge_kind, status, cause; none: default_columns()
    bool sensitivities = true;         ///< with gradients in the journal
};

}  // namespace percuss::verbs
