// Newton's method: known roots, order two, limits and backtracking, and every way it can end.

#include "numerics/newton.hpp"

#include <doctest/doctest.h>

#include <cmath>
#include <limits>
#include <stdexcept>
#include <string>
#include <vector>

using namespace percuss;
using numerics::Matrix;
using numerics::NewtonOptions;
using numerics::NewtonStatus;
using numerics::SmallMatrix;
using numerics::SmallVector;
using numerics::Vector;
using Linear = numerics::Linearised<Vector, Matrix>;

namespace {

Vector of(std::initializer_list<double> values) {
    Vector v(static_cast<Eigen::Index>(values.size()));
    Eigen::Index i = 0;
    for (const double x : values) { v[i++] = x; }
    return v;
}

/// x^2 + y^2 = 4, x y = 1.
bool circle_and_hyperbola(const Vector& x, Linear& at) {
    at.residual = of({x[0] * x[0] + x[1] * x[1] - 4.0, x[0] * x[1] - 1.0});
    at.jacobian.resize(2, 2);
    at.jacobian << 2.0 * x[0], 2.0 * x[1], x[1], x[0];
    return true;
}

/// One equation f(x) = 0 with its derivative.
template <class F, class D>
auto scalar(F f, D derivative) {
    return [f, derivative](const Vector& x, Linear& at) {
        at.residual = of({f(x[0])});
        at.jacobian = Matrix::Constant(1, 1, derivative(x[0]));
        return true;
    };
}

NewtonOptions plain() {
    NewtonOptions options;
    options.max_halvings = 0;
    options.max_step = numerics::unlimited;
    return options;
}

}  // namespace

TEST_CASE("a root in two unknowns, in closed form") {
    const double x = 0.5 * (std::sqrt(6.0) + std::sqrt(2.0));
    for (const int halvings : {0, 8}) {
        NewtonOptions options;
        options.max_halvings = halvings;
        const auto found = numerics::newton<Linear>(of({2.2, 0.3}), circle_and_hyperbola, options);
        REQUIRE(found.ok());
        CHECK(std::abs(found.x[0] - x) < 4e-16);
        CHECK(std::abs(found.x[1] - 1.0 / x) < 4e-16);
        CHECK(found.iterations <= 6);
        // What is handed back belongs to one point: F' s = -F there, s the last step.
        const Vector step = found.factors.solve(Vector(-found.at.residual));
        CHECK(step.norm() == found.last_step);
        CHECK(found.at.residual.norm() == found.residual);
        CHECK((found.at.jacobian * step + found.at.residual).norm() < 1e-15);
    }
}

TEST_CASE("convergence is of order two, and of order one at a double root") {
    std::vector<double> errors;
    std::vector<double> slow;
    for (int iterations = 1; iterations <= 5; ++iterations) {
        NewtonOptions options = plain();
        options.max_iterations = iterations;
        const auto cube = scalar([](double x) { return x * x * x - 2.0; }, [](double x) { return 3.0 * x * x; });
        errors.push_back(std::abs(numerics::newton<Linear>(of({1.6}), cube, options).x[0] - std::cbrt(2.0)));
        const auto square = scalar([](double x) { return x * x; }, [](double x) { return 2.0 * x; });
        slow.push_back(numerics::newton<Linear>(of({1.0}), square, options).x[0]);
    }
    // e' = f''/(2 f') e^2 = e^2 / root, to leading order.
    for (std::size_t k = 1; k + 1 < errors.size() && errors[k + 1] > 1e-14; ++k) {
        const double constant = errors[k + 1] / (errors[k] * errors[k]);
        CHECK(constant > 0.8 / std::cbrt(2.0));
        CHECK(constant < 1.2 / std::cbrt(2.0));
    }
    CHECK(errors[2] > 1e-9);  // so that the loop has looked at something
    for (std::size_t k = 0; k + 1 < slow.size(); ++k) { CHECK(slow[k + 1] == 0.5 * slow[k]); }
}

TEST_CASE("both tests must be met") {
    // A flat function: the residual is tiny long before the step.
    const auto flat = scalar([](double x) { return 1e-14 * (x - 1.0) * (x - 1.0) * (x - 1.0); },
                             [](double x) { return 3e-14 * (x - 1.0) * (x - 1.0); });
    NewtonOptions options = plain();
    options.max_iterations = 200;
    const auto found = numerics::newton<Linear>(of({2.0}), flat, options);
    REQUIRE(found.ok());
    CHECK(found.iterations > 30);
    CHECK(std::abs(found.x[0] - 1.0) < 1e-8);
    // A steep one: the step is tiny long before the residual.
    const auto steep = scalar([](double x) { return 1e12 * (x * x - 2.0); }, [](double x) { return 2e12 * x; });
    options.residual_tolerance = 1e-3;
    options.step_tolerance = 1.0;
    const auto exact = numerics::newton<Linear>(of({1.4}), steep, options);
    REQUIRE(exact.ok());
    CHECK(exact.residual < 3e-3);
    // The same relative to the unknowns, or not.
    const auto far = scalar([](double x) { return x - 1e6; }, [](double) { return 1.0; });
    options = plain();
    options.max_iterations = 1;
    options.residual_tolerance = 1e-2;
    options.step_tolerance = 1e-2;
    CHECK(numerics::newton<Linear>(of({1e6 + 1e3}), far, options).ok());
    options.residual_is_relative = false;
    CHECK(numerics::newton<Linear>(of({1e6 + 1e3}), far, options).status == NewtonStatus::iteration_limit);
}

TEST_CASE("the last step is taken or not, and not too early") {
    const auto line = scalar([](double x) { return x - 1.0; }, [](double) { return 1.0; });
    NewtonOptions options = plain();
    options.residual_tolerance = 1e-3;
    options.step_tolerance = 1e-3;
    CHECK(numerics::newton<Linear>(of({1.0 + 1e-4}), line, options).x[0] == 1.0);
    options.take_last_step = false;
    const auto kept = numerics::newton<Linear>(of({1.0 + 1e-4}), line, options);
    CHECK(kept.x[0] == 1.0 + 1e-4);
    CHECK(kept.iterations == 1);
    options.min_iterations = 2;
    CHECK(numerics::newton<Linear>(of({1.0 + 1e-4}), line, options).iterations == 2);
}

TEST_CASE("the longest step, relative and absolute") {
    std::vector<double> seen;
    const auto line = [&](const Vector& x, Linear& at) {
        seen.push_back(x[0]);
        at.residual = of({x[0] - 100.0});
        at.jacobian = Matrix::Identity(1, 1);
        return true;
    };
    NewtonOptions options = plain();
    options.max_step = 0.5;
    REQUIRE(numerics::newton<Linear>(of({1.0}), line, options).ok());
    REQUIRE(seen.size() > 4);
    CHECK(seen[1] == 2.0);  // half of 1 + 1
    CHECK(seen[2] == 3.5);  // half of 1 + 2
    for (std::size_t k = 0; k + 1 < seen.size(); ++k) { CHECK(seen[k + 1] - seen[k] <= 0.5 * (1.0 + seen[k]) + 1e-12); }
    seen.clear();
    options.max_step_is_relative = false;
    options.max_iterations = 4;
    const auto found = numerics::newton<Linear>(of({1.0}), line, options);
    CHECK(found.status == NewtonStatus::iteration_limit);
    CHECK(found.x[0] == 3.0);
    CHECK(found.last_step == 97.5);  // not shortened, from 2.5
    CHECK(seen == std::vector<double>{1.0, 1.5, 2.0, 2.5});
}

TEST_CASE("backtracking converges where the plain method diverges") {
    const auto arctan = scalar([](double x) { return std::atan(x); }, [](double x) { return 1.0 / (1.0 + x * x); });
    NewtonOptions options = plain();
    CHECK_FALSE(numerics::newton<Linear>(of({2.0}), arctan, options).ok());
    options.max_halvings = 8;
    const auto found = numerics::newton<Linear>(of({2.0}), arctan, options);
    REQUIRE(found.ok());
    CHECK(std::abs(found.x[0]) < 1e-15);
    // And where a step leaves the domain.
    const auto log = [](const Vector& x, Linear& at) {
        at.residual = of({std::log(x[0])});
        at.jacobian = Matrix::Constant(1, 1, 1.0 / x[0]);
        return x[0] > 0.0;
    };
    CHECK(numerics::newton<Linear>(of({5.0}), log, options).ok());
    CHECK(numerics::newton<Linear>(of({5.0}), log, plain()).status == NewtonStatus::evaluation_failed);
}

TEST_CASE("every way it ends is said") {
    NewtonOptions options = plain();
    const auto never = [](const Vector&, Linear&) { return false; };
    const auto failed = numerics::newton<Linear>(of({1.0}), never, options);
    CHECK(failed.status == NewtonStatus::evaluation_failed);
    CHECK(failed.iterations == 0);
    CHECK(failed.x[0] == 1.0);
    const auto level = scalar([](double) { return 1.0; }, [](double) { return 0.0; });
    CHECK(numerics::newton<Linear>(of({1.0}), level, options).status == NewtonStatus::singular);
    // No real root: backtracking ends at the least residual.
    const auto no_root = scalar([](double x) { return x * x + 1.0; }, [](double x) { return 2.0 * x; });
    CHECK(numerics::newton<Linear>(of({0.7}), no_root, options).status == NewtonStatus::iteration_limit);
    options.max_halvings = 8;
    CHECK(numerics::newton<Linear>(of({1e-3}), no_root, options).status == NewtonStatus::no_progress);
    // A residual that rounding keeps from falling: accepted within ten times the tolerance.
    const auto floor = [](double height) {
        return scalar([height](double x) { return x > 1.0 ? height : -height; }, [](double) { return 1e-6; });
    };
    CHECK(numerics::newton<Linear>(of({1.0}), floor(1.9e-10), options).ok());
    CHECK(numerics::newton<Linear>(of({1.0}), floor(2.1e-10), options).status == NewtonStatus::no_progress);
    CHECK(numerics::NewtonOutcome<Linear>{}.status == NewtonStatus::not_run);
    CHECK_FALSE(numerics::NewtonOutcome<Linear>{}.ok());
    CHECK(to_string(NewtonStatus::no_progress) == "no progress");
}

TEST_CASE("options that make no sense are refused by name") {
    const auto refused = [](auto change, const char* field) {
        NewtonOptions options = plain();
        change(options);
        try {
            numerics::newton<Linear>(of({2.2, 0.3}), circle_and_hyperbola, options);
        } catch (const std::invalid_argument& e) { return std::string(e.what()).find(field) != std::string::npos; }
        return false;
    };
    constexpr double nan = std::numeric_limits<double>::quiet_NaN();
    CHECK(refused([](NewtonOptions& o) { o.max_iterations = 0; }, "max_iterations"));
    CHECK(refused([](NewtonOptions& o) { o.min_iterations = 0; }, "min_iterations"));
    CHECK(refused([](NewtonOptions& o) { o.max_halvings = -1; }, "max_halvings"));
    CHECK(refused([](NewtonOptions& o) { o.residual_tolerance = nan; }, "residual_tolerance"));
    CHECK(refused([](NewtonOptions& o) { o.step_tolerance = nan; }, "step_tolerance"));
    CHECK(refused([](NewtonOptions& o) { o.max_step = nan; }, "max_step"));
}

TEST_CASE("small matrices, and evaluations that carry more") {
    struct Counted : numerics::Linearised<SmallVector, SmallMatrix> {
        int number = 0;
    };
    int count = 0;
    const auto square = [&](const SmallVector& x, Counted& at) {
        at.number = ++count;
        at.residual = x.array().square() - 2.0;
        at.jacobian = (2.0 * x).asDiagonal();
        return true;
    };
    SmallVector start(3);
    start << 1.0, 1.5, 2.0;
    const auto found = numerics::newton<Counted>(start, square, {});
    REQUIRE(found.ok());
    CHECK((found.x.array() - std::sqrt(2.0)).matrix().norm() < 1e-15);
    CHECK(found.at.number == found.iterations);  // no step was shortened, and the last step is not looked at again
}
