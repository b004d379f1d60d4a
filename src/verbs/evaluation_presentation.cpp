#include "verbs/evaluation_results.hpp"

#include "model/number_text.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

namespace percuss::verbs {

using design::Evaluation;
using design::Quantity;
using problem::ProblemFile;
using results::Block;
using results::missing;
using results::number;
using results::omega_digits;
using results::Presentation;
using results::quantity_text;
using results::sentence;
using results::value_text;

namespace {

constexpr int gradient_digits = 8;
constexpr int multiplier_digits = 9;
constexpr std::size_t gradients_across = 5;  // so that lines stay short

/// An error estimate: two digits in the unit itself, so that estimates compare at a glance.
std::string error_text(const ProblemFile& problem, Quantity quantity, double value) {
    const std::string unit = results::si_unit(problem, design::quantity_info(quantity).unit);
    return std::isnan(value) ? missing : model::number_text(value, 2) + (unit.empty() ? "" : " " + unit);
}

Block quantities_block(const ProblemFile& problem, const Evaluation& evaluation) {
    Block block{"Quantities", "", {"quantity", "value", "error estimate", "meaning"}, {}};
    for (const Quantity quantity : design::reported_quantities(*problem.design.actuator.type)) {
        const double value = evaluation.value(quantity);
        if (!std::isnan(value)) {
            const double error = evaluation.error_estimates[static_cast<std::size_t>(quantity)];
            const design::QuantityInfo& info = design::quantity_info(quantity);
            block.rows.push_back({std::string(info.name), quantity_text(problem, quantity, value),
                                  error_text(problem, quantity, error), std::string(info.meaning)});
        }
    }
    return block;
}

Block orbit_block(const ProblemFile& problem, const design::OrbitReport& orbit) {
    Block block{"Orbit", "", {"property", "value"}, {}};
    const auto entries = results::state_entries(problem);
    for (std::size_t i = 0; i < orbit.state.size() && i < entries.size(); ++i) {
        const std::string& unit = entries[i].unit;
        const std::string at = i < 2 ? " at theta = 0" : "";
        block.rows.push_back({entries[i].name + at,
                              model::number_text(orbit.state[i], omega_digits) + (unit.empty() ? "" : " " + unit)});
    }
    block.rows.push_back({"x_max", value_text(problem, orbit.x_max, "m")});
    block.rows.push_back({"x_min", value_text(problem, orbit.x_min, "m")});
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

}  // namespace

Block design_block(const DesignValues& design) {
    Block block{"Design", "", {"key", "value"}, {}};
    for (const auto& [key, value] : design) {
        block.rows.push_back({std::string(model::key_info(key).name), problem::text_of(key, value)});
    }
    return block;
}

Block operating_point_block(const ProblemFile& problem, const design::OperatingPoint& point, PointMembers members) {
    Block block{"Operating point", "", {"property", "value"}, {}};
    block.rows.push_back({"drive_frequency", quantity_text(problem, Quantity::drive_frequency, point.drive_frequency)});
    block.rows.push_back({"omega (nondimensional)", number(point.omega, omega_digits)});
    if (members == PointMembers::without_edge) { return block; }
    block.rows.push_back({"edge kind", std::string(design::to_string(point.edge_kind))});
    block.rows.push_back({"edge omega (nondimensional)", number(point.edge_omega, omega_digits)});
    if (members == PointMembers::all) {
        block.rows.push_back({"distance from edge down to fold, relative", number(point.fold_offset)});
    }
    block.rows.push_back({"margin", number(point.margin)});
    return block;
}

void add_evaluation(const ProblemFile& problem, const Evaluation& evaluation, WithEdge edge, Presentation& out) {
    out.blocks.push_back(operating_point_block(problem, evaluation.operating_point,
                                               edge == WithEdge::yes ? PointMembers::all : PointMembers::without_edge));
    out.blocks.push_back(quantities_block(problem, evaluation));
    if (!evaluation.orbit.state.empty()) { out.blocks.push_back(orbit_block(problem, evaluation.orbit)); }
    for (Block& block : gradient_blocks(evaluation, *problem.design.actuator.type)) {
        out.blocks.push_back(std::move(block));
    }
    out.blocks.push_back(uniqueness_block(evaluation.uniqueness));
    results::drop_empty_blocks(out);
}

}  // namespace percuss::verbs
