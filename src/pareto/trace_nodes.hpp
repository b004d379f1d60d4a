#pragma once
/// \file
/// The points of a front of two objectives while it is being traced, and the gaps between them.

#include "pareto/node.hpp"

#include <vector>

namespace percuss::pareto {

/// Nodes by rising y_1 and falling y_2.
class NodeList {
public:
    /// Places the node and takes out those that it dominates. Returns its index; -1 where it is dominated by or equal
    /// to another, within 1e-9 in y.
    int insert(Node node);

    [[nodiscard]] std::size_t size() const { return nodes_.size(); }
    [[nodiscard]] Node& operator[](std::size_t i) { return nodes_[i]; }
    [[nodiscard]] const Node& operator[](std::size_t i) const { return nodes_[i]; }
    /// Rectangle right of node i in which the front may still pass.
    [[nodiscard]] double gap_area(std::size_t i) const;
    /// Of the gaps that may still be divided, the largest; -1 if none.
    [[nodiscard]] int loosest_gap() const;
    [[nodiscard]] double unexplored() const;   ///< sum of all gaps' areas
    [[nodiscard]] double hypervolume() const;  ///< in the box [0, 1]^2
    [[nodiscard]] double error_bound() const;  ///< unexplored/(hypervolume + unexplored)

private:
    std::vector<Node> nodes_;
};

}  // namespace percuss::pareto
