/// \file
/// Fronts of three objectives.

#include "pareto/mesh.hpp"

#include "pareto/dominance.hpp"

#include "pareto_problems.hpp"

#include <doctest/doctest.h>

#include <algorithm>

using namespace percuss;
using namespace percuss::pareto;
using namespace percuss::test;

TEST_CASE("mesh: the octant of the sphere") {
    FunctionObjectives problem = sphere();
    FrontOptions options;
    options.points = 200;
    const Front front = mesh_front(problem, options);
    CHECK(front.status == Front::Status::points);
    CHECK(front.points.size() == 200);
    CHECK(front.evaluations == problem.calls);
    std::vector<Vector> objectives;
    double evaluations = 0;
    for (const FrontPoint& p : front.points) {
        objectives.push_back(p.objectives);
        CHECK(p.certified);
        // Anchors are known to 2e-4 in the objectives that they do not minimise.
        CHECK(p.objectives.norm() == doctest::Approx(1).epsilon(p.origin == Origin::anchor ? 3e-4 : 1e-6));
        if (p.origin == Origin::anchor) continue;
        evaluations += p.evaluations;
        // The weights are the normal of the front; at its rim others are too.
        if (p.objectives.minCoeff() < 1e-3) continue;
        CHECK((p.weights / p.weights.norm() - p.objectives).norm() < 1e-4);
    }
    CHECK(non_dominated(objectives).size() == objectives.size());
    CHECK(evaluations / 197 < 3);
    const double exact = 1 - std::acos(0.0) / 3;
    CHECK(front.hypervolume < exact);
    CHECK(front.hypervolume > 0.8 * exact);
    CHECK(exact < front.hypervolume / (1 - front.error_bound));

    // Spread: nowhere on the octant is the next point far away.
    double farthest = 0;
    for (int i = 0; i <= 20; ++i) {
        for (int j = 0; j <= 20; ++j) {
            const double a = std::acos(0.0) * i / 20, b = std::acos(0.0) * j / 20;
            const Vector z = vec({std::cos(a) * std::cos(b), std::cos(a) * std::sin(b), std::sin(a)});
            double nearest = 2;
            for (const Vector& y : objectives) nearest = std::min(nearest, (y - z).norm());
            farthest = std::max(farthest, nearest);
        }
    }
    CHECK(farthest < 0.2);
}

TEST_CASE("mesh: same bits, budget, cancelled, a limit on points") {
    FunctionObjectives problem = sphere();
    FrontOptions options;
    options.points = 30;
    const Front one = mesh_front(problem, options);
    const Front two = mesh_front(problem, options);
    REQUIRE(one.points.size() == 30);
    for (std::size_t i = 0; i < 30; ++i) CHECK(same_bits(one.points[i].x, two.points[i].x));
    problem.calls = 0;
    options.cancelled = [&] { return problem.calls >= one.anchor_evaluations + 10; };
    const Front cut = mesh_front(problem, options);
    CHECK(cut.status == Front::Status::budget);
    CHECK(problem.calls == one.anchor_evaluations + 10);
    CHECK(cut.points.size() > 3);
    FunctionObjectives two_objectives = limited_pair();
    CHECK_THROWS_AS((void)mesh_front(two_objectives, options), std::invalid_argument);
}
