#include "io/problem_sections.hpp"

#include "io/setting_values.hpp"
#include "model/units.hpp"
#include "optimise/solve.hpp"

#include <array>

namespace percuss::io {

namespace {

constexpr int longest_period = 64;  // drive cycles
constexpr double finest_solver_tolerance = 1e-16;
constexpr double coarsest_solver_tolerance = 1e-2;

}  // namespace

std::size_t states_of(const model::Actuator& family) { return family.states.size(); }

void read_sampling(const SettingList& settings, design::Sampling& sampling, Troubles& troubles) {
    with(settings, "uniqueness.starts", troubles,
         [&](const Setting& s) { sampling.starts = parse_count(s, 1, 100'000'000); });
    with(settings, "uniqueness.cycles", troubles,
         [&](const Setting& s) { sampling.cycles = parse_count(s, 1, 10'000'000); });
    with(settings, "uniqueness.margin", troubles, [&](const Setting& s) {
        double margin = -1.0;
        try {
            margin = model::parse_quantity(s.value, "1");
        } catch (const std::invalid_argument& error) { throw bad_value(s, error.what()); }
        if (!(margin >= 0.0 && margin < 0.5)) { throw bad_value(s, "must be at least 0 and below 0.5 (50 %)"); }
        sampling.margin = margin;
    });
}

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

void read_orbit(const SettingList& settings, const model::Actuator& family, study::OrbitStudy& orbit,
                Troubles& troubles) {
    with(settings, "orbit.start", troubles, [&](const Setting& s) { orbit.start = parse_state(s, states_of(family)); });
    with(settings, "orbit.period", troubles,
         [&](const Setting& s) { orbit.period = parse_count(s, 1, longest_period); });
}

}  // namespace percuss::io
