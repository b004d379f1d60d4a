#pragma once
/// \file
/// Verb `explore`: designs spread over the design space, evaluated block by block into a journal.

#include "results/journal.hpp"
#include "verbs/explore/design_space.hpp"
#include "verbs/explore/table_layout.hpp"
#include "verbs/study.hpp"

#include <cstdint>
#include <string>

namespace percuss::verbs {

/// All that decides about the rows of a table: the same exploration gives the same bytes, whoever computes its blocks.
class Exploration {
public:
    /// Throws problem::ProblemError without variables or for a number of samples that the sampling cannot give.
    Exploration(const problem::ProblemFile& problem, const std::string& instruction_set);

    [[nodiscard]] const DesignSpace& space() const { return space_; }
    [[nodiscard]] const TableLayout& layout() const { return layout_; }
    /// Kind "explore", the problem as text (exploration_text.hpp) and the columns.
    [[nodiscard]] const results::JournalWork& work() const { return work_; }

private:
    DesignSpace space_;
    TableLayout layout_;
    results::JournalWork work_;
};

/// What one run added to the journal.
struct ExploreProgress {
    bool is_complete = false;  ///< the journal holds all blocks of its shard
    std::int64_t designs = 0;  ///< rows added
    double seconds = 0.0;
};

/// Evaluates the blocks that the journal lacks, each design by itself and each block by one of `problem.jobs` threads;
/// the calling thread writes. A design that cannot be evaluated keeps its row, with the status failed and the cause.
/// When cancelled, blocks under way are dropped. Throws results::JournalError when the journal cannot be written.
ExploreProgress explore(const StudyProblem& problem, const Exploration& exploration, results::Journal& journal,
                        const Observer& observer, const numerics::CancelRequest& cancelled);

}  // namespace percuss::verbs
