// Search of a box: candidates, local solves, the elastic phase that names limits that cannot be met, polish.

#include "optimise/elastic_nlp.hpp"
#include "optimise/multi_start.hpp"
#include "optimise_problems.hpp"

#include <doctest/doctest.h>

#include <algorithm>
#include <limits>
#include <stdexcept>
#include <string>

using namespace percuss::test;
using namespace percuss::optimise;
using Status = Outcome::Status;

namespace {

/// cos 3x + cos 2y + 0.3 x with x y <= 0.8, not defined in a ball and in a corner, a third of the box. Global minimum:
/// 3 sin 3x = 0.3 next to x = -pi/3, y = pi/2 (the minimum at y = -pi/2 is not feasible, that at x > 0 is higher).
FunctionNlp waves_with_holes() {
    return {vec({-2, -2}), vec({2, 2}), 1, [](const Vector& x, Evaluation& e) {
                e.ok = (x - vec({-0.5, 0.2})).norm() > 1.0 && x[0] + x[1] < 1.9;
                e.objective = std::cos(3 * x[0]) + std::cos(2 * x[1]) + 0.3 * x[0];
                e.gradient << 0.3 - 3 * std::sin(3 * x[0]), -2 * std::sin(2 * x[1]);
                e.constraints << x[0] * x[1] - 0.8;
                e.jacobian << x[1], x[0];
            }};
}
const Vector waves_minimum = vec({-(std::acos(-1.0) - std::asin(0.1)) / 3 - 2 * std::asin(0.1) / 3, std::acos(0.0)});

/// A disc of radius 0.01 to be found in a box 4 wide; the smallest x_0 in it is 0.3.
FunctionNlp needle() {
    return {vec({-2, -2}), vec({2, 2}), 1, [](const Vector& x, Evaluation& e) {
                const Vector d = x - vec({0.31, 0.77});
                e.objective = x[0];
                e.gradient << 1, 0;
                e.constraints << d.squaredNorm() - 1e-4;
                e.jacobian.row(0) = 2 * d.transpose();
            }};
}

MultiStartOptions with_method(const std::string& method) {
    MultiStartOptions options;
    options.solver.method = method;
    return options;
}

}  // namespace

TEST_CASE("the global minimum among several, with regions that cannot be evaluated") {
    for (const std::string method : {"ipopt", "slsqp", "cobyla", "direct-l"}) {
        CAPTURE(method);
        FunctionNlp nlp = waves_with_holes();
        const MultiStartResult result = multi_start(nlp, with_method(method));
        CHECK(result.best.status == Status::converged);
        CHECK((result.best.x - waves_minimum).norm() < 1e-6);
        CHECK(result.certificate.certified(1e-6));
        CHECK(result.candidates_evaluated == 32);
        CHECK(result.candidates_failed > 5);
        CHECK(result.locals.size() == (method == "direct-l" ? 1 : 2));
        CHECK(result.best.evaluations == nlp.calls);
    }
}

TEST_CASE("known problems are certified, whichever method begins") {
    for (const std::string method : {"ipopt", "slsqp", "mma", "ccsaq", "cobyla", "mlsl"}) {
        for (const auto& problem : {rosenbrock_disc, hs43, hs71, hs100}) {
            CAPTURE(method);
            Known known = problem();
            const MultiStartResult result = multi_start(*known.nlp, with_method(method));
            CHECK(result.best.status == Status::converged);
            CHECK(result.certificate.certified(1e-6));
            CHECK(certificate_at(*known.nlp, result.best.x).certified(1e-6));
            CHECK(result.best.objective == doctest::Approx(known.objective).epsilon(1e-7));
            CHECK(result.best.feasible);
        }
    }
}

TEST_CASE("polish: a solver's poor answer is brought to a certificate") {
    Known known = hs71();
    MultiStartOptions options = with_method("mma");  // ends far from the minimum from this start
    options.candidates = 0;
    options.warm_starts = {known.start};
    const MultiStartResult result = multi_start(*known.nlp, options);
    CHECK(result.locals.front().objective > known.objective + 1);
    CHECK(result.best.status == Status::converged);
    CHECK(result.best.objective == doctest::Approx(known.objective));
    CHECK((result.certificate.multipliers - vec({0.55229366, 0.16146857})).norm() < 1e-5);

    options.polish_rounds = 0;
    Known again = hs71();
    const MultiStartResult rough = multi_start(*again.nlp, options);
    CHECK(rough.best.status == Status::failed);
    CHECK(rough.best.feasible);
    CHECK(rough.best.message.starts_with("not certified: KKT residual"));
}

TEST_CASE("of points as good as each other the one nearer to optimality is taken") {
    for (const auto& problem : {rosenbrock_disc, hs43, hs100}) {
        Known known = problem();
        MultiStartOptions options = with_method("slsqp");
        options.polish_rounds = 0;  // SLSQP passes points that are lower and infeasible by less than the tolerance
        const MultiStartResult result = multi_start(*known.nlp, options);
        CHECK(result.best.status == Status::converged);
        CHECK(result.certificate.residual < 1e-7);
    }
}

TEST_CASE("nothing feasible: the limits in conflict are named") {
    for (const std::string method : {"ipopt", "slsqp", "cobyla", "isres"}) {
        CAPTURE(method);
        const auto nlp = contradiction();
        const MultiStartResult result = multi_start(*nlp, with_method(method));
        CHECK(result.best.status == Status::infeasible);
        CHECK_FALSE(result.best.feasible);
        CHECK((result.best.x - vec({1, 1})).norm() < 1e-5);
        CHECK((result.best.constraints - vec({1, 1, -0.9})).norm() < 1e-5);
        CHECK(result.best.infeasibility == doctest::Approx(1.0));
        CHECK((result.certificate.multipliers - vec({1.0 / 3, 2.0 / 3, 0})).norm() < 1e-5);
        CHECK(result.certificate.residual < 1e-6);
        CHECK(result.certificate.bound_multipliers.size() == 2);
    }
    // One limit that the bounds alone forbid: it is the one, and the bound that stops it is seen to press.
    FunctionNlp narrow(vec({0, 0}), vec({1, 1}), 2, [](const Vector& x, Evaluation& e) {
        e.objective = x[1];
        e.gradient << 0, 1;
        e.constraints << x[1] - 0.5, 1.5 - x[0];
        e.jacobian << 0, 1, -1, 0;
    });
    const MultiStartResult result = multi_start(narrow, {});
    CHECK(result.best.status == Status::infeasible);
    Eigen::Index worst = -1;
    CHECK(result.best.constraints.maxCoeff(&worst) == doctest::Approx(0.5));
    CHECK(worst == 1);
    CHECK((result.certificate.multipliers - vec({0, 1})).norm() < 1e-6);
    CHECK((result.certificate.bound_multipliers - vec({1, 0})).norm() < 1e-6);
}

TEST_CASE("a small feasible set is found") {
    for (const std::string method : {"ipopt", "slsqp", "cobyla", "mma"}) {
        CAPTURE(method);
        FunctionNlp nlp = needle();
        const MultiStartResult result = multi_start(nlp, with_method(method));
        CHECK(result.best.status == Status::converged);
        CHECK(result.best.x[0] == doctest::Approx(0.3).epsilon(1e-5));
        CHECK(result.certificate.multipliers[0] == doctest::Approx(50.0).epsilon(1e-3));  // 1 = lambda 2 radius
    }
    // The elastic phase finds the way in when no local solve does: the only start cannot be evaluated.
    FunctionNlp nlp = needle();
    FunctionNlp holed(vec({-2, -2}), vec({2, 2}), 1, [&](const Vector& x, Evaluation& e) {
        e = nlp.evaluate(x, true);
        e.ok = x[0] < 1.5;
    });
    MultiStartOptions options;
    options.warm_starts = {vec({1.9, 0})};
    options.starts = 0;
    const MultiStartResult result = multi_start(holed, options);
    CHECK(result.locals.size() == 2);
    CHECK(result.locals.front().status == Status::failed);
    CHECK(result.best.status == Status::converged);
    CHECK(result.best.x[0] == doctest::Approx(0.3).epsilon(1e-5));
}

TEST_CASE("the elastic problem: values and derivatives") {
    Known known = hs43();
    ElasticNlp elastic(*known.nlp, -1, 20);
    const Vector z = vec({0.3, -0.4, 1.1, 0.7, 2.5});
    const Evaluation e = elastic.evaluate(z, true);
    CHECK(e.objective == 2.5);
    CHECK((e.constraints - (known.nlp->evaluate(z.head(4), false).constraints.array() - 2.5).matrix()).isZero());
    CHECK((elastic.upper() - vec({5, 5, 5, 5, 20})).isZero());
    CHECK((elastic.lower() - vec({-5, -5, -5, -5, -1})).isZero());
    for (Eigen::Index j = 0; j < 5; ++j) {  // central differences are exact to rounding for quadratics
        const Vector h = 1e-3 * Vector::Unit(5, j);
        const Evaluation plus = elastic.evaluate(z + h, false);
        const Evaluation minus = elastic.evaluate(z - h, false);
        CHECK(e.gradient[j] == doctest::Approx((plus.objective - minus.objective) / 2e-3));
        CHECK((e.jacobian.col(j) - (plus.constraints - minus.constraints) / 2e-3).norm() < 1e-10);
    }
}

TEST_CASE("the budget is for everything together, and no point is evaluated twice") {
    std::vector<std::string> seen;
    const auto counted = [&](int budget) {
        FunctionNlp waves = waves_with_holes();
        seen.clear();
        int value_calls = 0;
        FunctionNlp nlp(vec({-2, -2}), vec({2, 2}), 1, [&](const Vector& x, Evaluation& e) {
            e = waves.evaluate(x, true);
            seen.emplace_back(reinterpret_cast<const char*>(x.data()), 2 * sizeof(double));
            ++value_calls;
        });
        MultiStartOptions options;
        options.solver.max_evaluations = budget;
        MultiStartResult result = multi_start(nlp, options);
        CHECK(result.best.evaluations == value_calls);
        return result;
    };
    for (const int budget : {0, 1, 20, 32, 36}) {
        CAPTURE(budget);
        const MultiStartResult result = counted(budget);
        CHECK(result.best.status == Status::budget);
        CHECK(static_cast<int>(seen.size()) == budget);
        CHECK(result.certificate.multipliers.size() == (budget >= 1 ? 1 : 0));
        CHECK(result.best.feasible == (budget >= 1));  // the first candidate is
    }
    CHECK(counted(2000).best.status == Status::converged);
    std::ranges::sort(seen);
    for (std::size_t k = 2; k < seen.size(); ++k) CHECK(seen[k] != seen[k - 2]);  // twice: value, then gradient
}

TEST_CASE("a request to cancel ends the search with the best so far") {
    FunctionNlp nlp = waves_with_holes();
    MultiStartOptions options;
    options.solver.cancelled = [&] { return nlp.calls >= 38; };
    const MultiStartResult result = multi_start(nlp, options);
    CHECK(result.best.status == Status::budget);
    CHECK(result.best.message == "cancelled");
    CHECK(result.best.feasible);
    CHECK(nlp.calls == 38);
    CHECK(result.certificate.certified(1e-6));  // the first solve was through, but not the search
}

TEST_CASE("an exception of the evaluator surfaces from every phase") {
    for (const int fatal : {3, 35, 45, 60}) {  // candidates, first local solve, second or elastic, elastic
        const auto inner = contradiction();
        int calls = 0;
        FunctionNlp nlp(inner->lower(), inner->upper(), 3, [&](const Vector& x, Evaluation& e) {
            if (++calls == fatal) throw std::runtime_error("no steady motion");
            e = inner->evaluate(x, true);
        });
        CHECK_THROWS_WITH_AS(multi_start(nlp, with_method("slsqp")), "no steady motion", std::runtime_error);
    }
}

TEST_CASE("candidates go on while all fail; if they all do, that is said") {
    FunctionNlp corner(vec({0, 0}), vec({1, 1}), 0, [](const Vector& x, Evaluation& e) {
        e.ok = x[0] > 0.9 && x[1] > 0.85;  // 1.5 % of the box
        e.objective = (x - vec({0.95, 0.95})).squaredNorm();
        e.gradient = 2 * (x - vec({0.95, 0.95}));
    });
    const MultiStartResult found = multi_start(corner, {});
    CHECK(found.candidates_evaluated > 32);
    CHECK(found.best.status == Status::converged);
    CHECK((found.best.x - vec({0.95, 0.95})).norm() < 1e-6);

    FunctionNlp nowhere(vec({0, 0}), vec({1, 1}), 0, [](const Vector&, Evaluation& e) { e.ok = false; });
    const MultiStartResult lost = multi_start(nowhere, {});
    CHECK(lost.best.status == Status::failed);
    CHECK(lost.best.message == "no start could be evaluated");
    CHECK(lost.candidates_failed == 256);
}

TEST_CASE("starts keep their distance, warm starts come first") {
    FunctionNlp nlp = waves_with_holes();
    MultiStartOptions options;
    options.starts = 4;
    options.warm_starts = {vec({1.0, -1.5})};
    CHECK(multi_start(nlp, options).locals.size() == 5);
    options.separation = 0.9;  // in a unit square nothing is 0.9 from a point near its middle
    options.warm_starts = {vec({1.0, -0.5})};
    const MultiStartResult result = multi_start(nlp, options);
    CHECK(result.locals.size() == 1);
    CHECK((result.locals.front().x - vec({std::acos(-1.0) / 3, -std::acos(0.0)})).norm() < 0.1);
}

TEST_CASE("an optimum on a kink is found, and not certified") {
    FunctionNlp kink(vec({-2, -2}), vec({2, 2}), 0, [](const Vector& x, Evaluation& e) {
        const double a = x[0] - 0.3;
        e.objective = std::abs(a) + (x[1] - x[0]) * (x[1] - x[0]);
        e.gradient << (a > 0 ? 1 : -1) - 2 * (x[1] - x[0]), 2 * (x[1] - x[0]);
    });
    const MultiStartResult result = multi_start(kink, {});
    CHECK(result.best.status == Status::failed);
    CHECK((result.best.x - vec({0.3, 0.3})).norm() < 1e-4);
    CHECK_FALSE(result.certificate.certified(0.5));
}

TEST_CASE("same seed, same bits; another seed, other candidates") {
    const auto run = [](std::uint64_t seed) {
        FunctionNlp nlp = waves_with_holes();
        MultiStartOptions options;
        options.solver.seed = seed;
        return multi_start(nlp, options);
    };
    const MultiStartResult a = run(1);
    const MultiStartResult b = run(1);
    CHECK(same_bits(a.best.x, b.best.x));
    CHECK(same_bits(a.locals[1].x, b.locals[1].x));
    CHECK(a.best.evaluations == b.best.evaluations);
    CHECK_FALSE(same_bits(run(2).locals[1].x, a.locals[1].x));
}

TEST_CASE("misuse is answered with field, value and what is allowed") {
    FunctionNlp nlp = waves_with_holes();
    const auto text = [&](auto change) -> std::string {
        MultiStartOptions options;
        change(options);
        try {
            (void)multi_start(nlp, options);
        } catch (const std::invalid_argument& error) { return error.what(); }
        return "";
    };
    CHECK(text([](auto& o) { o.starts = -1; }) == "starts = -1, must be >= 0");
    CHECK(text([](auto& o) { o.candidates = 0; }).ends_with("must both be > 0 when there are no warm starts"));
    CHECK(text([](auto& o) { o.separation = std::nan(""); }) == "separation = nan, must be >= 0");
    CHECK(text([](auto& o) { o.certificate_tolerance = 0; }) == "certificate_tolerance = 0, must be > 0");
    CHECK(text([](auto& o) { o.warm_starts = {vec({1})}; }) == "warm start = (1), must be 2 finite numbers");
    CHECK(text([](auto& o) { o.solver.method = "simplex"; }).starts_with("method = simplex, must be one of"));
    CHECK(text([](auto& o) { o.solver.tolerance = 0; }) == "tolerance = 0, must be in (0, 1)");
    CHECK(nlp.calls == 0);
}
