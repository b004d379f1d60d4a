#include "model/number_text.hpp"
#include "model/units.hpp"
#include "problem/nearest_name.hpp"
#include "problem/reading.hpp"
#include "problem/row_types.hpp"
#include "problem/sections.hpp"

#include <algorithm>
#include <cmath>

namespace percuss::problem {

namespace {

using design::Quantity;
using model::trimmed;

/// Removes `word` from the end of `text` if it stands there by itself.
bool take_last_word(std::string_view& text, std::string_view word) {
    if (!text.ends_with(word)) { return false; }
    const std::string_view before = text.substr(0, text.size() - word.size());
    if (before.empty() || (before.back() != ' ' && before.back() != '\t')) { return false; }
    text = trimmed(before);
    return true;
}

/// A bound of a variable in the base unit, which must be a value that the key itself may have: each design of the range
/// is evaluated. Throws std::invalid_argument.
double parse_bound(model::Key key, std::string_view text) {
    const model::KeyInfo& info = model::key_info(key);
    const double value = parse_key_value(key, text);
    const bool above = info.lowest_allowed ? value >= info.lowest : value > info.lowest;
    if (!(above && value <= info.highest)) {
        throw std::invalid_argument("'" + std::string(trimmed(text)) + "' is out of range: " + std::string(info.name) +
                                    " must be " + allowed_range(info));
    }
    return value;
}

/// Whether a number other than 0 stands without a unit.
bool lacks_unit(std::string_view text) {
    const auto value = model::whole_number_text(text);
    return value && *value != 0.0;
}

/// "0.2 .. 1.6 mm" would be 0.2 m .. 1.6 mm: a unit on one side alone is refused.
void refuse_half_a_unit(const model::KeyInfo& info, std::string_view lower, std::string_view upper) {
    const bool has_dimension = info.unit != "1" && !info.unit.empty();
    if (!has_dimension || lacks_unit(lower) == lacks_unit(upper)) { return; }
    const std::string_view bare = lacks_unit(lower) ? lower : upper;
    const std::string_view other = lacks_unit(lower) ? upper : lower;
    std::string_view rest;
    if (!model::leading_number(trimmed(other), rest) || trimmed(rest).empty()) { return; }
    const std::string unit = " " + std::string(trimmed(rest));
    const auto with_unit = [&](std::string_view side) {
        return std::string(trimmed(side)) + (side.data() == bare.data() ? unit : "");
    };
    throw std::invalid_argument("'" + std::string(trimmed(bare)) + "' has no unit, so it would be in " +
                                std::string(info.unit) + ": write " + with_unit(lower) + " .. " + with_unit(upper));
}

/// "KEY in LOWER .. UPPER [log] [integer]" with bounds in base units. Throws ProblemError.
design::DesignVariable parse_variable(const Setting& setting, const model::Actuator& family) {
    constexpr std::string_view form = "expected KEY in LOWER .. UPPER [log] [integer]";
    const std::string_view text = trimmed(setting.value);
    const auto in = text.find(" in ");
    const auto dots = in == std::string_view::npos ? in : text.find("..", in);
    if (dots == std::string_view::npos) { throw bad_value(setting, std::string(form)); }
    std::string_view upper = trimmed(text.substr(dots + 2));
    design::DesignVariable variable;
    // Either order, each word at most once: a second one stays in the text and is refused with it.
    while (true) {
        if (!variable.logarithmic && take_last_word(upper, "log")) {
            variable.logarithmic = true;
        } else if (!variable.integer && take_last_word(upper, "integer")) {
            variable.integer = true;
        } else {
            break;
        }
    }
    try {
        variable.key = parse_key(trimmed(text.substr(0, in)), family);
        const std::string_view lower = text.substr(in + 4, dots - in - 4);
        refuse_half_a_unit(model::key_info(variable.key), lower, upper);
        variable.lower = parse_bound(variable.key, lower);
        variable.upper = parse_bound(variable.key, upper);
    } catch (const std::invalid_argument& error) {
        throw bad_value(setting, error.what());
    } catch (const ProblemError& error) { throw bad_value(setting, error.what()); }
    // An integer range may hold one number; a real one would leave the optimiser a variable without room.
    const bool single_value = variable.integer && variable.lower == variable.upper;
    if (!(variable.lower < variable.upper || single_value)) {
        throw bad_value(setting, "the range is reversed or empty: LOWER must be below UPPER");
    }
    if (variable.logarithmic && !(variable.lower > 0.0)) {
        throw bad_value(setting, "a log range needs LOWER above 0");
    }
    if (variable.integer &&
        (std::floor(variable.lower) != variable.lower || std::floor(variable.upper) != variable.upper)) {
        throw bad_value(setting, "an integer range needs whole numbers as bounds");
    }
    return variable;
}

void add_variable(const Setting& setting, design::Problem& problem) {
    const auto variable = parse_variable(setting, *problem.actuator.type);
    const auto same = [&](const design::DesignVariable& other) { return other.key == variable.key; };
    if (std::any_of(problem.variables.begin(), problem.variables.end(), same)) {
        throw bad_value(setting, "this key is a variable already");
    }
    // It would have no effect: gradients of zero, and an optimum that means nothing.
    if (model::is_of_stop(variable.key) && !model::has_stop(problem.actuator.law)) {
        throw bad_value(setting, "stop.law = none: there is no stop to vary");
    }
    problem.variables.push_back(variable);
}

/// A quantity that this actuator has. Throws ProblemError with the nearest name or why there is none.
Quantity parse_quantity_name(const Setting& setting, std::string_view name, const model::Actuator& family) {
    std::vector<std::string> names;
    for (const Quantity quantity : design::reported_quantities(family)) {
        names.emplace_back(design::quantity_info(quantity).name);
    }
    const auto quantity = design::find_quantity(name);
    if (!quantity) {
        throw bad_value(setting, "'" + std::string(name) + "' is not a quantity; the nearest one is " +
                                     nearest_name(name, names));
    }
    const std::string_view why_not = design::unavailable(*quantity, family);
    if (!why_not.empty()) { throw bad_value(setting, std::string(name) + " " + std::string(why_not)); }
    return *quantity;
}

/// Throws ProblemError for a quantity without gradient or one that is an objective already.
void add_objective(const Setting& setting, bool maximise, design::Problem& problem) {
    const auto quantity = parse_quantity_name(setting, trimmed(setting.value), *problem.actuator.type);
    if (!design::quantity_info(quantity).smooth) {
        throw bad_value(setting, "is a whole number and has no gradient: it cannot be an objective");
    }
    const auto same = [&](const design::Objective& other) { return other.quantity == quantity; };
    if (std::any_of(problem.objectives.begin(), problem.objectives.end(), same)) {
        throw bad_value(setting, "this quantity is an objective already");
    }
    problem.objectives.push_back({quantity, maximise});
}

/// "QUANTITY <= VALUE" or ">=", the bound in the unit of the quantity. Throws ProblemError.
design::Limit parse_limit(const Setting& setting, const model::Actuator& family) {
    const std::string_view text = trimmed(setting.value);
    const auto at_most = text.find("<=");
    const auto at_least = text.find(">=");
    // npos is larger than any place, so this is the one that is there, or the first of both.
    const auto position = std::min(at_most, at_least);
    if (position == std::string_view::npos) {
        throw bad_value(setting, "expected QUANTITY <= VALUE or QUANTITY >= VALUE");
    }
    design::Limit limit;
    limit.quantity = parse_quantity_name(setting, trimmed(text.substr(0, position)), family);
    limit.upper = position == at_most;
    limit.text = text;
    const std::string_view bound = text.substr(position + 2);
    try {
        limit.bound = family.nondimensional ? model::parse_plain_number(bound)
                                            : model::parse_quantity(bound, design::quantity_info(limit.quantity).unit);
    } catch (const std::invalid_argument& error) { throw bad_value(setting, error.what()); }
    return limit;
}

std::string variable_text(const design::DesignVariable& variable, std::string (*text)(model::Key, double)) {
    return std::string(model::key_info(variable.key).name) + " in " + text(variable.key, variable.lower) + " .. " +
           text(variable.key, variable.upper) + (variable.logarithmic ? " log" : "") +
           (variable.integer ? " integer" : "");
}

std::string exact_key_text(model::Key /*key*/, double value) { return model::exact_text(value); }

std::string limit_text(const design::Limit& limit, const std::string& sign, const std::string& bound) {
    return std::string(design::quantity_info(limit.quantity).name) + sign + bound;
}

/// The beginning of an entry up to any of the marks.
std::string before(std::string_view value, std::initializer_list<std::string_view> marks) {
    std::size_t end = value.size();
    for (const std::string_view mark : marks) { end = std::min(end, value.find(mark)); }
    return std::string(trimmed(value.substr(0, end)));
}

std::string variable_subject(std::string_view value) { return "variable " + before(value, {" in "}); }
std::string objective_subject(std::string_view value) { return "objective " + before(value, {}); }
/// A quantity may be bounded on both sides.
std::string limit_subject(std::string_view value) {
    return "limit " + before(value, {"<=", ">="}) + (value.find(">=") < value.find("<=") ? " >=" : " <=");
}

/// A row of a list; "none" adds nothing.
template <class Add, class Get>
Row list(std::string name, std::string allowed, std::string meaning, std::string (*subject)(std::string_view), Add add,
         Get get) {
    Row row = setting<design::Problem>(
        std::move(name), "", std::move(allowed), "none", std::move(meaning),
        [add](design::Problem& problem, const Setting& s, const Context&) {
            if (!clears_list(s)) { add(s, problem); }
        },
        [get](const design::Problem& problem, const Context&) { return get(problem); });
    row.subject = subject;
    return row;
}

Row objective_row(std::string name, bool maximise, std::string meaning) {
    return list(
        std::move(name), "a quantity", std::move(meaning), objective_subject,
        [=](const Setting& s, design::Problem& problem) { add_objective(s, maximise, problem); },
        [=](const design::Problem& problem) {
            std::vector<Echo> out;
            for (const design::Objective& objective : problem.objectives) {
                const std::string name_of(design::quantity_info(objective.quantity).name);
                if (objective.maximise == maximise) { out.push_back({name_of}); }
            }
            return out;
        });
}

std::vector<Echo> variables_echo(const design::Problem& problem) {
    std::vector<Echo> out;
    for (const design::DesignVariable& variable : problem.variables) {
        Echo echo{variable_text(variable, text_of)};
        echo.exact = variable_text(variable, exact_key_text);
        out.push_back(std::move(echo));
    }
    return out;
}

/// Bounds in print are rounded; `exact` is what the hash is made of.
std::vector<Echo> limits_echo(const design::Problem& problem) {
    const bool plain = problem.actuator.type->nondimensional;
    std::vector<Echo> out;
    for (const design::Limit& limit : problem.limits) {
        const std::string_view unit = plain ? "1" : design::quantity_info(limit.quantity).unit;
        Echo echo{limit_text(limit, limit.upper ? " <= " : " >= ", model::format_quantity(limit.bound, unit))};
        echo.exact = limit_text(limit, limit.upper ? "<=" : ">=", model::exact_text(limit.bound));
        out.push_back(std::move(echo));
    }
    return out;
}

const Words<design::SingleStable>& levels() {
    using design::SingleStable;
    static const Words<SingleStable> words = {{"off", SingleStable::off},
                                              {"orbit", SingleStable::orbit},
                                              {"sampled", SingleStable::sampled},
                                              {"refuted", SingleStable::refuted}};
    return words;
}

Section of_problem(std::vector<Row> rows, bool in_file_order) {
    Section section = section_of<design::Problem>(std::move(rows));
    section.of_problem = true;
    section.in_file_order = in_file_order;
    return section;
}

}  // namespace

Section design_section() {
    return of_problem(
        {list(
             "design.variable", "KEY in LOWER .. UPPER [log] [integer]", "a key that may be varied", variable_subject,
             [](const Setting& s, design::Problem& problem) { add_variable(s, problem); }, variables_echo),
         objective_row("design.maximise", true, "what to make large"),
         objective_row("design.minimise", false, "what to make small"),
         list(
             "design.limit", "QUANTITY <= VALUE or QUANTITY >= VALUE", "what a design must respect", limit_subject,
             [](const Setting& s, design::Problem& problem) {
                 problem.limits.push_back(parse_limit(s, *problem.actuator.type));
             },
             limits_echo),
         choice<design::Problem, design::SingleStable>(
             "design.single_stable", &design::Problem::single_stable, levels(),
             "how it is checked that the motion is the only stable one: among the period-1 motions; by starts all "
             "over a box; and with what refutes a design avoided by the optimiser")},
        true);
}

Section uniqueness_section() {
    return of_problem(
        {count<design::Problem>(
             "uniqueness.starts", [](auto& problem) -> auto& { return problem.sampling.starts; }, Whole{1, 100'000'000},
             "starts of the sampled check of uniqueness (single_stable = sampled or refuted)"),
         count<design::Problem>(
             "uniqueness.cycles", [](auto& problem) -> auto& { return problem.sampling.cycles; }, Whole{1, 10'000'000},
             "drive cycles that each of them may take to settle"),
         setting<design::Problem>(
             "uniqueness.margin", "", margin_range, "drive.margin",
             "distance kept from the frequencies at which a motion that refuted a design exists",
             [](design::Problem& problem, const Setting& s, const Context&) {
                 problem.sampling.margin = parse_margin(s);
             },
             [](const design::Problem& problem, const Context&) {
                 const auto& margin = problem.sampling.margin;
                 return margin ? std::vector<Echo>{number_echo(*margin, "")} : std::vector<Echo>{};
             })},
        false);
}

Section solver_section() {
    return of_problem(
        {number<design::Problem>(
             "solver.tolerance", [](auto& problem) -> auto& { return problem.solver.tolerance; }, Between{1e-16, 1e-2},
             "relative tolerance of an integration step"),
         word<design::Problem>(
             "solver.integrator", [](auto& problem) -> auto& { return problem.solver.integrator; },
             {"auto", "taylor", "erk", "cvode"}, "integrator; auto: Taylor, or CVODE where the design is stiff"),
         word<design::Problem>(
             "solver.instruction_set", [](auto& problem) -> auto& { return problem.solver.instruction_set; },
             {"auto", "v2", "v3", "v4", "generic"}, "x86-64 level of the kernels")},
        false);
}

}  // namespace percuss::problem
