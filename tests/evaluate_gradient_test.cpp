// Gradients of every reported quantity against differences of the program itself, from the problem's keys through
// scaling, edge, operating point and orbit to the quantity.

#include "design_cases.hpp"
#include "engine_cases.hpp"
#include "model/membrane/membrane.hpp"
#include "model/spring/spring.hpp"

#include <doctest/doctest.h>

#include <cmath>
#include <string>
#include <vector>

using namespace percuss;
using design::Demand;
using design::Evaluation;
using design::EvaluationStatus;
using design::Quantity;
using model::Key;
using model::Specification;
using test::everything;

namespace {

/// Every quantity that has a gradient, and the frequencies of the operating point.
struct Component {
    std::string name;
    double value;
    const std::vector<double>* gradient;
};
std::vector<Component> components(const Demand& demand, const Evaluation& e) {
    std::vector<Component> all;
    for (const Quantity q : demand.quantities) {
        const design::QuantityInfo& info = design::quantity_info(q);
        if (!info.smooth) { continue; }
        all.push_back({std::string(info.name), e.value(q), &e.gradients.quantity[static_cast<std::size_t>(q)]});
    }
    all.push_back({"omega", e.operating_point.omega, &e.gradients.omega});
    if (e.operating_point.edge_kind != design::EdgeKind::given) {
        all.push_back({"edge_omega", e.operating_point.edge_omega, &e.gradients.edge_omega});
    }
    return all;
}

struct Worst {
    double error = 0.0;
    std::string where;
};

/// All gradients of one design by all given keys; `agreement` is relative to the gradient itself, or where that is
/// small to a hundredth of value/key.
void check_design(const design::Evaluator& evaluator, const Specification& spec, const std::vector<Key>& keys,
                  double agreement, Worst& worst) {
    Demand with_gradients = everything(spec);
    with_gradients.gradients = keys;
    const Demand plain = everything(spec);
    const Evaluation base = evaluator.evaluate(spec, with_gradients);
    REQUIRE(base.status == EvaluationStatus::ok);
    const std::vector<Component> exact = components(with_gradients, base);
    for (std::size_t i = 0; i < keys.size(); ++i) {
        const Key key = keys[i];
        const double x = spec.value(key);
        INFO("by ", model::key_info(key).name, " = ", x);
        const auto numeric = test::ridders_many(
            [&](double amount) {
                Specification moved = spec;
                moved.set(key, x + amount);
                const Evaluation e = evaluator.evaluate(moved, plain);
                REQUIRE(e.status == EvaluationStatus::ok);
                std::vector<double> values;
                for (const Component& c : components(plain, e)) { values.push_back(c.value); }
                return values;
            },
            exact.size(), 2e-3 * x, 5);
        for (std::size_t c = 0; c < exact.size(); ++c) {
            REQUIRE(exact[c].gradient->size() == keys.size());
            const double gradient = (*exact[c].gradient)[i];
            const double scale = std::abs(gradient) + 0.01 * std::abs(exact[c].value) / x;
            const double error = std::abs(gradient - numeric[c].value) / scale;
            INFO(exact[c].name, " = ", exact[c].value);
            CAPTURE(gradient);
            CAPTURE(numeric[c].value);
            CAPTURE(numeric[c].error / scale);
            // The reference must be able to judge.
            CHECK(numeric[c].error < 0.3 * agreement * scale);
            CHECK(error < agreement);
            if (error > worst.error) {
                worst = {error, exact[c].name + " by " + std::string(model::key_info(key).name)};
            }
        }
    }
}

std::vector<Key> nonzero_keys(const Specification& spec) {
    std::vector<Key> keys;
    for (const Key key : spec.type->keys) {
        if (spec.has(key) && spec.value(key) != 0.0) { keys.push_back(key); }
    }
    return keys;
}

}  // namespace

TEST_CASE("ten random actuators, by every key, at the operating point below their edges") {
    const design::Problem problem = test::shipped_problem("wu2022-actuator").design;
    const design::Evaluator evaluator(problem);
    test::Random random(41);
    Worst worst;
    int done = 0;
    int tried = 0;
    for (; done < 10 && tried < 40; ++tried) {
        CAPTURE(tried);
        Specification spec = problem.actuator;
        spec.set(Key::stop_gap, random.uniform(0.3e-3, 1.0e-3));
        spec.set(Key::stop_stiffness, random.log_uniform(15e3, 150e3));
        spec.set(percuss::model::membrane::key::drive_voltage, random.uniform(2000.0, 3600.0));
        spec.set(percuss::model::membrane::key::prestretch, random.uniform(1.05, 1.2));
        spec.set(percuss::model::membrane::key::layers, random.uniform(1.0, 3.5));
        for (const Key key :
             {percuss::model::membrane::key::moving_mass, percuss::model::membrane::key::membrane_thickness,
              percuss::model::membrane::key::rod_length, percuss::model::membrane::key::inner_radius,
              percuss::model::membrane::key::outer_radius}) {
            spec.set(key, spec.value(key) * random.uniform(0.85, 1.15));
        }
        if (evaluator.evaluate(spec, everything(spec)).status != EvaluationStatus::ok) { continue; }
        // Differences are good to 1e-8; lanes of multipliers to 1e-7.
        check_design(evaluator, spec, nonzero_keys(spec), 1e-6, worst);
        ++done;
    }
    REQUIRE(done == 10);
    CHECK(tried <= 15);  // most of this box strikes
    MESSAGE("largest relative error of a gradient ", worst.error, ": ", worst.where);
}

TEST_CASE("the nondimensional problem, by every key") {
    design::Problem problem = test::shipped_problem("wu2022-nondimensional").design;
    problem.actuator.set(percuss::model::membrane::key::nd_layers,
                         1.2);  // one is the least allowed: no differences there
    Worst worst;
    for (const model::ContactLaw law : {model::ContactLaw::kelvin_voigt, model::ContactLaw::no_tension}) {
        problem.actuator.law = law;
        const design::Evaluator evaluator(problem);
        check_design(evaluator, problem.actuator, nonzero_keys(problem.actuator), 1e-6, worst);
        Specification other = problem.actuator;
        other.set(percuss::model::membrane::key::nd_alpha_a, 2.6);
        other.set(percuss::model::membrane::key::nd_alpha_b, 2.5);
        other.set(percuss::model::membrane::key::nd_layers, 3.0);
        other.set(percuss::model::membrane::key::nd_voltage, 0.5);
        other.set(percuss::model::membrane::key::nd_damping, 60.0);  // the largest force is that of entry
        check_design(evaluator, other, nonzero_keys(other), 1e-6, worst);
    }
    // Without Maxwell branches.
    Specification elastic = problem.actuator;
    elastic.law = model::ContactLaw::kelvin_voigt;
    elastic.set(percuss::model::membrane::key::nd_mu_ratio, 0.0);
    elastic.set(percuss::model::membrane::key::nd_delta_a, 0.5);
    problem.actuator = elastic;
    const design::Evaluator evaluator(problem);
    std::vector<Key> keys = nonzero_keys(elastic);
    std::erase_if(keys, [](Key key) {
        return key == percuss::model::membrane::key::nd_alpha_b || key == percuss::model::membrane::key::nd_delta_b;
    });
    check_design(evaluator, elastic, keys, 1e-6, worst);
    MESSAGE("largest relative error of a gradient ", worst.error, ": ", worst.where);
}

TEST_CASE("a spring and mass, and given frequencies") {
    Worst worst;
    design::Problem soft = test::shipped_problem("soft-impact").design;
    soft.actuator.set(Key::stop_damping, 0.3);
    soft.actuator.set(percuss::model::spring::key::damping, 0.1);
    soft.actuator.set(percuss::model::spring::key::cubic, 0.05);
    soft.actuator.set(percuss::model::spring::key::force, 0.3);
    check_design(design::Evaluator(soft), soft.actuator, nonzero_keys(soft.actuator), 1e-6, worst);

    design::Problem actuator = test::shipped_problem("wu2022-actuator").design;
    actuator.actuator.set(Key::drive_frequency, 57.0);
    actuator.actuator.set(percuss::model::membrane::key::layers, 1.1);
    check_design(design::Evaluator(actuator), actuator.actuator, nonzero_keys(actuator.actuator), 1e-6, worst);
    MESSAGE("largest relative error of a gradient ", worst.error, ": ", worst.where);
}

TEST_CASE("an edge that is a loss of stability, not a grazing") {
    // The free motion meets a torus point first; its frequency, found by the bordered systems' differences, moves with
    // the design and takes the operating point along.
    design::Problem problem = test::shipped_problem("wu2022-nondimensional").design;
    Specification& spec = problem.actuator;
    spec.set(percuss::model::membrane::key::nd_voltage, 0.232);
    spec.set(percuss::model::membrane::key::nd_delta_a, 0.022);
    spec.set(percuss::model::membrane::key::nd_delta_b, 390.0);
    spec.set(percuss::model::membrane::key::nd_gap, 0.3);
    spec.set(percuss::model::membrane::key::nd_layers, 1.01);
    const design::Evaluator evaluator(problem);
    const Evaluation base = evaluator.evaluate(spec, everything(spec));
    REQUIRE(base.operating_point.edge_kind == design::EdgeKind::torus);
    Worst worst;
    check_design(evaluator, spec,
                 {percuss::model::membrane::key::nd_voltage, percuss::model::membrane::key::nd_delta_a,
                  percuss::model::membrane::key::nd_stiffness, percuss::model::membrane::key::nd_gap,
                  percuss::model::membrane::key::nd_layers},
                 3e-6, worst);
    MESSAGE("largest relative error of a gradient ", worst.error, ": ", worst.where);
}
