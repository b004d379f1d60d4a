#pragma once
/// \file
/// What the rows of an exploration say together, gathered row by row: memory does not grow with their number.

#include "results/journal.hpp"
#include "verbs/explore/design_space.hpp"
#include "verbs/explore/table_layout.hpp"

#include <cstdint>
#include <string>
#include <utility>
#include <vector>

namespace percuss::verbs {

/// How often a limit stood in the way, among the designs with status ok.
struct LimitCount {
    std::int64_t violated = 0;
    std::int64_t alone = 0;  ///< and no other limit was: it alone keeps the design out
};

/// A design with its distance to each limit: relative to the bound's magnitude (absolute for a bound of 0), positive
/// inside.
struct SurveyedDesign {
    std::int64_t row = -1;  ///< -1: there is none
    results::Row cells;
    std::vector<double> distances;
    [[nodiscard]] bool exists() const { return row >= 0; }
};

class Survey {
public:
    Survey(const design::Problem& problem, const TableLayout& layout);

    void add(std::int64_t number, const results::Row& row);

    [[nodiscard]] std::int64_t rows() const { return rows_; }
    /// Statuses and edge kinds that occurred, in alphabetical order; edge kinds of designs with status ok.
    [[nodiscard]] const std::vector<std::pair<std::string, std::int64_t>>& statuses() const { return statuses_; }
    [[nodiscard]] const std::vector<std::pair<std::string, std::int64_t>>& edge_kinds() const { return edge_kinds_; }
    [[nodiscard]] std::int64_t with_status(design::EvaluationStatus status) const;
    /// Status ok, as unique as asked, and within every limit.
    [[nodiscard]] std::int64_t feasible() const { return feasible_; }
    /// The feasible design best in the first objective, the first of equals.
    [[nodiscard]] const SurveyedDesign& best() const { return best_; }
    /// The design with status ok whose largest violation is the least; for tables without a feasible one.
    [[nodiscard]] const SurveyedDesign& nearest() const { return nearest_; }
    /// In the order of the problem's limits.
    [[nodiscard]] const std::vector<LimitCount>& limits() const { return limits_; }

private:
    const design::Problem& problem_;
    const TableLayout& layout_;
    std::int64_t rows_ = 0;
    std::int64_t feasible_ = 0;
    std::vector<std::pair<std::string, std::int64_t>> statuses_;
    std::vector<std::pair<std::string, std::int64_t>> edge_kinds_;
    std::vector<LimitCount> limits_;
    SurveyedDesign best_;
    SurveyedDesign nearest_;
};

}  // namespace percuss::verbs
