#pragma once
/// \file
/// The table's designs: points of the unit cube turned into values of the design variables.

#include "design/problem.hpp"
#include "numerics/sampling.hpp"
#include "verbs/explore/explore_options.hpp"

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

namespace percuss::verbs {

/// One design; an entry for each variable.
struct DesignPoint {
    std::vector<double> values;  ///< in the unit of the key
    std::vector<double> inputs;  ///< in [0, 1]; an integer variable: the middle of its value's share
    std::vector<double> slopes;  ///< d(value)/d(input); NaN for integer variables
};

/// The row of the table of samplings. Throws std::out_of_range for other names.
const numerics::Sampling& sampling_of(const std::string& name);

class DesignSpace {
public:
    /// Throws problem::ProblemError without variables or where the sampling cannot give so many samples.
    DesignSpace(const std::vector<design::DesignVariable>& variables, const ExploreOptions& options,
                std::uint64_t seed);

    [[nodiscard]] std::int64_t rows() const { return rows_; }
    [[nodiscard]] const std::vector<design::DesignVariable>& variables() const { return variables_; }
    /// Rows first ... first + count - 1, with the same bits whichever rows are asked for. From several threads at once.
    [[nodiscard]] std::vector<DesignPoint> points(std::int64_t first, std::int64_t count) const;

private:
    std::vector<design::DesignVariable> variables_;
    bool in_levels_ = false;  ///< each value of an integer variable is met equally often, logarithmic or not
    std::unique_ptr<numerics::PointSet> points_;
    std::int64_t rows_ = 0;
};

}  // namespace percuss::verbs
