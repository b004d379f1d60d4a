#pragma once
/// \file
/// Results arranged for people: sentences and tables of text, the same for the terminal and for the report page.

#include "results/presentation.hpp"
#include "verbs/evaluate/evaluate.hpp"
#include "verbs/optimise/optimise.hpp"
#include "verbs/orbit/orbit.hpp"
#include "verbs/problem_file.hpp"

#include <string>
#include <vector>

namespace percuss::verbs {

using results::Block;
using results::plain_text;
using results::Presentation;

Presentation present_check(const ProblemFile& problem);
Presentation present_evaluation(const ProblemFile& problem, const verbs::EvaluateResult& result);
Presentation present_orbit(const ProblemFile& problem, const verbs::OrbitResult& result);
Presentation present_optimum(const ProblemFile& problem, const verbs::OptimiseStudyResult& result);

/// The settings of the problem, for the report page.
Block settings_block(const ProblemFile& problem);

/// One HTML page that needs nothing else: the presentation, then the problem and how it was run.
std::string report_page(const Presentation& presentation, const ProblemFile& problem,
                        const std::string& instruction_set);

}  // namespace percuss::verbs
