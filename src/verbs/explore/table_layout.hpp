#pragma once
/// \file
/// Which columns an exploration has: what the journal keeps of a design, and what of that the table shows.

#include "design/evaluation.hpp"
#include "problem/problem_file.hpp"
#include "results/journal.hpp"
#include "verbs/explore/explore_options.hpp"

#include <cstddef>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace percuss::verbs {

/// Words that explore.columns takes besides quantities and keys.
inline constexpr std::string_view edge_kind_column = "edge_kind";
inline constexpr std::string_view status_column = "status";
inline constexpr std::string_view cause_column = "cause";

/// Objectives, quantities of the limits, drive_frequency, status, cause; without objectives and limits every quantity
/// that verb evaluate reports.
std::vector<std::string> default_columns(const design::Problem& problem);

/// The journal keeps the variables, keys asked for, quantities (those asked for, of the objectives and of the limits),
/// where sensitivities are wanted the derivatives d(quantity)/d(variable) in SI, then edge_kind, status and cause. The
/// table shows the row number, the variables and the columns asked for.
class TableLayout {
public:
    TableLayout(const problem::ProblemFile& problem, const ExploreOptions& options);

    [[nodiscard]] const std::vector<results::JournalColumn>& journal_columns() const { return columns_; }
    /// Places of the shown columns among those of the journal.
    [[nodiscard]] const std::vector<std::size_t>& shown() const { return shown_; }

    /// What has to be asked of an evaluation.
    [[nodiscard]] design::Demand demand() const;
    /// The row of a design. `actuator` has the variables set.
    [[nodiscard]] results::Row row(const model::Specification& actuator, const design::Evaluation& evaluation) const;
    /// The row of a design that cannot be evaluated at all.
    [[nodiscard]] results::Row failed_row(const model::Specification& actuator, const std::string& cause) const;

    [[nodiscard]] const std::vector<design::Quantity>& quantities() const { return quantities_; }

    // What a row of the journal says.
    [[nodiscard]] static double number(const results::Row& row, std::size_t place);
    [[nodiscard]] double value(const results::Row& row, design::Quantity quantity) const;
    [[nodiscard]] double variable(const results::Row& row, std::size_t i) const;
    /// d(quantity)/d(variable i) in SI; NaN where there is none. `q`: place in quantities().
    [[nodiscard]] double derivative(const results::Row& row, std::size_t q, std::size_t i) const;
    [[nodiscard]] bool has_derivatives() const { return !gradient_keys_.empty(); }
    [[nodiscard]] const std::string& edge_kind(const results::Row& row) const;
    [[nodiscard]] const std::string& status(const results::Row& row) const;
    [[nodiscard]] const std::string& cause(const results::Row& row) const;

private:
    void add_key(const problem::ProblemFile& problem, model::Key key);
    void add_quantity(const problem::ProblemFile& problem, design::Quantity quantity);
    void add_derivatives(const problem::ProblemFile& problem);
    [[nodiscard]] std::size_t place_of(std::string_view column) const;
    [[nodiscard]] results::Row row_of_keys(const model::Specification& actuator) const;

    std::vector<results::JournalColumn> columns_;
    std::vector<std::size_t> shown_;
    std::vector<model::Key> keys_;              ///< columns 0, 1, ...: the variables first
    std::vector<design::Quantity> quantities_;  ///< columns behind them
    std::vector<model::Key> gradient_keys_;
    std::vector<std::size_t> variable_of_gradient_;
    std::vector<std::vector<std::size_t>> derivative_places_;  ///< by quantity and variable; no_place: none
    bool judges_ = false;                                      ///< uniqueness is asked for
};

}  // namespace percuss::verbs
