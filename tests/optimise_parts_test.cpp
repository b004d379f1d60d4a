// The parts of optimise/: memory and archive around the problem, non-negative least squares, certificates, Halton
// points.

#include "optimise/certificate.hpp"
#include "optimise/halton.hpp"
#include "optimise/memoised_nlp.hpp"
#include "optimise/method.hpp"
#include "optimise/nnls.hpp"
#include "optimise_problems.hpp"

#include <doctest/doctest.h>

#include <algorithm>
#include <limits>
#include <random>
#include <stdexcept>

using namespace percuss::test;
using namespace percuss::optimise;

namespace {

/// Min over all supports of the least-squares residual with non-negative unknowns: NNLS without cleverness.
double smallest_residual(const Matrix& a, const Vector& b) {
    double smallest = b.norm();
    for (unsigned support = 1; support < 1U << a.cols(); ++support) {
        std::vector<Eigen::Index> columns;
        for (Eigen::Index j = 0; j < a.cols(); ++j) {
            if (support >> j & 1U) columns.push_back(j);
        }
        const Matrix part = a(Eigen::all, columns);
        const Vector x = part.completeOrthogonalDecomposition().solve(b);
        if (x.minCoeff() >= 0) smallest = std::min(smallest, (part * x - b).norm());
    }
    return smallest;
}

}  // namespace

TEST_CASE("each point is evaluated once, inside the bounds") {
    Known known = rosenbrock_disc();
    FunctionNlp& nlp = *known.nlp;
    MemoisedNlp memo(nlp, {});

    const Evaluation first = memo.evaluate(vec({0.1, 0.2}), false);
    CHECK(first.ok);
    CHECK(first.gradient.size() == 0);
    CHECK(memo.evaluate(vec({0.1, 0.2}), false).objective == first.objective);
    CHECK(nlp.calls == 1);

    SUBCASE("a gradient asked for later is a second evaluation, then both are known") {
        CHECK(memo.evaluate(vec({0.1, 0.2}), true).gradient.size() == 2);
        CHECK(memo.evaluate(vec({0.1, 0.2}), true).gradient.size() == 2);
        CHECK(memo.evaluate(vec({0.1, 0.2}), false).ok);
        CHECK(nlp.calls == 2);
        CHECK(memo.evaluations() == 2);
    }
    SUBCASE("one bit makes another point") {
        CHECK(memo.evaluate(vec({std::nextafter(0.1, 1.0), 0.2}), false).ok);
        CHECK(nlp.calls == 2);
    }
    SUBCASE("points outside are moved to the bounds") {
        CHECK(memo.evaluate(vec({1.5 + 1e-8, 0}), true).ok);
        CHECK(memo.evaluate(vec({7.0, 0}), true).ok);
        CHECK(nlp.calls == 2);
        CHECK_FALSE(nlp.outside);
    }
    SUBCASE("not a number is not evaluated") {
        CHECK_FALSE(memo.evaluate(vec({std::nan(""), 0}), true).ok);
        CHECK(nlp.calls == 1);
    }
    SUBCASE("the budget ends in Halt, known points stay free") {
        memo.allow(1);
        CHECK(memo.evaluate(vec({0.1, 0.2}), false).ok);
        CHECK_THROWS_AS(memo.evaluate(vec({0.3, 0.2}), false), Halt);
        CHECK_THROWS_AS(memo.evaluate(vec({0.1, 0.2}), true), Halt);
        memo.allow(2);
        CHECK(memo.evaluate(vec({0.3, 0.2}), false).ok);
    }
}

TEST_CASE("what is not finite has failed, what has the wrong size is a mistake") {
    const double infinity = std::numeric_limits<double>::infinity();
    FunctionNlp bad(vec({0}), vec({1}), 1, [&](const Vector& x, Evaluation& e) {
        e.objective = x[0] < 0.2 ? infinity : 1.0;
        e.constraints[0] = x[0] > 0.8 ? std::nan("") : -1.0;
        e.gradient[0] = x[0] > 0.4 && x[0] < 0.6 ? std::nan("") : 1.0;
        if (x[0] == 0.3) e.jacobian.resize(1, 2);
    });
    MemoisedNlp memo(bad, {});
    CHECK_FALSE(memo.evaluate(vec({0.1}), false).ok);
    CHECK_FALSE(memo.evaluate(vec({0.9}), false).ok);
    CHECK(memo.evaluate(vec({0.5}), false).ok);
    CHECK_FALSE(memo.evaluate(vec({0.5}), true).ok);
    CHECK_FALSE(memo.evaluate(vec({0.5}), true).ok);
    CHECK(memo.evaluate(vec({0.5}), false).ok);  // its value is still good
    CHECK(bad.calls == 4);
    CHECK_THROWS_WITH_AS(memo.evaluate(vec({0.3}), true), "Nlp::evaluate: jacobian has 2 entries, expected 1",
                         std::logic_error);

    FunctionNlp empty(vec({0, 2}), vec({1, 2}), 0, [](const Vector&, Evaluation&) {});
    CHECK_THROWS_WITH_AS(MemoisedNlp(empty, {}), "bounds of variable 1: [2, 2] is empty, lower must be below upper",
                         std::invalid_argument);
    CHECK_THROWS_AS(MemoisedNlp(bad, {.feasibility_tolerance = std::nan("")}), std::invalid_argument);
}

TEST_CASE("the archive keeps the best feasible and the least infeasible point") {
    Known known = one_variable();
    MemoisedNlp memo(*known.nlp, {.feasibility_tolerance = 1e-3});
    CHECK(memo.evaluate(vec({2.5}), false).ok);
    CHECK_FALSE(memo.best_feasible());
    CHECK(memo.least_infeasible()->x[0] == 2.5);
    for (const double x : {0.5, 1.5005, 1.4, 2.0}) CHECK(memo.evaluate(vec({x}), false).ok);
    CHECK(memo.best_feasible()->x[0] == 1.5005);  // within the tolerance, and nearer to 2 than 1.4
    CHECK(memo.best_feasible()->infeasibility == doctest::Approx(5e-4));
    CHECK(memo.least_infeasible()->x[0] == 1.4);
}

TEST_CASE("non-negative least squares agrees with trying all supports") {
    std::mt19937_64 random(7);
    const auto uniform = [&] { return static_cast<double>(random() >> 11) * 0x1p-52 - 1.0; };
    for (int trial = 0; trial < 200; ++trial) {
        Matrix a = Matrix::NullaryExpr(1 + trial % 5, 1 + trial % 6, uniform);
        if (trial % 3 == 0 && a.cols() > 2) a.col(1) = 0.5 * a.col(0);  // dependent columns
        const Vector b = Vector::NullaryExpr(a.rows(), uniform);
        const NonNegativeLeastSquares result = solve_nnls(a, b);
        CHECK(result.converged);
        CHECK(result.x.minCoeff() >= 0);
        CHECK((a * result.x - b).norm() == doctest::Approx(smallest_residual(a, b)).epsilon(1e-12).scale(1.0));
    }
    CHECK(solve_nnls(Matrix(3, 0), Vector::Ones(3)).x.size() == 0);
}

TEST_CASE("certificates: known multipliers at known optima, none beside them") {
    SUBCASE("Hock and Schittkowski 43") {
        Known known = hs43();
        const Certificate c = certificate_at(*known.nlp, known.x);
        CHECK(c.certified(1e-12));
        CHECK((c.multipliers - vec({1, 0, 2})).norm() < 1e-12);
        CHECK(c.bound_multipliers.isZero());
    }
    SUBCASE("Hock and Schittkowski 71, with a bound") {
        Known known = hs71();  // x is known to 1e-8, and multipliers are of order one
        const Certificate c = certificate_at(*known.nlp, known.x);
        CHECK(c.certified(1e-6));
        CHECK((c.multipliers - vec({0.55229366, 0.16146857})).norm() < 1e-6);
        CHECK((c.bound_multipliers - vec({-1.0878712, 0, 0, 0})).norm() < 1e-6);
    }
    SUBCASE("an upper bound presses with a positive sign") {
        FunctionNlp nlp(vec({0, 0}), vec({1, 1}), 0, [](const Vector& x, Evaluation& e) {
            e.objective = -3 * x[0] + 2 * x[1];
            e.gradient << -3, 2;
        });
        CHECK((certificate_at(nlp, vec({1, 0})).bound_multipliers - vec({3, -2})).norm() < 1e-15);
        CHECK(certificate_at(nlp, vec({1, 0})).certified(1e-15));
        CHECK(certificate_at(nlp, vec({0, 1})).residual == doctest::Approx(1.0));  // both press the wrong way
    }
    SUBCASE("beside the optimum: along the constraint, inside, outside") {
        Known known = hs43();
        CHECK_FALSE(certificate_at(*known.nlp, known.x + vec({1e-3, 0, 0, 0})).certified(1e-6));
        CHECK_FALSE(certificate_at(*known.nlp, 0.999 * known.x).certified(1e-6));
        Known one = one_variable();
        CHECK(certificate_at(*one.nlp, vec({1.5})).certified(1e-15));
        CHECK(certificate_at(*one.nlp, vec({1.49})).residual == doctest::Approx(1.0));  // inactive, no multiplier
        CHECK(certificate_at(*one.nlp, vec({1.5 - 9e-7})).residual < 1e-15);            // active within 1e-6 ...
        CHECK_FALSE(certificate_at(*one.nlp, vec({1.5 - 9e-7})).certified(1e-7));       // ... not complementary
        CHECK_FALSE(certificate_at(*one.nlp, vec({1.51})).certified(1e-3));
        CHECK(certificate_at(*one.nlp, vec({1.51})).infeasibility == doctest::Approx(0.01));
    }
    SUBCASE("nothing is certified without an evaluation") {
        CHECK_FALSE(Certificate{}.certified(1e300));
        CHECK_FALSE(certify(Evaluation{}, vec({0}), vec({0}), vec({1})).certified(1e300));
    }
}

TEST_CASE("Halton points fill the cube evenly and depend on the seed alone") {
    const Halton sequence(10, 5);
    // In each coordinate, the first b points lie in the b intervals [i/b, (i+1)/b), one in each; so do the next b.
    const int bases[] = {2, 3, 5, 7, 11, 13, 17, 19, 23, 29};
    for (Eigen::Index j = 0; j < 10; ++j) {
        const int base = bases[j];
        for (const int offset : {0, base}) {
            std::vector<int> counts(static_cast<std::size_t>(base), 0);
            for (int k = 0; k < base; ++k) {
                const double u = sequence.point(static_cast<unsigned>(k + offset))[j];
                REQUIRE((u >= 0 && u < 1));
                ++counts[static_cast<std::size_t>(u * base)];
            }
            CHECK(*std::min_element(counts.begin(), counts.end()) == 1);
        }
    }
    CHECK(same_bits(Halton(10, 5).point(12), sequence.point(12)));
    CHECK_FALSE(same_bits(Halton(10, 6).point(12), sequence.point(12)));
    CHECK_THROWS_AS(Halton(17, 1), std::invalid_argument);
}

TEST_CASE("the table of methods: names once, an unknown one is told the list, sizes are checked by capabilities") {
    std::string all;
    for (const Method& method : method_table()) {
        CAPTURE(method.name);
        CHECK(&find_method(method.name) == &method);  // the first of that name
        CHECK_FALSE(method.library.empty());
        CHECK(static_cast<bool>(method.solver));
        all += " " + method.name;
    }
    CHECK_THROWS_WITH_AS((void)find_method("simplex"), ("method = simplex, must be one of" + all).c_str(),
                         std::invalid_argument);
    Known known = rosenbrock_disc();  // two variables, one constraint
    MemoisedNlp nlp(*known.nlp, {});
    Method picky = find_method("slsqp");
    CHECK_NOTHROW(check_fits(picky, nlp));
    picky.capabilities.least_variables = 3;
    CHECK_THROWS_WITH_AS(check_fits(picky, nlp), "method = slsqp: 2 variables, must be at least 3",
                         std::invalid_argument);
    picky.capabilities.least_variables = 1;
    picky.capabilities.most_constraints = 0;
    CHECK_THROWS_AS(check_fits(picky, nlp), std::invalid_argument);
}
