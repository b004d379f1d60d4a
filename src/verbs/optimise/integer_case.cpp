#include "verbs/optimise/integer_case.hpp"

#include <cmath>
#include <stdexcept>
#include <utility>

namespace percuss::verbs {

using optimise::Vector;

bool better(const design::Problem& problem, const IntegerCase& a, const IntegerCase& b) {
    return problem.objectives.front().maximise ? a.report.objective > b.report.objective
                                               : a.report.objective < b.report.objective;
}

const IntegerCase* best_of(const design::Problem& problem, const std::vector<IntegerCase>& cases) {
    const IntegerCase* best = nullptr;
    for (const IntegerCase& c : cases) {
        if (!c.verified || c.verified->status != design::EvaluationStatus::ok) { continue; }
        const bool differ = best != nullptr && c.optimal() != best->optimal();  // a certified case comes first
        if (best == nullptr || (differ ? c.optimal() : better(problem, c, *best))) { best = &c; }
    }
    return best;
}

IntegerCase* best_of(const design::Problem& problem, std::vector<IntegerCase>& cases) {
    return const_cast<IntegerCase*>(best_of(problem, std::as_const(cases)));
}

std::vector<model::Specification> enumerate_integers(const design::Problem& problem) {
    std::vector<model::Specification> cases = {problem.actuator};
    for (const design::DesignVariable& v : problem.variables) {
        if (!v.integer) { continue; }
        std::vector<model::Specification> extended;
        for (const model::Specification& base : cases) {
            for (double value = std::ceil(v.lower); value <= v.upper; value += 1.0) {
                extended.push_back(base);
                extended.back().set(v.key, value);
            }
        }
        cases = std::move(extended);
    }
    if (cases.empty()) { throw std::invalid_argument("design.variable: an integer range holds no integer"); }
    // Each case is a nonlinear problem of its own: hundreds of them are hardly meant.
    if (cases.size() > 256) {
        throw std::invalid_argument("design.variable: integer variables have more than 256 combinations");
    }
    return cases;
}

double first_integer_value(const design::Problem& problem, const model::Specification& spec) {
    for (const design::DesignVariable& v : problem.variables) {
        if (v.integer) { return spec.value(v.key); }
    }
    return design::absent;
}

std::string describe_failures(const DesignNlp& nlp) {
    std::string text = "no design of the box could be evaluated:";
    for (const auto& [status, count] : nlp.statuses()) {
        text += " " + std::to_string(count) + " " + std::string(design::to_string(status)) + ",";
    }
    text.pop_back();
    return text;
}

std::string describe_infeasible(const design::Problem& problem, const optimise::MultiStartResult& solved) {
    std::string names;
    const Vector& multipliers = solved.certificate.multipliers;
    const Vector& violations = solved.best.constraints;
    for (std::size_t i = 0; i < problem.limits.size(); ++i) {
        const int k = static_cast<int>(i);
        // The multipliers of the least infeasible point say which limits hold each other; in a problem whose functions
        // are scaled to one, those below 1e-3 count as zero.
        const bool blamed = multipliers.size() > k && multipliers[k] > 1e-3 && violations[k] > 0.0;
        if (blamed) { names += (names.empty() ? "" : " and ") + problem.limits[i].text; }
    }
    if (names.empty()) {
        int worst = 0;
        // Without multipliers the limit that is missed by most.
        violations.maxCoeff(&worst);
        names = problem.limits[static_cast<std::size_t>(worst)].text;
    }
    return "no design was found that meets the limit " + names;
}

namespace {

struct Report {
    const design::Problem& problem;
    const design::Evaluator& evaluator;
    const IntegerCase& best;
    double scale;  ///< of the objective
    const DesignNlp nlp{evaluator, best.fixed, scale, nullptr};
    std::vector<LimitReport> limits{};
};

/// The limits of the problem in their own units.
void add_limits(Report& r) {
    for (std::size_t i = 0; i < r.problem.limits.size(); ++i) {
        const design::Limit& limit = r.problem.limits[i];
        LimitReport report;
        report.name = design::quantity_info(limit.quantity).name;
        report.text = limit.text;
        report.value = r.best.verified->value(limit.quantity);
        report.limit = limit.bound;
        report.upper = limit.upper;
        const double multiplier = r.best.certificate.multipliers[static_cast<int>(i)];
        report.active = std::abs(report.value - limit.bound) <= activity * r.nlp.limit_scale(i);
        // Back from scaled objective and limit to the gain of the objective per unit of the bound.
        report.multiplier = multiplier * r.scale / r.nlp.limit_scale(i);
        r.limits.push_back(report);
    }
}

/// The windows kept off, as limits on omega; those that have vanished at the best design are left out.
void add_windows(Report& r) {
    const model::Specification spec = r.nlp.specification(r.best.x);
    for (std::size_t i = 0; i < r.best.exclusions.size(); ++i) {
        const Exclusion& e = r.best.exclusions[i];
        const design::WindowAt window = design::window_at(r.evaluator.system(spec), *e.intruder, spec, {});
        if (window.status != design::WindowAt::Status::found) { continue; }
        LimitReport report;
        report.name = "omega";
        report.upper = e.below;
        // In rad/s as documents tell it; a nondimensional problem has omega itself.
        const double time = spec.type->nondimensional ? 1.0 : model::scale(spec).scales.time;
        report.limit = e.below ? (1.0 - e.margin) * window.lower : (1.0 + e.margin) * window.upper;
        report.limit /= time;
        report.value = r.best.verified->operating_point.omega / time;
        report.text = std::string(e.below ? "omega below" : "omega above") + " the window of the motion of period " +
                      std::to_string(e.intruder->period);
        report.active = std::abs(report.value / report.limit - 1.0) <= activity;
        report.multiplier =
            r.best.certificate.multipliers[static_cast<int>(r.problem.limits.size() + i)] * r.scale / report.limit;
        r.limits.push_back(report);
    }
}

/// Only bounds that the best design lies on: the others say nothing.
void add_active_bounds(Report& r) {
    const auto& variables = r.nlp.continuous();
    for (std::size_t j = 0; j < variables.size(); ++j) {
        const double unit = r.best.x[static_cast<int>(j)];
        const bool at_upper = unit >= 1.0 - activity;
        if (!at_upper && unit > activity) { continue; }
        LimitReport report;
        report.name = model::key_info(variables[j].key).name;
        report.upper = at_upper;
        report.limit = at_upper ? variables[j].upper : variables[j].lower;
        report.value = variables[j].value(unit);
        report.text = report.name + (at_upper ? " at its upper bound" : " at its lower bound");
        report.active = true;
        const double scaled = std::abs(r.best.certificate.bound_multipliers[static_cast<int>(j)]);
        // d(objective)/d(value) from d(scaled objective)/d(unit variable).
        report.multiplier = scaled * r.scale / variables[j].slope(unit);
        r.limits.push_back(report);
    }
}

}  // namespace

std::vector<LimitReport> report_limits(const design::Problem& problem, const design::Evaluator& evaluator,
                                       const IntegerCase& best, double objective_scale) {
    Report report{problem, evaluator, best, objective_scale};
    add_limits(report);
    add_windows(report);
    add_active_bounds(report);
    return std::move(report.limits);
}

}  // namespace percuss::verbs
