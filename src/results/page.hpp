#pragma once
/// \file

#include "results/presentation.hpp"

#include <string>

namespace percuss::results {

/// One HTML page that needs nothing else: the presentation, then the problem and how it was run.
std::string report_page(const Presentation& presentation, const problem::ProblemFile& problem,
                        const std::string& instruction_set);

}  // namespace percuss::results
