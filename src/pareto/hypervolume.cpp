#include "pareto/hypervolume.hpp"

#include "pareto/dominance.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <sstream>
#include <stdexcept>

namespace percuss::pareto {
namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();

void check(const std::vector<Vector>& points, const Vector& reference) {
    check_points(points, reference.size());
    if (reference.allFinite()) return;
    std::ostringstream message;
    message << "reference = (" << reference.transpose() << "), must be finite";
    throw std::invalid_argument(message.str());
}

/// Indices of the points below the reference, by the given objective.
std::vector<std::size_t> inside_sorted_by(Eigen::Index objective, const std::vector<Vector>& points,
                                          const Vector& reference) {
    std::vector<std::size_t> order;
    for (std::size_t i = 0; i < points.size(); ++i) {
        if ((points[i].array() < reference.array()).all()) order.push_back(i);
    }
    std::stable_sort(order.begin(), order.end(),
                     [&](std::size_t a, std::size_t b) { return points[a][objective] < points[b][objective]; });
    return order;
}

/// The area that points of a plane dominate below a reference, while points are added.
class DominatedArea {
public:
    DominatedArea(double reference_a, double reference_b) {
        steps_.emplace(-infinity, reference_b);
        steps_.emplace(reference_a, -infinity);
    }

    [[nodiscard]] double value() const { return area_; }

    void add(double a, double b) {
        auto step = std::prev(steps_.upper_bound(a));
        if (step->second <= b) return;
        // To the right of a the border falls from `height` to b, up to the first step that is lower than b.
        double from = a;
        double height = step->second;
        auto next = std::next(step);
        while (next->second > b) {
            area_ += (next->first - from) * (height - b);
            from = next->first;
            height = next->second;
            next = steps_.erase(next);
        }
        area_ += (next->first - from) * (height - b);
        steps_.insert_or_assign(a, b);
    }

private:
    std::map<double, double> steps_;  ///< first coordinate rising, second falling, with a guard at either end
    double area_ = 0.0;
};

double area(const std::vector<Vector>& points, const Vector& reference) {
    double sum = 0.0;
    double height = reference[1];
    for (const std::size_t i : inside_sorted_by(0, points, reference)) {
        if (points[i][1] >= height) continue;
        sum += (reference[0] - points[i][0]) * (height - points[i][1]);
        height = points[i][1];
    }
    return sum;
}

double volume(const std::vector<Vector>& points, const Vector& reference) {
    DominatedArea slice(reference[0], reference[1]);
    const std::vector<std::size_t> order = inside_sorted_by(2, points, reference);
    double sum = 0.0;
    for (std::size_t k = 0; k < order.size(); ++k) {
        const Vector& p = points[order[k]];
        slice.add(p[0], p[1]);
        const double next = k + 1 < order.size() ? points[order[k + 1]][2] : reference[2];
        sum += slice.value() * (next - p[2]);
    }
    return sum;
}

/// Area of the triangle between two neighbours and the crossing of their tangents, inside the rectangle that they
/// span.
double tangent_triangle(const Vector& p, const Vector& q, const Vector& normal_p, const Vector& normal_q) {
    Eigen::Matrix2d normals;
    normals << normal_p.transpose(), normal_q.transpose();
    const Eigen::Vector2d offsets(normal_p.dot(p), normal_q.dot(q));
    const Eigen::Vector2d chord = q - p;
    // Tangents that are parallel, or cross outside because the data are not convex there, bound nothing.
    Eigen::Vector2d corner(p[0], q[1]);
    const double determinant = normals.determinant();
    if (std::abs(determinant) > 1e-14) {
        corner = normals.inverse() * offsets;
        corner = corner.cwiseMax(Eigen::Vector2d(p[0], q[1])).cwiseMin(Eigen::Vector2d(q[0], p[1]));
    } else if (std::abs(normal_p.dot(chord)) <= 1e-12 * normal_p.norm()) {
        return 0.0;  // both tangents are the chord
    }
    const Eigen::Vector2d side = corner - Eigen::Vector2d(p);
    return std::max(0.0, 0.5 * (chord[1] * side[0] - chord[0] * side[1]));
}

}  // namespace

double hypervolume(const std::vector<Vector>& points, const Vector& reference) {
    check(points, reference);
    return reference.size() == 2 ? area(points, reference) : volume(points, reference);
}

std::vector<double> exclusive_contributions(const std::vector<Vector>& points, const Vector& reference) {
    check(points, reference);
    if (reference.size() != 2) throw std::invalid_argument("exclusive_contributions: two objectives only");
    std::vector<double> contributions(points.size(), 0.0);
    const std::vector<std::size_t> inside = inside_sorted_by(0, points, reference);
    std::vector<Vector> candidates;
    candidates.reserve(inside.size());
    for (const std::size_t i : inside) candidates.push_back(points[i]);
    const std::vector<std::size_t> front = non_dominated(candidates);

    // A point that is not on the front, but dominated by one front point alone, is what that point's loss would show.
    // So besides the neighbours on the front the loss is limited by the staircase of all other points in the rectangle.
    for (std::size_t k = 0; k < front.size(); ++k) {
        const Vector& p = candidates[front[k]];
        const double right = k + 1 < front.size() ? candidates[front[k + 1]][0] : reference[0];
        const double top = k > 0 ? candidates[front[k - 1]][1] : reference[1];
        double loss = (right - p[0]) * (top - p[1]);
        double height = top;
        // Candidates with equal first objective may be sorted before the front point.
        std::size_t c = front[k];
        while (c > 0 && candidates[c - 1][0] == p[0]) --c;
        for (; c < candidates.size() && candidates[c][0] < right; ++c) {
            if (c == front[k] || candidates[c][1] >= height) continue;
            loss -= (right - candidates[c][0]) * (height - std::max(candidates[c][1], p[1]));
            height = candidates[c][1];
        }
        contributions[inside[front[k]]] = std::max(0.0, loss);
    }
    return contributions;
}

HypervolumeBounds unknown_front_bounds(const std::vector<Vector>& points, const Vector& ideal,
                                       const Vector& reference) {
    check(points, reference);
    check_points({ideal}, reference.size());
    if (!(ideal.array() <= reference.array()).all()) {
        std::ostringstream message;
        message << "ideal = (" << ideal.transpose() << "), must be at most the reference (" << reference.transpose()
                << ")";
        throw std::invalid_argument(message.str());
    }
    std::vector<Vector> mirrored;
    mirrored.reserve(points.size());
    for (const Vector& p : points) mirrored.emplace_back(-p.cwiseMax(ideal).cwiseMin(reference));
    const double box = (reference - ideal).prod();
    const double lower = hypervolume(points, reference);
    return {lower, std::max(lower, box - hypervolume(mirrored, -ideal))};
}

HypervolumeBounds convex_front_bounds(const std::vector<Vector>& points, const std::vector<Vector>& weights,
                                      const Vector& reference) {
    check(points, reference);
    check_points(weights, 2);
    if (reference.size() != 2 || weights.size() != points.size()) {
        throw std::invalid_argument("convex_front_bounds: two objectives, and one pair of weights a point");
    }
    std::vector<std::size_t> order;
    for (std::size_t i = 0; i < points.size(); ++i) {
        if ((points[i].array() <= reference.array()).all()) order.push_back(i);
    }
    std::sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) { return points[a][0] < points[b][0]; });
    HypervolumeBounds bounds{hypervolume(points, reference), 0.0};
    double above_tangents = 0.0;
    for (std::size_t k = 0; k + 1 < order.size(); ++k) {
        const Vector& p = points[order[k]];
        const Vector& q = points[order[k + 1]];
        bounds.lower += 0.5 * (q[0] - p[0]) * (p[1] - q[1]);
        above_tangents += tangent_triangle(p, q, weights[order[k]], weights[order[k + 1]]);
    }
    bounds.upper = bounds.lower + above_tangents;
    return bounds;
}

double igd_plus(const std::vector<Vector>& points, const std::vector<Vector>& reference_set) {
    if (reference_set.empty()) throw std::invalid_argument("igd_plus: the reference set is empty");
    check_points(reference_set, reference_set.front().size());
    check_points(points, reference_set.front().size());
    double sum = 0.0;
    for (const Vector& z : reference_set) {
        double nearest = infinity;
        for (const Vector& p : points) nearest = std::min(nearest, (p - z).cwiseMax(0.0).norm());
        sum += nearest;
    }
    return sum / static_cast<double>(reference_set.size());
}

}  // namespace percuss::pareto
