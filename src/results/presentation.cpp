#include "results/presentation.hpp"

#include "model/number_text.hpp"
#include "model/units.hpp"

#include <array>
#include <cmath>
#include <utility>

namespace percuss::results {

using problem::ProblemFile;

Block sentence(std::string words) {
    Block block;
    block.sentence = std::move(words);
    return block;
}

Block status_sentence(std::string_view status, std::string_view reason) {
    return sentence("status: " + std::string(status) + (reason.empty() ? "" : " (" + std::string(reason) + ")"));
}

void drop_empty_blocks(Presentation& presentation) {
    std::erase_if(presentation.blocks, [](const Block& b) { return b.sentence.empty() && b.rows.empty(); });
}

std::string number(double value, int digits) { return std::isnan(value) ? missing : model::number_text(value, digits); }

std::string quantity_text(const ProblemFile& problem, design::Quantity quantity, double value) {
    return std::isnan(value) ? missing : problem::text_of(problem, quantity, value);
}

std::string value_text(const ProblemFile& problem, double value, std::string_view unit) {
    return std::isnan(value) ? missing : model::format_quantity(value, si_unit(problem, unit));
}

ShownUnit shown_unit(double value, std::string_view unit) {
    const std::string text = model::format_quantity(value, unit);
    std::string_view rest;
    const auto shown = model::leading_number(text, rest);
    const std::string name(model::trimmed(rest));
    // Zero has no size to choose a prefix by.
    if (!shown || !std::isfinite(value) || name.empty() || *shown == 0.0) { return {std::string(unit), 1.0}; }
    // A prefix is a power of a thousand (of ten for lengths in cm); the shown number is rounded, the power is not.
    return {name, std::pow(10.0, std::round(std::log10(value / *shown)))};
}

std::string si_unit(const ProblemFile& problem, std::string_view unit) {
    return problem::is_nondimensional(problem.design) || unit == "1" ? "" : std::string(unit);
}

std::string unit_of(const ProblemFile& problem, design::Quantity quantity) {
    const bool plain = problem::is_nondimensional(problem.design);
    return plain ? "" : std::string(design::quantity_info(quantity).unit);
}

std::string unit_of(const ProblemFile& problem, model::Key key) {
    const bool plain = problem::is_nondimensional(problem.design);
    return plain ? "" : std::string(model::key_info(key).unit);
}

std::vector<StateEntry> state_entries(const ProblemFile& problem) {
    std::vector<StateEntry> entries;
    for (const model::StateInfo& state : problem.design.actuator.type->states) {
        const std::string_view unit = state.unit;
        entries.push_back({std::string(state.name), unit.empty() ? "" : si_unit(problem, std::string(unit))});
    }
    entries.resize(static_cast<std::size_t>(problem::problem_states(problem)));
    return entries;
}

Block settings_block(const ProblemFile& problem) {
    Block block{"Problem", "", {"key", "value", "origin", "remark"}, {}};
    for (const problem::ResolvedSetting& setting : problem.settings) {
        const bool absent = setting.text.empty();
        std::string remark = setting.trouble;
        if (!remark.empty() && absent && remark.starts_with(setting.name + " is missing")) {
            remark = remark.substr(setting.name.size() + 1);
        }
        block.rows.push_back({setting.name, absent ? missing : setting.text,
                              absent ? "" : std::string(problem::to_string(setting.origin)), remark});
    }
    return block;
}

}  // namespace percuss::results
