#pragma once
/// \file
/// JSON, presentation and sensitivities.csv of an exploration whose rows have been read.

#include "verbs/explore/explore_results.hpp"

namespace percuss::verbs {

struct ExploreAccount {
    ExploreFacts facts;
    Survey survey;
    std::vector<OutputSensitivity> sensitivities;
    results::Shard shard;
    std::int64_t wanted = 0;  ///< rows of the shard
    bool has_table = true;    ///< false: given up, the rest speaks of a part of the rows
};

/// "done", "stopped" (goes on with --resume), "incomplete" (of a merge).
std::string status_of(const ExploreAccount& account);
std::string explore_document(const problem::ProblemFile& problem, const TableLayout& layout,
                             const ExploreAccount& account);
results::Presentation present_exploration(const problem::ProblemFile& problem, const TableLayout& layout,
                                          const ExploreAccount& account);
/// A row for each output, kind of edge and variable.
std::string sensitivities_csv(const problem::ProblemFile& problem, const std::vector<OutputSensitivity>& outputs);

}  // namespace percuss::verbs
