#include "io/problem_sections.hpp"

#include "io/nearest_name.hpp"
#include "io/setting_table.hpp"
#include "model/number_text.hpp"
#include "optimise/solve.hpp"

#include <algorithm>
#include <array>
#include <charconv>

namespace percuss::io {

namespace {

using model::trimmed;

constexpr int most = 1'000'000'000;
constexpr int longest_period = 64;  // drive cycles
constexpr double finest_solver_tolerance = 1e-16;
constexpr double coarsest_solver_tolerance = 1e-2;

int parse_count(const Setting& setting, int lowest, int highest = most) {
    const std::string_view text = trimmed(setting.value);
    int value = 0;
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
    if (error != std::errc() || end != text.data() + text.size() || value < lowest || value > highest) {
        throw bad_value(setting, "must be a whole number, at least " + std::to_string(lowest) +
                                     (highest == most ? "" : ", at most " + std::to_string(highest)));
    }
    return value;
}

/// A number strictly between two bounds.
double parse_between(const Setting& setting, double above, double below) {
    const auto value = model::whole_number_text(setting.value);
    if (!(value && *value > above && *value < below)) {
        throw bad_value(setting, "must be a number above " + model::number_text(above) + " and below " +
                                     model::number_text(below));
    }
    return *value;
}

std::string parse_choice(const Setting& setting, std::span<const std::string> choices) {
    std::string text(trimmed(setting.value));
    if (std::find(choices.begin(), choices.end(), text) == choices.end()) {
        throw bad_value(setting, "the nearest one known is " + nearest_name(text, choices) + ", all are " +
                                     alternatives(choices));
    }
    return text;
}

/// Lets `read` interpret the setting of a key, if it is given.
template <class Read>
void with(const SettingList& settings, std::string_view key, Troubles& troubles, Read read) {
    if (const Setting* setting = settings.find(key)) {
        troubles.attempt([&] { read(*setting); });
    }
}

std::vector<double> parse_state(const Setting& setting, std::size_t size) {
    std::vector<double> state;
    std::string text = setting.value;
    std::replace(text.begin(), text.end(), ',', ' ');
    std::string_view rest = trimmed(text);
    while (!rest.empty()) {
        const std::string_view word = rest.substr(0, rest.find_first_of(" \t"));
        const auto value = model::whole_number_text(word);
        if (!value) { throw bad_value(setting, "'" + std::string(word) + "' is not a finite number"); }
        state.push_back(*value);
        rest = trimmed(rest.substr(word.size()));
    }
    if (state.size() != size) {
        throw bad_value(setting,
                        "a state has " + std::to_string(size) + " numbers here, not " + std::to_string(state.size()));
    }
    return state;
}

}  // namespace

void read_optimiser(const SettingList& settings, study::OptimiserOptions& options, Troubles& troubles) {
    with(settings, "optimiser.method", troubles,
         [&](const Setting& s) { options.method = parse_choice(s, optimise::methods()); });
    with(settings, "optimiser.starts", troubles, [&](const Setting& s) { options.starts = parse_count(s, 1); });
    with(settings, "optimiser.samples", troubles, [&](const Setting& s) { options.samples = parse_count(s, 0); });
    with(settings, "optimiser.max_evaluations", troubles,
         [&](const Setting& s) { options.max_evaluations = parse_count(s, 1); });
    with(settings, "optimiser.tolerance", troubles,
         [&](const Setting& s) { options.tolerance = parse_between(s, 0.0, 1.0); });
}

void read_solver(const SettingList& settings, design::SolverOptions& options, Troubles& troubles) {
    const std::array<std::string, 3> integrators = {"taylor", "erk", "cvode"};
    const std::array<std::string, 5> instruction_sets = {"auto", "v2", "v3", "v4", "generic"};
    with(settings, "solver.tolerance", troubles, [&](const Setting& s) {
        options.tolerance = parse_between(s, finest_solver_tolerance, coarsest_solver_tolerance);
    });
    with(settings, "solver.integrator", troubles,
         [&](const Setting& s) { options.integrator = parse_choice(s, integrators); });
    with(settings, "solver.instruction_set", troubles,
         [&](const Setting& s) { options.instruction_set = parse_choice(s, instruction_sets); });
}

void read_orbit(const SettingList& settings, model::Family family, study::OrbitStudy& orbit, Troubles& troubles) {
    const bool is_spring = model::actuator_kind(family) == model::ActuatorKind::spring_mass;
    const auto size = static_cast<std::size_t>(is_spring ? model::spring::states : model::membrane::states);
    with(settings, "orbit.start", troubles, [&](const Setting& s) { orbit.start = parse_state(s, size); });
    with(settings, "orbit.period", troubles,
         [&](const Setting& s) { orbit.period = parse_count(s, 1, longest_period); });
}

}  // namespace percuss::io
