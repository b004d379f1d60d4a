#include "io/presentation.hpp"

#include "io/derived_parameters.hpp"
#include "model/number_text.hpp"
#include "model/units.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

namespace percuss::io {

namespace {

using design::Evaluation;
using design::Quantity;

constexpr int gradient_digits = 8;
constexpr int multiplier_digits = 9;
constexpr int omega_digits = 12;
constexpr std::size_t gradients_across = 5;
constexpr const char* missing = "-";

std::string or_missing(double value, std::string text) { return std::isnan(value) ? missing : std::move(text); }

std::string number(double value, int digits = 6) { return or_missing(value, model::number_text(value, digits)); }

std::string quantity_text(const ProblemFile& problem, Quantity quantity, double value) {
    return or_missing(value, text_of(problem, quantity, value));
}

/// An error estimate: two digits in the unit itself, so that estimates compare at a glance.
std::string error_text(const ProblemFile& problem, Quantity quantity, double value) {
    const std::string_view unit = units_of(problem) == "si" ? design::quantity_info(quantity).unit : "1";
    return or_missing(value, model::number_text(value, 2) + (unit == "1" ? "" : " " + std::string(unit)));
}

Block sentence(std::string words) {
    Block block;
    block.sentence = std::move(words);
    return block;
}

std::string status_sentence(const std::string& status, const std::string& reason) {
    return "status: " + status + (reason.empty() ? "" : " (" + reason + ")");
}

Block design_block(const std::vector<std::pair<model::Key, double>>& design) {
    Block block{"Design", "", {"key", "value"}, {}};
    for (const auto& [key, value] : design) {
        block.rows.push_back({std::string(model::key_info(key).name), text_of(key, value)});
    }
    return block;
}

std::vector<std::pair<model::Key, double>> variables_of(const design::Problem& problem) {
    std::vector<std::pair<model::Key, double>> values;
    for (const design::DesignVariable& variable : problem.variables) {
        values.emplace_back(variable.key, problem.actuator.value(variable.key));
    }
    return values;
}

Block operating_point_block(const ProblemFile& problem, const design::OperatingPoint& point, bool with_edge) {
    Block block{"Operating point", "", {"property", "value"}, {}};
    block.rows.push_back({"drive_frequency", quantity_text(problem, Quantity::drive_frequency, point.drive_frequency)});
    block.rows.push_back({"omega (nondimensional)", number(point.omega, omega_digits)});
    if (with_edge) {
        block.rows.push_back({"edge kind", std::string(design::to_string(point.edge_kind))});
        block.rows.push_back({"edge omega (nondimensional)", number(point.edge_omega, omega_digits)});
        block.rows.push_back({"distance from edge down to fold, relative", number(point.fold_offset)});
        block.rows.push_back({"margin", number(point.margin)});
    }
    return block;
}

Block quantities_block(const ProblemFile& problem, const Evaluation& evaluation) {
    Block block{"Quantities", "", {"quantity", "value", "error estimate", "meaning"}, {}};
    for (const Quantity quantity : design::reported_quantities(*problem.study.design.actuator.type)) {
        const double value = evaluation.value(quantity);
        if (!std::isnan(value)) {
            const double error = evaluation.error_estimates[static_cast<std::size_t>(quantity)];
            const design::QuantityInfo& info = design::quantity_info(quantity);
            block.rows.push_back({std::string(info.name), text_of(problem, quantity, value),
                                  error_text(problem, quantity, error), std::string(info.meaning)});
        }
    }
    return block;
}

Block orbit_block(const ProblemFile& problem, const design::OrbitReport& orbit) {
    Block block{"Orbit", "", {"property", "value"}, {}};
    const bool plain = units_of(problem) == "nondimensional";
    const std::vector<std::pair<std::string, std::string>> states = {
        {"x at theta = 0", plain ? "" : "m"}, {"x' at theta = 0", plain ? "" : "m/s"}, {"xi_I", ""}, {"xi_II", ""}};
    for (std::size_t i = 0; i < orbit.state.size() && i < states.size(); ++i) {
        const std::string& unit = states[i].second;
        block.rows.push_back(
            {states[i].first, model::number_text(orbit.state[i], omega_digits) + (unit.empty() ? "" : " " + unit)});
    }
    const std::string length = plain ? "" : "m";
    block.rows.push_back({"x_max", or_missing(orbit.x_max, model::format_quantity(orbit.x_max, length))});
    block.rows.push_back({"x_min", or_missing(orbit.x_min, model::format_quantity(orbit.x_min, length))});
    block.rows.push_back({"period in drive cycles", std::to_string(orbit.period)});
    block.rows.push_back({"contacts per period", std::to_string(orbit.contacts)});
    block.rows.push_back({"residual (nondimensional)", number(orbit.residual, 3)});
    for (const auto& multiplier : orbit.multipliers) {
        std::string text = model::number_text(multiplier.real(), multiplier_digits);
        if (multiplier.imag() != 0.0) {
            text += (multiplier.imag() < 0.0 ? " - " : " + ") +
                    model::number_text(std::abs(multiplier.imag()), multiplier_digits) + " i";
        }
        block.rows.push_back({"multiplier", text + ", modulus " + number(std::abs(multiplier), multiplier_digits)});
    }
    return block;
}

/// Keys down, quantities across, a few at a time so that lines stay short.
std::vector<Block> gradient_blocks(const Evaluation& evaluation, const model::Actuator& family) {
    std::vector<std::pair<std::string, const std::vector<double>*>> all;
    for (const Quantity quantity : design::reported_quantities(family)) {
        all.emplace_back(design::quantity_info(quantity).name,
                         &evaluation.gradients.quantity[static_cast<std::size_t>(quantity)]);
    }
    all.emplace_back("omega", &evaluation.gradients.omega);
    all.emplace_back("edge omega", &evaluation.gradients.edge_omega);
    std::erase_if(all, [&](const auto& entry) { return entry.second->size() != evaluation.gradient_keys.size(); });

    std::vector<Block> blocks;
    for (std::size_t begin = 0; begin < all.size() && !evaluation.gradient_keys.empty(); begin += gradients_across) {
        const std::size_t end = std::min(begin + gradients_across, all.size());
        Block block{begin == 0 ? "Gradients, per SI or nondimensional unit of the key" : "", "", {"derivative of"}, {}};
        for (std::size_t i = begin; i < end; ++i) { block.columns.push_back(all[i].first); }
        for (std::size_t row = 0; row < evaluation.gradient_keys.size(); ++row) {
            std::vector<std::string> cells = {std::string(model::key_info(evaluation.gradient_keys[row]).name)};
            for (std::size_t i = begin; i < end; ++i) {
                cells.push_back(number((*all[i].second)[row], gradient_digits));
            }
            block.rows.push_back(std::move(cells));
        }
        blocks.push_back(std::move(block));
    }
    return blocks;
}

Block uniqueness_block(const design::Uniqueness& uniqueness) {
    const std::string tier = "tier " + std::to_string(uniqueness.tier);
    std::string words = "uniqueness: " + std::string(design::to_string(uniqueness.verdict)) + ", ";
    words += uniqueness.checked.starts_with(tier) ? uniqueness.checked
           : uniqueness.checked.empty()           ? tier
                                                  : tier + ": " + uniqueness.checked;
    if (uniqueness.starts > 0) { words += "; " + std::to_string(uniqueness.starts) + " starts"; }
    return sentence(words);
}

void add_evaluation(const ProblemFile& problem, const Evaluation& evaluation, bool with_edge, Presentation& out) {
    out.blocks.push_back(operating_point_block(problem, evaluation.operating_point, with_edge));
    out.blocks.push_back(quantities_block(problem, evaluation));
    if (!evaluation.orbit.state.empty()) { out.blocks.push_back(orbit_block(problem, evaluation.orbit)); }
    for (Block& block : gradient_blocks(evaluation, *problem.study.design.actuator.type)) {
        out.blocks.push_back(std::move(block));
    }
    out.blocks.push_back(uniqueness_block(evaluation.uniqueness));
    std::erase_if(out.blocks, [](const Block& block) { return block.sentence.empty() && block.rows.empty(); });
}

Block limits_block(const study::OptimiseStudyResult& result) {
    Block block{"Limits", "", {"limit", "value", "bound", "active", "gain per unit of room"}, {}};
    for (const study::LimitReport& limit : result.limits) {
        block.rows.push_back({limit.text.empty() ? limit.name : limit.text, number(limit.value), number(limit.limit),
                              limit.active ? "active" : "", number(limit.multiplier)});
    }
    return block;
}

Block integer_cases_block(const ProblemFile& problem, const study::OptimiseStudyResult& result) {
    Block block{"Integer cases", "", {"layers", "status", "objective", "KKT residual", "remark"}, {}};
    const auto& objectives = problem.study.design.objectives;
    for (const study::IntegerCaseReport& report : result.per_layers) {
        const std::string objective = objectives.empty()
                                        ? number(report.objective)
                                        : quantity_text(problem, objectives.front().quantity, report.objective);
        block.rows.push_back(
            {number(report.layers), report.status, objective, number(report.kkt_residual, 2), report.reason});
    }
    return block;
}

}  // namespace

namespace {

Block counterexamples_block(const ProblemFile& problem, const study::OptimiseStudyResult& result) {
    Block block{"Counterexamples: motions that were found beside the best design so far",
                "",
                {"layers", "objective there", "period", "peak force", "exists from", "to", "remedy"},
                {}};
    const auto& objectives = problem.study.design.objectives;
    for (const study::Counterexample& found : result.counterexamples) {
        const std::string objective = objectives.empty()
                                        ? number(found.objective)
                                        : quantity_text(problem, objectives.front().quantity, found.objective);
        block.rows.push_back({number(found.layers), objective,
                              found.period > 0 ? std::to_string(found.period) : "aperiodic",
                              quantity_text(problem, Quantity::peak_force, found.peak_force),
                              quantity_text(problem, Quantity::drive_frequency, found.window_lower),
                              quantity_text(problem, Quantity::drive_frequency, found.window_upper), found.remedy});
    }
    return block;
}

/// What it cost to be alone.
Block price_block(const ProblemFile& problem, const study::OptimiseStudyResult& result) {
    if (std::isnan(result.objective_unrefuted) || result.status != "optimal") { return sentence(""); }
    const Quantity objective = problem.study.design.objectives.front().quantity;
    const double now = result.best.value(objective);
    return sentence("Price of being the only stable motion found: " +
                    std::string(design::quantity_info(objective).name) + " " + quantity_text(problem, objective, now) +
                    " instead of " + quantity_text(problem, objective, result.objective_unrefuted) + " (" +
                    number(100.0 * (now / result.objective_unrefuted - 1.0), 3) + " %)");
}

}  // namespace

Presentation present_check(const ProblemFile& problem) {
    Presentation out;
    out.title = problem.name + ": problem as understood";
    out.blocks.push_back(settings_block(problem));
    Block derived{"Derived", "", {"parameter", "value", "meaning"}, {}};
    for (const DerivedParameter& parameter : derived_parameters(problem)) {
        derived.rows.push_back(
            {parameter.name, model::format_quantity(parameter.value, parameter.unit), parameter.meaning});
    }
    if (!derived.rows.empty()) { out.blocks.push_back(derived); }
    if (problem.troubles.empty()) { out.blocks.push_back(sentence("Nothing is missing and every value is in range.")); }
    return out;
}

Presentation present_evaluation(const ProblemFile& problem, const study::EvaluateStudyResult& result) {
    Presentation out;
    out.title = problem.name + ": evaluation";
    const Evaluation& evaluation = result.evaluation;
    out.blocks.push_back(
        sentence(status_sentence(std::string(design::to_string(evaluation.status)), evaluation.reason)));
    out.blocks.push_back(design_block(variables_of(problem.study.design)));
    add_evaluation(problem, evaluation, true, out);
    return out;
}

Presentation present_orbit(const ProblemFile& problem, const study::OrbitStudyResult& result) {
    Presentation out;
    out.title = problem.name + ": periodic orbit";
    const Evaluation& evaluation = result.evaluation;
    out.blocks.push_back(
        sentence(status_sentence(std::string(design::to_string(evaluation.status)), evaluation.reason)));
    add_evaluation(problem, evaluation, false, out);
    return out;
}

Presentation present_optimum(const ProblemFile& problem, const study::OptimiseStudyResult& result) {
    Presentation out;
    out.title = problem.name + ": optimum";
    out.blocks.push_back(sentence(status_sentence(result.status, result.reason)));
    out.blocks.push_back(design_block(result.design));
    add_evaluation(problem, result.best, true, out);
    out.blocks.push_back(limits_block(result));
    out.blocks.push_back(integer_cases_block(problem, result));
    out.blocks.push_back(counterexamples_block(problem, result));
    out.blocks.push_back(price_block(problem, result));
    out.blocks.push_back(sentence("KKT residual " + number(result.kkt_residual, 3) + ", " +
                                  std::to_string(result.evaluations) + " evaluations in " + number(result.seconds, 3) +
                                  " s"));
    std::erase_if(out.blocks, [](const Block& block) { return block.sentence.empty() && block.rows.empty(); });
    return out;
}

Block settings_block(const ProblemFile& problem) {
    Block block{"Problem", "", {"key", "value", "origin", "remark"}, {}};
    for (const ResolvedSetting& setting : problem.settings) {
        const char* origin = setting.origin == Origin::file   ? "file"
                           : setting.origin == Origin::option ? "option"
                                                              : "default";
        const bool absent = setting.text.empty();
        std::string remark = setting.trouble;
        if (!remark.empty() && absent && remark.starts_with(setting.name + " is missing")) {
            remark = remark.substr(setting.name.size() + 1);
        }
        block.rows.push_back({setting.name, absent ? missing : setting.text, absent ? "" : origin, remark});
    }
    return block;
}

}  // namespace percuss::io
