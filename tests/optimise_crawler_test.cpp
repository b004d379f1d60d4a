// The drive of a crawling robot, problems/crawler.ini: the best design is found, certified, and not beaten by chance.

#include "design/evaluate.hpp"
#include "engine_cases.hpp"
#include "model/membrane/membrane.hpp"
#include "relative.hpp"
#include "shipped_problem.hpp"
#include "verbs/optimise/design_nlp.hpp"
#include "verbs/optimise/optimise.hpp"

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <string>
#include <vector>

using namespace percuss;
using design::Evaluation;
using design::EvaluationStatus;
using design::Limit;
using design::Quantity;
using model::Key;
using model::Specification;
using verbs::OptimiseStudyResult;

namespace {

/// The optimisation, run once for all test cases.
struct Solved {
    verbs::StudyProblem problem = test::shipped_problem("crawler");
    OptimiseStudyResult result = verbs::run_optimise(problem, nullptr, {}, {});
};
const Solved& solved() {
    static const Solved once;
    return once;
}

Specification specification(const design::Problem& problem, const std::vector<std::pair<Key, double>>& design) {
    Specification spec = problem.actuator;
    for (const auto& [key, value] : design) { spec.set(key, value); }
    return spec;
}

/// How much a limit is exceeded, relative to its bound; negative: kept.
double excess(const Limit& limit, const Evaluation& e) {
    return (limit.upper ? 1.0 : -1.0) * (e.value(limit.quantity) - limit.bound) / std::abs(limit.bound);
}
bool feasible(const design::Problem& problem, const Evaluation& e) {
    return e.status == EvaluationStatus::ok && std::all_of(problem.limits.begin(), problem.limits.end(),
                                                           [&](const Limit& limit) { return excess(limit, e) <= 0.0; });
}

double value_of(const std::vector<std::pair<Key, double>>& design, Key wanted) {
    for (const auto& [key, value] : design) {
        if (key == wanted) { return value; }
    }
    return std::nan("");
}

}  // namespace

TEST_CASE("three layers win with more than 3.37 N, four are infeasible") {
    const OptimiseStudyResult& r = solved().result;
    INFO(r.reason);
    MESSAGE("peak force ", r.best.value(Quantity::peak_force), " N, KKT residual ", r.kkt_residual, ", ", r.evaluations,
            " evaluations, ", r.seconds, " s");
    CHECK(r.status == verbs::OptimiseStatus::optimal);
    CHECK(r.ending == verbs::Ending::verified);
    CHECK(r.best.status == EvaluationStatus::ok);
    CHECK(r.best.value(Quantity::peak_force) > 3.37);
    CHECK(value_of(r.design, percuss::model::membrane::key::layers) == 3.0);
    CHECK(r.kkt_residual < 1e-6);
    CHECK(r.objective_error < 1e-9 * r.best.value(Quantity::peak_force));
    REQUIRE(r.per_layers.size() == 4);
    double best = 0.0;
    for (std::size_t i = 0; i < 4; ++i) {
        const verbs::IntegerCaseReport& report = r.per_layers[i];
        CAPTURE(report.layers);
        CAPTURE(report.reason);
        CHECK(report.layers == static_cast<double>(i + 1));
        if (i < 3) {
            CHECK(report.status == verbs::OptimiseStatus::optimal);
            CHECK(report.kkt_residual < 1e-6);
            CHECK(report.objective > 0.0);
            best = std::max(best, report.objective);
        }
    }
    CHECK(best == test::relative(r.best.value(Quantity::peak_force), 1e-12));
    // The reason names what stands in the way.
    const verbs::IntegerCaseReport& four = r.per_layers[3];
    CHECK(four.status == verbs::OptimiseStatus::infeasible);
    bool names_a_limit = false;
    for (const Limit& limit : solved().problem.design.limits) {
        names_a_limit = names_a_limit || four.reason.find(limit.text) != std::string::npos;
    }
    CHECK(names_a_limit);
    // The optimum is interior in all variables, with several limits active.
    for (const design::DesignVariable& v : solved().problem.design.variables) {
        if (v.integer) { continue; }
        const double x = value_of(r.design, v.key);
        CAPTURE(model::key_info(v.key).name);
        CHECK(x > v.lower + 0.01 * (v.upper - v.lower));
        CHECK(x < v.upper - 0.01 * (v.upper - v.lower));
    }
    CHECK(std::count_if(r.limits.begin(), r.limits.end(), [](const auto& limit) { return limit.active; }) >= 2);
}

TEST_CASE("the optimum keeps its limits and satisfies the optimality conditions, looked at from outside") {
    const Solved& s = solved();
    REQUIRE(s.result.status == verbs::OptimiseStatus::optimal);
    const design::Problem& problem = s.problem.design;
    const design::Evaluator evaluator(problem);
    const Specification spec = specification(problem, s.result.design);
    std::vector<Key> keys;
    for (const design::DesignVariable& v : problem.variables) {
        if (!v.integer) { keys.push_back(v.key); }
    }
    design::Demand demand;
    demand.quantities = verbs::wanted_quantities(problem);
    demand.gradients = keys;
    const Evaluation e = evaluator.evaluate(spec, demand);
    REQUIRE(e.status == EvaluationStatus::ok);
    // The optimum was verified at a tighter tolerance; a cold evaluation of the same design gives the same.
    for (const Quantity q : demand.quantities) { CHECK(e.value(q) == test::relative(s.result.best.value(q), 1e-9)); }
    const auto gradient = [&](Quantity q, std::size_t j) {
        return e.gradients.quantity[static_cast<std::size_t>(q)][j];
    };
    for (std::size_t j = 0; j < keys.size(); ++j) {
        CAPTURE(model::key_info(keys[j]).name);
        const double x = spec.value(keys[j]);
        // d(force)/dx = sum of multiplier d(quantity)/dx: gains balanced by what the limits would charge. In newtons
        // per relative change of x.
        double balance = x * gradient(Quantity::peak_force, j);
        double size = std::abs(balance);
        for (std::size_t i = 0; i < problem.limits.size(); ++i) {
            const verbs::LimitReport& report = s.result.limits[i];
            const double charge =
                (report.upper ? 1.0 : -1.0) * report.multiplier * x * gradient(problem.limits[i].quantity, j);
            balance -= charge;
            size += std::abs(charge);
        }
        CHECK(std::abs(balance) < 1e-5 * size);
    }
    REQUIRE(s.result.limits.size() == problem.limits.size());  // no bound of a variable is active
    for (std::size_t i = 0; i < problem.limits.size(); ++i) {
        const verbs::LimitReport& report = s.result.limits[i];
        CAPTURE(report.text);
        CHECK(report.value == test::relative(e.value(problem.limits[i].quantity), 1e-9));
        CHECK(report.multiplier >= 0.0);
        CHECK(excess(problem.limits[i], e) < 1e-6);
        CHECK(report.active == (std::abs(excess(problem.limits[i], e)) < 1e-6));
        // Complementarity, in newtons per unit of the relative limit.
        if (!report.active) { CHECK(report.multiplier * report.limit < 1e-5); }
    }
}

TEST_CASE("a multiplier is what a wider limit gains") {
    verbs::StudyProblem problem = solved().problem;
    REQUIRE(solved().result.status == verbs::OptimiseStatus::optimal);
    problem.design.actuator.set(Key::layers, 3.0);
    std::erase_if(problem.design.variables, [](const design::DesignVariable& v) { return v.integer; });
    const verbs::LimitReport* active = nullptr;
    std::size_t which = 0;
    for (std::size_t i = 0; i < problem.design.limits.size(); ++i) {
        const verbs::LimitReport& report = solved().result.limits[i];
        if (report.active && report.multiplier * report.limit > 0.05) {
            active = &report;
            which = i;
            break;
        }
    }
    REQUIRE(active != nullptr);
    const double change = 1e-3 * active->limit;
    std::array<double, 2> force{};
    for (int side = 0; side < 2; ++side) {
        problem.design.limits[which].bound = active->limit + (side == 0 ? -change : change);
        const OptimiseStudyResult r = verbs::run_optimise(problem, nullptr, {}, {});
        INFO(r.reason);
        REQUIRE(r.status == verbs::OptimiseStatus::optimal);
        CHECK(r.per_layers.size() == 1);
        force[static_cast<std::size_t>(side)] = r.best.value(Quantity::peak_force);
    }
    const double gain = (active->upper ? 1.0 : -1.0) * (force[1] - force[0]) / (2.0 * change);
    CAPTURE(active->text);
    // Central difference over 0.1 %, of optima certified to 1e-6.
    CHECK(gain == test::relative(active->multiplier, 5e-3));
}

TEST_CASE("a thousand random designs hold nothing feasible that is better, nor does the neighbourhood") {
    const Solved& s = solved();
    REQUIRE(s.result.status == verbs::OptimiseStatus::optimal);
    const design::Problem& problem = s.problem.design;
    const design::Evaluator evaluator(problem);
    design::Demand demand;
    demand.quantities = verbs::wanted_quantities(problem);
    const double optimum = s.result.best.value(Quantity::peak_force);
    test::Random random(2024);
    std::map<std::string, int> tally;
    double best = 0.0;
    std::string best_design;
    const auto look = [&](const Specification& spec) {
        const Evaluation e = evaluator.evaluate(spec, demand);
        const bool good = feasible(problem, e);
        ++tally[good                               ? "feasible"
                : e.status == EvaluationStatus::ok ? "beyond a limit"
                                                   : std::string(design::to_string(e.status))];
        if (good && e.value(Quantity::peak_force) > best) {
            best = e.value(Quantity::peak_force);
            best_design.clear();
            for (const design::DesignVariable& v : problem.variables) {
                best_design +=
                    std::string(model::key_info(v.key).name) + " = " + std::to_string(spec.value(v.key)) + " ";
            }
        }
        return good;
    };
    for (int i = 0; i < 1000; ++i) {
        Specification spec = problem.actuator;
        for (const design::DesignVariable& v : problem.variables) {
            const double x = v.logarithmic ? random.log_uniform(v.lower, v.upper)
                           : v.integer     ? std::floor(random.uniform(v.lower, v.upper + 1.0))
                                           : random.uniform(v.lower, v.upper);
            spec.set(v.key, x);
        }
        look(spec);
    }
    std::string summary;
    for (const auto& [name, count] : tally) { summary += name + " " + std::to_string(count) + ", "; }
    MESSAGE("of 1000 designs ", summary, "best ", best, " N with ", best_design);
    CHECK(best < optimum);
    CHECK(tally["feasible"] > 10);  // the search does meet feasible designs
    CHECK(tally["failed"] <= 10);   // and few that cannot be judged

    // Within 3 % of the optimum, where there is something to gain if anywhere.
    const Specification at_optimum = specification(problem, s.result.design);
    best = 0.0;
    int near_feasible = 0;
    for (int i = 0; i < 400; ++i) {
        Specification spec = at_optimum;
        const double radius = random.log_uniform(1e-4, 3e-2);
        for (const design::DesignVariable& v : problem.variables) {
            if (v.integer) { continue; }
            spec.set(v.key, spec.value(v.key) * (1.0 + radius * random.uniform(-1.0, 1.0)));
        }
        near_feasible += look(spec) ? 1 : 0;
    }
    CAPTURE(best_design);
    CHECK(near_feasible > 5);
    // Limits are met to 1e-8 of their bounds, which is worth up to a few 1e-8 of the force.
    CHECK(best < optimum * (1.0 + 1e-7));
}
