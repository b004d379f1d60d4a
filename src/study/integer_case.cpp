#include "study/integer_case.hpp"

#include <cmath>
#include <stdexcept>

namespace percuss::study {

using optimise::Vector;

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
        const bool blamed = multipliers.size() > k && multipliers[k] > 1e-3 && violations[k] > 0.0;
        if (blamed) { names += (names.empty() ? "" : " and ") + problem.limits[i].text; }
    }
    if (names.empty()) {
        int worst = 0;
        violations.maxCoeff(&worst);
        names = problem.limits[static_cast<std::size_t>(worst)].text;
    }
    return "no design was found that meets the limit " + names;
}

}  // namespace percuss::study
