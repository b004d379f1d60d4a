#include "pareto/dominance.hpp"

#include <algorithm>
#include <limits>
#include <map>
#include <numeric>
#include <sstream>
#include <stdexcept>

namespace percuss::pareto {
namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();

/// The lower left border of the region that points of a plane dominate.
class Staircase {
public:
    /// False, and nothing is changed, when (a, b) is equal to or dominated by an earlier point.
    bool add(double a, double b) {
        const auto after = steps_.upper_bound(a);
        if (after != steps_.begin() && std::prev(after)->second <= b) return false;
        auto beaten = steps_.lower_bound(a);
        while (beaten != steps_.end() && beaten->second >= b) beaten = steps_.erase(beaten);
        steps_.emplace(a, b);
        return true;
    }

private:
    std::map<double, double> steps_;  ///< first coordinate rising, second falling
};

/// The last objective first, so that whatever dominates or equals a point comes before it.
std::vector<std::size_t> sweep_order(const std::vector<Vector>& points) {
    std::vector<std::size_t> order(points.size());
    std::iota(order.begin(), order.end(), std::size_t{0});
    std::stable_sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) {
        return std::lexicographical_compare(
            std::make_reverse_iterator(points[a].end()), std::make_reverse_iterator(points[a].begin()),
            std::make_reverse_iterator(points[b].end()), std::make_reverse_iterator(points[b].begin()));
    });
    return order;
}

}  // namespace

void check_points(const std::vector<Vector>& points, Eigen::Index objectives) {
    if (objectives != 2 && objectives != 3) {
        throw std::invalid_argument("objectives = " + std::to_string(objectives) + ", must be 2 or 3");
    }
    for (std::size_t i = 0; i < points.size(); ++i) {
        if (points[i].size() == objectives && !points[i].hasNaN()) continue;
        std::ostringstream message;
        message << "point " << i << " = (" << points[i].transpose() << "), must be " << objectives
                << " numbers, none of them NaN";
        throw std::invalid_argument(message.str());
    }
}

bool dominates(const Vector& a, const Vector& b) {
    if (a.size() != b.size()) throw std::invalid_argument("dominates: points have different numbers of objectives");
    return (a.array() <= b.array()).all() && (a.array() < b.array()).any();
}

std::vector<std::size_t> non_dominated(const std::vector<Vector>& points) {
    if (points.empty()) return {};
    const Eigen::Index objectives = points.front().size();
    check_points(points, objectives);

    std::vector<std::size_t> kept;
    Staircase staircase;
    double smallest = infinity;
    bool any = false;
    for (const std::size_t i : sweep_order(points)) {
        const Vector& p = points[i];
        if (objectives == 3) {
            if (staircase.add(p[0], p[1])) kept.push_back(i);
        } else if (!any || p[0] < smallest) {
            kept.push_back(i);
            smallest = p[0];
            any = true;
        }
    }
    std::sort(kept.begin(), kept.end());
    return kept;
}

}  // namespace percuss::pareto
