#pragma once
/// \file
/// Results arranged for people: sentences and tables of text, the same for the terminal and for the report page.

#include "io/problem_file.hpp"
#include "study/evaluate.hpp"
#include "study/optimise.hpp"
#include "study/orbit.hpp"

#include <string>
#include <vector>

namespace percuss::io {

/// A heading with a table below, or a sentence when there are no columns.
struct Block {
    std::string heading;
    std::string sentence;
    std::vector<std::string> columns;
    std::vector<std::vector<std::string>> rows;
};

struct Presentation {
    std::string title;
    std::vector<Block> blocks;
};

Presentation present_check(const ProblemFile& problem);
Presentation present_evaluation(const ProblemFile& problem, const study::EvaluateStudyResult& result);
Presentation present_orbit(const ProblemFile& problem, const study::OrbitStudyResult& result);
Presentation present_optimum(const ProblemFile& problem, const study::OptimiseStudyResult& result);

/// The settings of the problem, for the report page.
Block settings_block(const ProblemFile& problem);

/// For a terminal: tables with aligned columns.
std::string plain_text(const Presentation& presentation);

/// One HTML page that needs nothing else: the presentation, then the problem and how it was run.
std::string report_page(const Presentation& presentation, const ProblemFile& problem,
                        const std::string& instruction_set);

}  // namespace percuss::io
