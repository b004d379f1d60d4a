#pragma once
/// \file
/// Where along a front a limit or bound begins or ceases to bind.

#include "pareto/trace_nodes.hpp"

#include <functional>
#include <optional>

namespace percuss::pareto {

struct LocatedChange {
    Node node;  ///< the point of the front at the change
    bool is_bound = false;
    int index = 0;        ///< of the limit, or of the variable
    bool begins = false;  ///< to bind, towards larger y_1
    double width = 0.0;   ///< of the bracket that is left, in y
};

/// A target solved from a node, or nothing.
using CorrectFrom = std::function<std::optional<Node>(const Node& from, const Target& target)>;

/// The first limit or bound that binds (has a multiplier) at one of two neighbours and not at the other is followed
/// between them: its multiplier where it binds and minus its slack where it does not is one continuous function along
/// the front, whose root is bracketed by Illinois' regula falsi (Dowell and Jarratt, BIT 11, 1971) on the middle of the
/// chord, until it is below 1e-6 or the bracket 1e-3 of the chord, at most eight targets. Nothing where both neighbours
/// bind the same, or a target could not be solved.
[[nodiscard]] std::optional<LocatedChange> locate_change(const Node& left, const Node& right,
                                                         const CorrectFrom& correct_from);

}  // namespace percuss::pareto
