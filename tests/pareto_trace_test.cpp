/// \file
/// Fronts of two objectives, traced, against fronts known exactly.

#include "pareto/trace.hpp"

#include "pareto/dominance.hpp"
#include "pareto/hypervolume.hpp"

#include "pareto_problems.hpp"

#include <doctest/doctest.h>

#include <algorithm>
#include <string>

using namespace percuss;
using namespace percuss::pareto;
using namespace percuss::test;

namespace {

/// Evaluations a point, of those that tracing and division found.
double evaluations_a_point(const Front& front) {
    double sum = 0;
    double count = 0;
    for (const FrontPoint& p : front.points) {
        if (p.origin != Origin::traced && p.origin != Origin::bisected) continue;
        sum += p.evaluations;
        ++count;
    }
    return sum / count;
}

double largest_error(const Front& front, double (*exact)(double)) {
    double worst = 0;
    for (const FrontPoint& p : front.points)
        worst = std::max(worst, std::abs(p.objectives[1] - exact(p.objectives[0])));
    return worst;
}

void check_points_of(const Front& front) {
    std::vector<Vector> objectives;
    for (std::size_t i = 0; i < front.points.size(); ++i) {
        const FrontPoint& p = front.points[i];
        CHECK(p.certified);
        CHECK(p.kkt_residual <= 1e-6);
        CHECK(p.infeasibility <= 1e-9);
        CHECK(p.weights.sum() == doctest::Approx(1));
        CHECK(p.weights.minCoeff() >= 0);
        if (i > 0) CHECK(p.objectives[0] > front.points[i - 1].objectives[0]);
        objectives.push_back(p.objectives);
    }
    CHECK(non_dominated(objectives).size() == objectives.size());
    CHECK(front.gaps.size() + 1 == front.points.size());
}

/// What the front should be: the curve's samples that no other dominates.
std::vector<Vector> best_of(const std::vector<Vector>& samples) {
    std::vector<Vector> best;
    for (const std::size_t i : non_dominated(samples)) best.push_back(samples[i]);
    return best;
}

/// The front must not be beaten by the reference, must not beat it, and its bound must contain the reference's
/// hypervolume (which samples know to `fine`).
void compare(const Front& front, const std::vector<Vector>& reference, double fine) {
    double worst = 0;
    std::vector<Vector> points;
    for (const FrontPoint& p : front.points) {
        points.push_back(p.objectives);
        for (const Vector& z : reference) worst = std::max(worst, (p.objectives - z).minCoeff());
    }
    CHECK(worst <= fine);
    CHECK(igd_plus(reference, points) <= fine);
    const double box = (front.nadir - front.ideal).prod();
    const double exact = hypervolume(reference, front.nadir) / box;
    CHECK(front.hypervolume <= exact + fine);
    CHECK(exact <= front.hypervolume / (1 - front.error_bound) + fine);
    CHECK(hypervolume(points, front.nadir) / box == doctest::Approx(front.hypervolume).epsilon(1e-12));
}

template <class Function>
std::string message_of(Function&& function) {
    try {
        (void)function();
    } catch (const std::invalid_argument& error) { return error.what(); }
    return "";
}

}  // namespace

TEST_CASE("trace: quadratic pair with a limit that begins to bind") {
    FunctionObjectives problem = limited_pair();
    const Front front = trace_front(problem, {});
    CHECK(front.status == Front::Status::converged);
    CHECK(front.error_bound <= 1e-2);
    CHECK(front.evaluations == problem.calls);
    CHECK_FALSE(problem.outside);
    check_points_of(front);
    CHECK(largest_error(front, limited_pair_front) < 1e-6);
    CHECK(evaluations_a_point(front) < 1.2);
    for (const FrontPoint& p : front.points) {
        const double s = p.x[0];
        CHECK(p.weights[0] == doctest::Approx(1 - s).epsilon(1e-4).scale(1));
        CHECK(p.multipliers[0] == doctest::Approx(std::max(0.0, 2 * (s - 0.4))).epsilon(1e-4).scale(1));
        if (s > 0.01) CHECK(slope(p) == doctest::Approx(-(1 - s) / s).epsilon(1e-4));
        CHECK(p.active_limits.empty() == (s < 0.4 - 1e-5));
    }
    REQUIRE(front.changes.size() == 1);
    CHECK_FALSE(front.changes[0].is_bound);
    CHECK(front.changes[0].begins);
    CHECK(front.changes[0].width < 1e-3);
    const Vector at = front.points[front.changes[0].point].objectives;
    CHECK((at - vec({0.32, 0.72})).norm() < 1e-3);
}

TEST_CASE("trace: the same with a bound in place of the limit") {
    FunctionObjectives problem = bounded_pair();
    const Front front = trace_front(problem, {});
    CHECK(front.status == Front::Status::converged);
    check_points_of(front);
    CHECK(largest_error(front, limited_pair_front) < 1e-6);
    REQUIRE(front.changes.size() == 1);
    CHECK(front.changes[0].is_bound);
    CHECK(front.changes[0].index == 1);
    for (const FrontPoint& p : front.points) {
        CHECK(p.bound_multipliers[1] == doctest::Approx(std::max(0.0, 2 * (p.x[0] - 0.4))).epsilon(1e-4).scale(1));
    }
}

TEST_CASE("trace: BNH, objectives of unlike size") {
    FunctionObjectives problem = binh_korn();
    const Front front = trace_front(problem, {});
    CHECK(front.status == Front::Status::converged);
    check_points_of(front);
    CHECK(largest_error(front, binh_korn_front) < 1e-6);
    CHECK(evaluations_a_point(front) < 1.2);
    CHECK((front.ideal - vec({0, 4})).norm() < 1e-6);
    CHECK((front.nadir - vec({136, 50})).norm() < 1e-3);
    for (const FrontPoint& p : front.points) {
        const double s = p.x[0];
        if (s > 0.1) CHECK(slope(p) == doctest::Approx((s - 5) / (4 * s)).epsilon(1e-4).scale(1));
    }
}

TEST_CASE("trace: functions that are not quadratic cost a few evaluations a point") {
    FunctionObjectives problem = bent_valley();
    const Front front = trace_front(problem, {});
    CHECK(front.status == Front::Status::converged);
    check_points_of(front);
    CHECK(largest_error(front, [](double f) { return 1 / (1 + f); }) < 1e-6);
    CHECK(evaluations_a_point(front) <= 3);
    for (const FrontPoint& p : front.points) {
        CHECK(slope(p) == doctest::Approx(-std::exp(-2 * p.x[0])).epsilon(1e-4).scale(1));
    }
}

TEST_CASE("trace: pieces that tracing cannot join are found") {
    SUBCASE("a wave") {
        FunctionObjectives problem = wavy();
        const Front front = trace_front(problem, {});
        CHECK(front.status == Front::Status::converged);
        check_points_of(front);
        std::vector<Vector> samples;
        for (int i = 0; i <= 20000; ++i) samples.push_back(vec({i / 20000.0, wave(i / 20000.0)}));
        compare(front, best_of(samples), 2e-4);
        CHECK(std::count_if(front.gaps.begin(), front.gaps.end(), [](const Gap& gap) { return gap.jump; }) == 3);
    }
    SUBCASE("TNK") {
        FunctionObjectives problem = tanaka();
        const Front front = trace_front(problem, {});
        check_points_of(front);
        std::vector<Vector> samples;
        for (int i = 0; i <= 20000; ++i) {
            const double angle = std::acos(0.0) * i / 20000;
            const double r = std::sqrt(1 + 0.1 * std::cos(16 * angle));
            const Vector x = r * vec({std::sin(angle), std::cos(angle)});
            if ((x - vec({0.5, 0.5})).squaredNorm() <= 0.5 && x.minCoeff() >= 1e-3) samples.push_back(x);
        }
        compare(front, best_of(samples), 2e-4);
        for (const FrontPoint& p : front.points) {
            const double angle = std::atan2(p.x[0], p.x[1]);
            // Ends of a piece lie on the other limit or on this curve alike.
            CHECK(p.x.squaredNorm() - 1 - 0.1 * std::cos(16 * angle) == doctest::Approx(0).scale(1).epsilon(1e-6));
        }
    }
}

TEST_CASE("trace: a part of the box that cannot be evaluated") {
    SUBCASE("beside the front: nothing changes") {
        FunctionObjectives problem(vec({-1, -1}), vec({2, 2}), 2, 1, [](const Vector& x, VectorEvaluation& e) {
            quadratic_pair(x, e);
            e.constraints << x[1] - 0.4;
            e.jacobian << 0, 1;
            e.ok = x[1] <= x[0] + 0.05;
        });
        const Front front = trace_front(problem, {});
        CHECK(front.status == Front::Status::converged);
        CHECK(front.failures > 5);
        check_points_of(front);
        CHECK(largest_error(front, limited_pair_front) < 1e-6);
    }
    SUBCASE("across the front: what is left of it") {
        FunctionObjectives problem(vec({-1, -1}), vec({2, 2}), 2, 1, [](const Vector& x, VectorEvaluation& e) {
            quadratic_pair(x, e);
            e.constraints << x[1] - 0.4;
            e.jacobian << 0, 1;
            e.ok = !(x[0] > 0.6 && x[0] < 0.7);
        });
        const Front front = trace_front(problem, {});
        CHECK(front.failures > 0);
        CHECK(front.points.front().x.norm() < 1e-4);
        CHECK((front.points.back().x - vec({1, 0.4})).norm() < 1e-4);
        long certified = 0;
        for (const FrontPoint& p : front.points) {
            CHECK_FALSE((p.x[0] > 0.6 && p.x[0] < 0.7));
            CHECK(p.infeasibility <= 1e-9);
            if (!p.certified) continue;
            ++certified;
            CHECK(p.objectives[1] == doctest::Approx(limited_pair_front(p.objectives[0])).epsilon(1e-6));
        }
        CHECK(certified > 50);
        CHECK(front.evaluations < 15000);
    }
}

TEST_CASE("trace: same seed, same bits; another budget ends early with what is known") {
    FunctionObjectives problem = wavy();
    const Front one = trace_front(problem, {});
    const Front two = trace_front(problem, {});
    REQUIRE(one.points.size() == two.points.size());
    for (std::size_t i = 0; i < one.points.size(); ++i) CHECK(same_bits(one.points[i].x, two.points[i].x));

    FrontOptions options;
    options.max_evaluations = one.anchor_evaluations + 20;
    problem.calls = 0;
    const Front cut = trace_front(problem, options);
    CHECK(cut.status == Front::Status::budget);
    CHECK(problem.calls == options.max_evaluations);
    CHECK(cut.points.size() > 5);
    CHECK(cut.error_bound > 1e-2);

    for (const int calls : {0, 10, 150, 250}) {
        problem.calls = 0;
        options = {};
        options.cancelled = [&] { return problem.calls >= calls; };
        CHECK(trace_front(problem, options).status == Front::Status::budget);
        CHECK(problem.calls == calls);
    }
}

TEST_CASE("trace: the limit on points is kept, and they are spread") {
    FunctionObjectives problem = limited_pair();
    FrontOptions options;
    options.points = 12;
    options.tolerance = 1e-4;
    const Front front = trace_front(problem, options);
    CHECK(front.status == Front::Status::points);
    CHECK(front.points.size() == 12);
    double largest = 0;
    for (const Gap& gap : front.gaps) largest = std::max(largest, gap.area);
    CHECK(largest < 0.03);
}

TEST_CASE("trace: no front, no conflict, no sense") {
    FunctionObjectives never(vec({0}), vec({1}), 2, 1, [](const Vector& x, VectorEvaluation& e) {
        e.objectives << x[0], 1 - x[0];
        e.gradients << 1, -1;
        e.constraints << 1 + x[0];
        e.jacobian << 1;
    });
    CHECK(trace_front(never, {}).status == Front::Status::infeasible);
    FunctionObjectives agreed(vec({0}), vec({1}), 2, 0, [](const Vector& x, VectorEvaluation& e) {
        e.objectives << x[0], 3 + x[0] * x[0];
        e.gradients << 1, 2 * x[0];
    });
    const Front single = trace_front(agreed, {});
    CHECK(single.status == Front::Status::single);
    CHECK(single.points.size() == 1);
    FunctionObjectives failing(vec({0}), vec({1}), 2, 0, [](const Vector&, VectorEvaluation& e) { e.ok = false; });
    CHECK(trace_front(failing, {}).status == Front::Status::infeasible);

    FrontOptions options;
    options.tolerance = 0;
    CHECK(message_of([&] { return trace_front(agreed, options); }) == "tolerance = 0, must be in (0, 1)");
    FunctionObjectives three = sphere();
    CHECK(message_of([&] { return trace_front(three, {}); }).starts_with("objectives = 3"));
    FunctionObjectives open(vec({0}), vec({INFINITY}), 2, 0, [](const Vector&, VectorEvaluation&) {});
    CHECK(message_of([&] { return trace_front(open, {}); }).starts_with("bounds of variable 0"));
}

TEST_CASE("merged fronts: dominance between the cases") {
    const auto front_of = [](double shift, double limit) {
        FunctionObjectives problem(vec({-1}), vec({limit}), 2, 0, [shift](const Vector& x, VectorEvaluation& e) {
            e.objectives << x[0] * x[0] + shift, (x[0] - 1) * (x[0] - 1);
            e.gradients << 2 * x[0], 2 * (x[0] - 1);
        });
        return trace_front(problem, {}).points;
    };
    // The second case costs 0.05 of f_1 everywhere, but the first cannot go beyond x = 0.5, f = (0.25, 0.25).
    const auto first = front_of(0.0, 0.5);
    const auto merged = merge_fronts({first, front_of(0.05, 2.0), first});
    REQUIRE(merged.size() > first.size());
    for (const FrontPoint& p : merged) CHECK(p.case_index == (p.objectives[1] >= 0.25 - 1e-12 ? 0 : 1));
    CHECK(merged.front().objectives[1] == doctest::Approx(1));
    CHECK(merged.back().objectives[0] == doctest::Approx(1.05));
    CHECK(merge_fronts({}).empty());
}
