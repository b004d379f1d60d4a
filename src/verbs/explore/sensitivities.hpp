#pragma once
/// \file
/// Which variables matter to which quantity, from the rows of an exploration.

#include "numerics/global_sensitivity.hpp"
#include "results/journal.hpp"
#include "verbs/explore/design_space.hpp"
#include "verbs/explore/table_layout.hpp"

#include <cstdint>
#include <map>
#include <string>
#include <utility>
#include <vector>

namespace percuss::verbs {

/// The output that is 1 for a design whose status is not ok, else 0.
inline constexpr std::string_view not_ok_output = "not_ok";
/// The edge kind of figures that take all designs together.
inline constexpr std::string_view all_edges = "all";

struct OutputSensitivity {
    std::string output;     ///< a quantity, or not_ok_output
    std::string edge_kind;  ///< of the designs used; all_edges
    numerics::Sensitivity figures;
};

/// Quantities are taken from designs with status ok; the others are an output of their own. Where edges of several
/// kinds occur, each kind has figures of its own besides, since a quantity jumps from one to the other.
class SensitivityStudy {
public:
    SensitivityStudy(const TableLayout& layout, const DesignSpace& space, std::uint64_t seed);

    void add(std::int64_t number, const DesignPoint& point, const results::Row& row);
    [[nodiscard]] std::vector<OutputSensitivity> estimate() const;

private:
    using Tables = std::vector<numerics::SensitivityTable>;
    [[nodiscard]] numerics::SensitivityTable new_table() const;
    Tables& tables_of(const std::string& edge_kind);

    const TableLayout& layout_;
    int dimensions_;
    std::uint64_t seed_;
    std::vector<std::size_t> smooth_;  ///< places among the layout's quantities
    numerics::SensitivityTable not_ok_;
    std::map<std::string, Tables> by_edge_;  ///< a table for each smooth quantity
};

}  // namespace percuss::verbs
