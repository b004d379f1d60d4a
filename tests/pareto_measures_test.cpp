/// \file
/// Dominance, hypervolume and its bounds, against definitions evaluated by brute force and known shapes.

#include "pareto/dominance.hpp"
#include "pareto/hypervolume.hpp"

#include "optimise_problems.hpp"

#include <doctest/doctest.h>

#include <algorithm>
#include <random>
#include <string>

using namespace percuss;
using namespace percuss::pareto;
using test::vec;

namespace {

/// Points with coordinates in {1/levels, 2/levels, ..., 1}: few levels make many ties and duplicates.
std::vector<Vector> random_points(std::mt19937_64& random, int count, int objectives, int levels) {
    std::vector<Vector> points;
    for (int i = 0; i < count; ++i) {
        Vector p(objectives);
        for (double& v : p) v = (1.0 + static_cast<double>(random() % static_cast<unsigned>(levels))) / levels;
        points.push_back(p);
    }
    return points;
}

std::vector<std::size_t> non_dominated_by_definition(const std::vector<Vector>& points) {
    std::vector<std::size_t> kept;
    for (std::size_t i = 0; i < points.size(); ++i) {
        bool beaten = false;
        for (std::size_t j = 0; j < points.size(); ++j) {
            beaten = beaten || dominates(points[j], points[i]) || (j < i && points[j] == points[i]);
        }
        if (!beaten) kept.push_back(i);
    }
    return kept;
}

/// Sum over all subsets, with signs, of the box that all members dominate.
double hypervolume_by_inclusion_exclusion(const std::vector<Vector>& points, const Vector& reference) {
    double sum = 0.0;
    for (unsigned subset = 1; subset < (1U << points.size()); ++subset) {
        Vector worst = Vector::Constant(reference.size(), -1e300);
        double sign = -1.0;
        for (std::size_t i = 0; i < points.size(); ++i) {
            if ((subset >> i & 1U) == 0) continue;
            worst = worst.cwiseMax(points[i]);
            sign = -sign;
        }
        sum += sign * (reference - worst).cwiseMax(0.0).prod();
    }
    return sum;
}

/// Exact for points on a lattice: counts its cells.
template <class Predicate>
double volume_by_cells(int objectives, int levels, Predicate&& inside) {
    long count = 0;
    const int cells = objectives == 2 ? levels * levels : levels * levels * levels;
    for (int c = 0; c < cells; ++c) {
        Vector centre(objectives);
        int rest = c;
        for (double& v : centre) {
            v = (rest % levels + 0.5) / levels;
            rest /= levels;
        }
        count += inside(centre) ? 1 : 0;
    }
    return static_cast<double>(count) / cells;
}

bool any_below(const std::vector<Vector>& points, const Vector& z) {
    return std::any_of(points.begin(), points.end(), [&](const Vector& p) { return (p.array() <= z.array()).all(); });
}

template <class Function>
std::string message_of(Function&& function) {
    try {
        (void)function();
    } catch (const std::invalid_argument& error) { return error.what(); }
    return "";
}

}  // namespace

TEST_CASE("dominance: ties, duplicates, infinite values") {
    CHECK(dominates(vec({0, 1}), vec({0, 2})));
    CHECK_FALSE(dominates(vec({0, 1}), vec({0, 1})));
    CHECK_FALSE(dominates(vec({0, 1}), vec({1, 0})));
    CHECK_FALSE(dominates(vec({0, std::nan("")}), vec({1, 1})));
    CHECK(non_dominated({}).empty());
    CHECK(non_dominated({vec({1, 1}), vec({0, 2}), vec({1, 1}), vec({0, 3})}) == std::vector<std::size_t>{0, 1});
    CHECK(non_dominated({vec({INFINITY, 1}), vec({INFINITY, 0}), vec({1, 2})}) == std::vector<std::size_t>{1, 2});
    CHECK(non_dominated({vec({1, 1, 1}), vec({1, 1, 1}), vec({1, 1, 0})}) == std::vector<std::size_t>{2});
}

TEST_CASE("dominance: the sweeps agree with the definition") {
    std::mt19937_64 random(7);
    for (int trial = 0; trial < 400; ++trial) {
        const int objectives = 2 + trial % 2;
        const int levels = trial % 3 == 0 ? 4 : 1000;
        const std::vector<Vector> points = random_points(random, 1 + trial % 40, objectives, levels);
        CHECK(non_dominated(points) == non_dominated_by_definition(points));
    }
}

TEST_CASE("hypervolume: inclusion and exclusion, cells, order, duplicates") {
    std::mt19937_64 random(11);
    for (int trial = 0; trial < 200; ++trial) {
        const int objectives = 2 + trial % 2;
        const int levels = trial % 3 == 0 ? 5 : 1000;
        std::vector<Vector> points = random_points(random, 1 + trial % 9, objectives, levels);
        const Vector reference = Vector::Constant(objectives, 0.9);
        const double value = hypervolume(points, reference);
        CHECK(value == doctest::Approx(hypervolume_by_inclusion_exclusion(points, reference)).epsilon(1e-12));
        std::reverse(points.begin(), points.end());
        points.push_back(points.front());
        CHECK(hypervolume(points, reference) == doctest::Approx(value).epsilon(1e-12));
    }
    for (int trial = 0; trial < 20; ++trial) {
        const std::vector<Vector> points = random_points(random, 60, 2 + trial % 2, 16);
        const double cells = volume_by_cells(2 + trial % 2, 16, [&](const Vector& z) { return any_below(points, z); });
        CHECK(hypervolume(points, Vector::Ones(2 + trial % 2)) == doctest::Approx(cells).epsilon(1e-12));
    }
    CHECK(hypervolume({}, vec({1, 1})) == 0.0);
    CHECK(hypervolume({vec({1, 0})}, vec({1, 1})) == 0.0);
}

TEST_CASE("hypervolume: known shapes") {
    // The sphere octant: 1 - pi/6 is covered in the limit. The staircase of a mesh of step h misses less than the
    // surface's shadow, 3 (pi/4), times its step.
    std::vector<Vector> sphere;
    const int steps = 120;
    const double quarter = 2 * std::atan(1.0);
    for (int i = 0; i <= steps; ++i) {
        for (int j = 0; j <= steps; ++j) {
            const double a = quarter * i / steps;
            const double b = quarter * j / steps;
            sphere.push_back(vec({std::cos(a) * std::cos(b), std::cos(a) * std::sin(b), std::sin(a)}));
        }
    }
    const double exact = 1 - quarter / 3;
    const double covered = hypervolume(sphere, vec({1, 1, 1}));
    CHECK(covered < exact);
    CHECK(covered > exact - 2.4 * quarter / steps);

    // n points on the line y_1 + y_2 = 1: a staircase of n - 1 steps misses half a step's square each.
    std::vector<Vector> line;
    for (int i = 0; i <= 10; ++i) line.push_back(vec({0.1 * i, 1 - 0.1 * i}));
    CHECK(hypervolume(line, vec({1, 1})) == doctest::Approx(0.5 - 10 * 0.005));
}

TEST_CASE("hypervolume: what one point adds") {
    std::mt19937_64 random(5);
    for (int trial = 0; trial < 200; ++trial) {
        const std::vector<Vector> points = random_points(random, 1 + trial % 15, 2, trial % 2 == 0 ? 6 : 1000);
        const Vector reference = vec({0.95, 0.9});
        const std::vector<double> contributions = exclusive_contributions(points, reference);
        for (std::size_t i = 0; i < points.size(); ++i) {
            std::vector<Vector> others = points;
            others.erase(others.begin() + static_cast<std::ptrdiff_t>(i));
            const double lost = hypervolume(points, reference) - hypervolume(others, reference);
            CHECK(contributions[i] == doctest::Approx(lost).epsilon(1e-12).scale(1.0));
        }
    }
}

TEST_CASE("hypervolume: bounds of an unknown front are the cells that no point settles") {
    std::mt19937_64 random(3);
    for (int trial = 0; trial < 40; ++trial) {
        const int objectives = 2 + trial % 2;
        const std::vector<Vector> all = random_points(random, 30, objectives, 12);
        std::vector<Vector> front;
        for (const std::size_t i : non_dominated(all)) front.push_back(all[i]);
        const HypervolumeBounds bounds =
            unknown_front_bounds(front, Vector::Zero(objectives), Vector::Ones(objectives));
        const auto beats_one = [&](const Vector& z) {
            return std::any_of(front.begin(), front.end(),
                               [&](const Vector& p) { return (z.array() <= p.array()).all(); });
        };
        const double above = volume_by_cells(objectives, 12, [&](const Vector& z) { return !beats_one(z); });
        CHECK(bounds.lower == doctest::Approx(hypervolume(front, Vector::Ones(objectives))));
        CHECK(bounds.upper == doctest::Approx(above).epsilon(1e-12));
    }
}

TEST_CASE("hypervolume: bounds of a convex front enclose its true value and close as the square of the spacing") {
    // y_2 = (1 - sqrt(y_1))^2, parametrised by x: (x^2, (1 - x)^2), weights (1 - x, x). Dominated part: 1 - 1/6.
    double width = 1.0;
    for (const int n : {4, 8, 16, 32}) {
        std::vector<Vector> points;
        std::vector<Vector> weights;
        for (int i = 0; i <= n; ++i) {
            const double x = static_cast<double>(i) / n;
            points.push_back(vec({x * x, (1 - x) * (1 - x)}));
            weights.push_back(vec({1 - x, x}));
        }
        const HypervolumeBounds bounds = convex_front_bounds(points, weights, vec({1, 1}));
        CHECK(bounds.lower < 5.0 / 6);
        CHECK(bounds.upper > 5.0 / 6);
        CHECK(bounds.upper - bounds.lower < 0.3 * width);
        width = bounds.upper - bounds.lower;
        CHECK(bounds.upper < unknown_front_bounds(points, vec({0, 0}), vec({1, 1})).upper);
    }
    const HypervolumeBounds straight =
        convex_front_bounds({vec({0, 1}), vec({1, 0})}, {vec({0.5, 0.5}), vec({0.5, 0.5})}, vec({1, 1}));
    CHECK(straight.lower == doctest::Approx(0.5));
    CHECK(straight.upper == doctest::Approx(0.5));
}

TEST_CASE("IGD+ counts only what is worse") {
    CHECK(igd_plus({vec({0, 1})}, {vec({0, 1}), vec({0.5, 2})}) == 0.0);
    CHECK(igd_plus({vec({3, 4})}, {vec({0, 0})}) == 5.0);
    CHECK(igd_plus({vec({3, 4}), vec({1, 9})}, {vec({0, 0}), vec({1, 9})}) == 2.5);
    CHECK(std::isinf(igd_plus({}, {vec({0, 0})})));
}

TEST_CASE("measures refuse what is no set of points") {
    const std::vector<Vector> bad = {vec({0, 1}), vec({0, std::nan("")})};
    CHECK(message_of([&] { return non_dominated(bad); }) == "point 1 = (  0 nan), must be 2 numbers, none of them NaN");
    CHECK(message_of([&] { return hypervolume(bad, vec({1, 1})); }).starts_with("point 1"));
    CHECK(message_of([&] { return hypervolume({vec({0, 1, 2})}, vec({1, 1})); }).starts_with("point 0"));
    CHECK(message_of([&] { return hypervolume({}, vec({1, std::nan("")})); }).starts_with("reference"));
    CHECK(message_of([&] { return non_dominated({vec({1, 2, 3, 4})}); }) == "objectives = 4, must be 2 or 3");
    CHECK(message_of([&] { return unknown_front_bounds({}, vec({2, 2}), vec({1, 1})); }).starts_with("ideal"));
    CHECK(message_of([&] { return igd_plus({}, {}); }) == "igd_plus: the reference set is empty");
}
