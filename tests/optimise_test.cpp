// The optimisers: every method on problems with known answers, and the traps of the solvers behind them.

#include "optimise/certificate.hpp"
#include "optimise/repair.hpp"
#include "optimise/solve.hpp"
#include "optimise_problems.hpp"

#include <doctest/doctest.h>

#include <algorithm>
#include <array>
#include <filesystem>
#include <fstream>
#include <limits>
#include <stdexcept>
#include <thread>

using namespace percuss::test;
using namespace percuss::optimise;
using Status = Outcome::Status;

TEST_CASE("methods with derivatives solve problems with known answers") {
    const auto make = {rosenbrock_disc, hs35, hs43, hs71, hs100, one_variable, rosenbrock_with_holes};
    for (const std::string method : {"ipopt", "slsqp", "ccsaq"}) {
        int number = 0;
        for (const auto& problem : make) {
            CAPTURE(method);
            CAPTURE(number++);
            Known known = problem();
            const Outcome outcome = minimise(*known.nlp, known.start, {.method = method});
            CHECK(outcome.status == Status::converged);
            CHECK(outcome.feasible);
            CHECK(outcome.infeasibility <= 1e-9);
            CHECK(outcome.evaluations == known.nlp->calls);
            CHECK_FALSE(known.nlp->outside);
            // ipopt and slsqp converge fast: 1e-7 is the digits of the known x and the conditioning (Hessians up to
            // 1e3) times the tolerance 1e-8. ccsaq converges linearly and judges by its steps.
            const bool fast = method != "ccsaq";
            CHECK((outcome.x - known.x).lpNorm<Eigen::Infinity>() < (fast ? 1e-6 : 1e-4));
            CHECK(outcome.objective == doctest::Approx(known.objective).epsilon(1e-7));
            if (fast) CHECK(certificate_at(*known.nlp, outcome.x).certified(1e-7));
        }
    }
}

TEST_CASE("every method finds the constrained minimum of Rosenbrock's function") {
    REQUIRE(methods().size() == 17);
    for (const std::string& method : methods()) {
        CAPTURE(method);
        for (const auto& problem : {rosenbrock_disc, rosenbrock_with_holes}) {
            Known known = problem();
            // Direct search inside an augmented Lagrangian is slow, and that is all that is asked of it here.
            const Outcome outcome = minimise(*known.nlp, known.start, {.method = method, .max_evaluations = 4000});
            CHECK(outcome.feasible);
            CHECK(outcome.infeasibility <= 1e-9);
            CHECK(outcome.objective < known.objective + 1e-3);
            CHECK(outcome.objective > known.objective - 1e-8);
            CHECK_FALSE(known.nlp->outside);
            if (is_global(method)) CHECK(outcome.status == Status::converged);
        }
    }
}

TEST_CASE("every method: one variable, and no constraints") {
    for (const std::string& method : methods()) {
        CAPTURE(method);
        Known known = one_variable();
        if (method == "praxis") {
            CHECK_THROWS_WITH_AS(minimise(*known.nlp, known.start, {.method = method}),
                                 "method = praxis: 1 variable, must be at least 2", std::invalid_argument);
        } else {
            CHECK(minimise(*known.nlp, known.start, {.method = method}).x[0] == doctest::Approx(1.5).epsilon(1e-6));
        }
        FunctionNlp bowl(vec({-1, -1}), vec({2, 1}), 0, [](const Vector& x, Evaluation& e) {
            e.objective = (x - vec({0.3, 1.2})).squaredNorm();  // the minimum of the box is at (0.3, 1)
            e.gradient = 2 * (x - vec({0.3, 1.2}));
        });
        const Outcome outcome = minimise(bowl, vec({-0.8, -0.7}), {.method = method});
        CHECK((outcome.x - vec({0.3, 1.0})).norm() < 1e-3);
        CHECK_FALSE(bowl.outside);
    }
}

TEST_CASE("every method: an exception of the evaluator surfaces with its text") {
    for (const std::string& method : methods()) {
        CAPTURE(method);
        Known known = hs43();
        int calls = 0;
        FunctionNlp throwing(vec({-5, -5, -5, -5}), vec({5, 5, 5, 5}), 3, [&](const Vector& x, Evaluation& e) {
            if (++calls == 7) throw std::runtime_error("membrane slack in call 7");
            e = known.nlp->evaluate(x, true);
        });
        CHECK_THROWS_WITH_AS(minimise(throwing, known.start, {.method = method}), "membrane slack in call 7",
                             std::runtime_error);
        CHECK(calls == 7);
    }
}

TEST_CASE("every method: the budget and the request to stop are kept to the evaluation") {
    for (const std::string& method : methods()) {
        CAPTURE(method);
        for (const int budget : {0, 1, 9}) {
            Known known = hs100();
            const Outcome outcome = minimise(*known.nlp, known.start, {.method = method, .max_evaluations = budget});
            CHECK(outcome.status == Status::budget);
            CHECK(known.nlp->calls == budget);
            CHECK(outcome.evaluations == budget);
            CHECK(outcome.message == "max_evaluations = " + std::to_string(budget) + " spent");
            CHECK(outcome.x.size() == 7);
        }
        Known known = hs100();
        const auto cancelled = [&] { return known.nlp->calls >= 8; };
        const Outcome outcome = minimise(*known.nlp, known.start, {.method = method, .cancelled = cancelled});
        CHECK(outcome.status == Status::budget);
        CHECK(outcome.message == "cancelled");
        CHECK(known.nlp->calls == 8);
    }
}

TEST_CASE("every method: same seed, same bits") {
    for (const std::string& method : methods()) {
        CAPTURE(method);
        const auto solved = [&](std::uint64_t seed) {
            Known known = hs43();
            std::vector<Vector> path;
            FunctionNlp recording(vec({-5, -5, -5, -5}), vec({5, 5, 5, 5}), 3, [&](const Vector& x, Evaluation& e) {
                path.push_back(x);
                e = known.nlp->evaluate(x, true);
            });
            (void)minimise(recording, known.start, {.method = method, .max_evaluations = 300, .seed = seed});
            return path;
        };
        const auto path = solved(1);
        CHECK(std::ranges::equal(path, solved(1), same_bits));
        if (method == "isres" || method == "esch" || method == "crs2") {
            CHECK_FALSE(std::ranges::equal(path, solved(2), same_bits));
        }
    }
}

TEST_CASE("a solver's slightly infeasible point is moved to feasibility, and checked") {
    Known known = rosenbrock_disc();
    MemoisedNlp memo(*known.nlp, {.feasibility_tolerance = 0.0});
    Guard guard(memo);
    const Vector outside = 1.0001 * known.x;
    const std::optional<Vector> inside = repaired(guard, outside);
    REQUIRE(inside);
    CHECK(memo.evaluate(*inside, false).constraints[0] <= 0);
    CHECK((*inside - known.x).norm() < 1e-7);       // the constraint's normal is radial here: back where it came from
    CHECK_FALSE(repaired(guard, vec({1.2, 1.2})));  // too far

    // At zero tolerance, where the solvers' own last digits do not suffice.
    for (const std::string method : {"ipopt", "slsqp", "mma", "cobyla", "ccsaq"}) {
        for (const auto& problem : {rosenbrock_disc, hs43, hs71, hs100}) {
            CAPTURE(method);
            Known tight = problem();
            const Outcome outcome = minimise(*tight.nlp, tight.start, {.method = method, .feasibility_tolerance = 0.0});
            CHECK(outcome.feasible);
            CHECK(outcome.constraints.maxCoeff() <= 0);
            CHECK(same_bits(tight.nlp->evaluate(outcome.x, false).constraints, outcome.constraints));
        }
    }
}

TEST_CASE("an optimum outside the constraints is not taken for one") {
    for (const std::string method : {"ipopt", "slsqp", "mma", "ccsaq", "cobyla", "isres"}) {
        CAPTURE(method);
        const auto nlp = contradiction();
        const Outcome outcome = minimise(*nlp, vec({0.3, 1.2}), {.method = method});
        CHECK((outcome.status == Status::infeasible || outcome.status == Status::failed));
        CHECK_FALSE(outcome.feasible);
        CHECK(outcome.infeasibility >= 1 - 1e-12);  // nothing is less infeasible than (1, 1)
        CHECK(outcome.infeasibility == outcome.constraints.maxCoeff());
    }
}

TEST_CASE("a success that is none: the certificate refuses it") {
    Known known = hs71();
    const Outcome outcome = minimise(*known.nlp, known.start, {.method = "mma"});
    CHECK(outcome.status == Status::converged);  // NLopt 2.7.1 says XTOL_REACHED, far from the minimum
    CHECK(outcome.objective > known.objective + 1);
    CHECK_FALSE(certificate_at(*known.nlp, outcome.x).certified(1e-3));
}

TEST_CASE("ipopt: a start from which a push inwards would fail") {
    FunctionNlp nlp(vec({0}), vec({3}), 1, [](const Vector& x, Evaluation& e) {
        e.ok = x[0] < 1e-3 || x[0] > 0.02;  // Ipopt would begin at 0.01
        e.objective = (x[0] - 2) * (x[0] - 2);
        e.gradient << 2 * (x[0] - 2);
        e.constraints << x[0] - 1.5;
        e.jacobian << 1;
    });
    const Outcome outcome = minimise(nlp, vec({0}), {});
    CHECK(outcome.status == Status::converged);
    CHECK(outcome.x[0] == doctest::Approx(1.5));
    FunctionNlp nowhere(vec({0}), vec({3}), 0, [](const Vector&, Evaluation& e) { e.ok = false; });
    CHECK(minimise(nowhere, vec({1}), {}).status == Status::failed);
    CHECK(minimise(nowhere, vec({1}), {}).message == "the start could not be evaluated");
}

TEST_CASE("ipopt: a file ipopt.opt in the folder changes nothing") {
    const auto home = std::filesystem::current_path();
    const auto folder = std::filesystem::temp_directory_path() / "percuss_optimise_test";
    std::filesystem::create_directories(folder);
    std::filesystem::current_path(folder);
    std::ofstream("ipopt.opt") << "max_iter 1\n";
    Known known = hs43();
    const Outcome outcome = minimise(*known.nlp, known.start, {});
    std::filesystem::current_path(home);
    std::filesystem::remove_all(folder);
    CHECK(outcome.status == Status::converged);
}

TEST_CASE("ipopt: 8 solves from 2 threads, and solves inside evaluations") {
    const auto solve = [] {
        Known known = hs100();
        int calls = 0;
        FunctionNlp nested(known.nlp->lower(), known.nlp->upper(), 4, [&](const Vector& x, Evaluation& e) {
            if (++calls == 3) {  // deadlocks if the lock is held during evaluations
                Known inner = hs43();
                CHECK(minimise(*inner.nlp, inner.start, {}).status == Status::converged);
            }
            std::this_thread::yield();
            e = known.nlp->evaluate(x, true);
        });
        return minimise(nested, known.start, {});
    };
    const Outcome alone = solve();
    CHECK(alone.status == Status::converged);
    std::array<Outcome, 8> outcomes;
    const auto work = [&](std::size_t from) {
        for (std::size_t k = from; k < outcomes.size(); k += 2) outcomes[k] = solve();
    };
    std::thread other(work, 1);
    work(0);
    other.join();
    for (const Outcome& outcome : outcomes) {
        CHECK(outcome.status == Status::converged);
        CHECK(same_bits(outcome.x, alone.x));
    }
}

TEST_CASE("random methods draw the same numbers in any thread") {
    const auto solve = [] {
        Known known = hs43();
        return minimise(*known.nlp, known.start, {.method = "isres", .max_evaluations = 3000, .global_share = 1}).x;
    };
    const Vector alone = solve();
    Vector here;
    Vector there;
    std::thread other([&] { there = solve(); });
    here = solve();
    other.join();
    CHECK(same_bits(here, alone));
    CHECK(same_bits(there, alone));
}

TEST_CASE("misuse is answered with field, value and what is allowed") {
    Known known = one_variable();
    const auto text = [&](const Options& options, const Vector& start) -> std::string {
        try {
            (void)minimise(*known.nlp, start, options);
        } catch (const std::invalid_argument& error) { return error.what(); }
        return "";
    };
    CHECK(text({.method = "simplex"}, vec({1})).starts_with("method = simplex, must be one of ipopt slsqp mma"));
    CHECK(text({.tolerance = std::nan("")}, vec({1})) == "tolerance = nan, must be in (0, 1)");
    CHECK(text({.max_evaluations = -1}, vec({1})) == "max_evaluations = -1, must be >= 0");
    CHECK(text({.global_share = 0}, vec({1})) == "global_share = 0, must be in (0, 1]");
    CHECK(text({}, vec({1, 2})) == "start = (1 2), must be 1 numbers");
    CHECK(text({}, vec({std::nan("")})) == "start = (nan), must be 1 numbers");
    CHECK(known.nlp->calls == 0);
    FunctionNlp open(vec({0}), vec({std::numeric_limits<double>::infinity()}), 0,
                     [](const Vector& x, Evaluation& e) { e.objective = x[0], e.gradient[0] = 1; });
    CHECK(minimise(open, vec({5}), {}).x[0] == doctest::Approx(0.0));
    CHECK_THROWS_WITH_AS(minimise(open, vec({5}), {.method = "ags"}),
                         "method = ags: it is global and needs finite bounds for every variable",
                         std::invalid_argument);
}
