#include "pareto/trace_nodes.hpp"

#include "pareto/dominance.hpp"
#include "pareto/hypervolume.hpp"

#include <algorithm>

namespace percuss::pareto {
namespace {

/// Two corrections of the same point differ by about the square of the certificate's tolerance in y.
constexpr double same_point = 1e-9;

}  // namespace

int NodeList::insert(Node node) {
    const auto beaten_by = [&](const Node& other) {
        return other.y1() <= node.y1() + same_point && other.y2() <= node.y2() + same_point;
    };
    if (std::any_of(nodes_.begin(), nodes_.end(), beaten_by)) return -1;
    const std::size_t before = nodes_.size();
    std::erase_if(nodes_, [&](const Node& other) { return dominates(node.here.objectives, other.here.objectives); });
    const bool contradicted = nodes_.size() != before;

    const auto place = std::upper_bound(nodes_.begin(), nodes_.end(), node,
                                        [](const Node& a, const Node& b) { return a.y1() < b.y1(); });
    node.explored = place != nodes_.end() ? place->y2() : 0.0;
    if (place != nodes_.begin()) {
        Node& left = *std::prev(place);
        // What was found empty between the left and right neighbours stays so, unless this node disproves it.
        if (!contradicted && place != nodes_.end() && left.explored <= node.y2()) {
            node.explored = std::max(node.explored, left.explored);
        }
        left.explored = node.y2();
        left.local_failed = left.jump = left.given_up = false;
    }
    const auto index = static_cast<int>(place - nodes_.begin());
    nodes_.insert(place, std::move(node));
    return index;
}

double NodeList::gap_area(std::size_t i) const {
    if (i + 1 >= nodes_.size()) return 0.0;
    return (nodes_[i + 1].y1() - nodes_[i].y1()) * std::max(0.0, nodes_[i].y2() - nodes_[i].explored);
}

int NodeList::loosest_gap() const {
    int loosest = -1;
    double largest = 0.0;
    for (std::size_t i = 0; i + 1 < nodes_.size(); ++i) {
        if (nodes_[i].given_up || gap_area(i) <= largest) continue;
        largest = gap_area(i);
        loosest = static_cast<int>(i);
    }
    return loosest;
}

double NodeList::unexplored() const {
    double sum = 0.0;
    for (std::size_t i = 0; i < nodes_.size(); ++i) sum += gap_area(i);
    return sum;
}

double NodeList::hypervolume() const {
    std::vector<Vector> points;
    for (const Node& node : nodes_) points.push_back(node.here.objectives);
    return pareto::hypervolume(points, Vector::Ones(2));
}

double NodeList::error_bound() const {
    const double open = unexplored();
    return open > 0 ? open / (hypervolume() + open) : 0.0;
}

}  // namespace percuss::pareto
