#include "io/problem_file.hpp"

#include "design/families.hpp"
#include "io/problem_error.hpp"
#include "io/problem_sections.hpp"
#include "io/resolved_settings.hpp"
#include "io/setting_list.hpp"

#include <algorithm>
#include <cmath>

namespace percuss::io {

namespace {

/// A variable without a value of its own starts in the middle of its range.
void fill_in_variables(design::Problem& problem) {
    for (const design::DesignVariable& variable : problem.variables) {
        if (problem.actuator.has(variable.key)) { continue; }
        double middle =
            variable.logarithmic ? std::sqrt(variable.lower * variable.upper) : 0.5 * (variable.lower + variable.upper);
        if (variable.integer) { middle = std::floor(middle); }
        problem.actuator.set(variable.key, middle);
    }
}

/// Whether some trouble met so far is about this key, so that it need not be called missing as well.
bool is_known_trouble(const Troubles& troubles, const std::string& violation) {
    const std::string key = violation.substr(0, violation.find(' '));
    return std::any_of(troubles.list().begin(), troubles.list().end(), [&](const std::string& trouble) {
        return trouble.starts_with(key + " ") || trouble.starts_with(key + ":") ||
               trouble.starts_with("--" + key + " ") || trouble.starts_with("option --" + key + ":");
    });
}

void check_values(const design::Problem& problem, FrequencyUse use, Troubles& troubles) {
    for (const std::string& violation : model::violations(problem.actuator)) {
        if (!is_known_trouble(troubles, violation)) { troubles.add(violation); }
    }
    if (use == FrequencyUse::operates && !model::has_stop(problem.actuator.law) &&
        !model::has_frequency(problem.actuator) && !is_known_trouble(troubles, "drive.frequency ")) {
        troubles.add("drive.frequency = edge: stop.law = none leaves no edge to operate at, give a frequency");
    }
}

ProblemFile assemble(const std::filesystem::path& file, std::span<const Setting> options, FrequencyUse use,
                     bool keep_going) {
    const SettingList settings(merge_settings(read_settings(file), options));
    Troubles troubles(keep_going);
    ProblemFile problem;
    problem.name = file.stem().string();

    design::Problem& design = problem.study.design;
    design.actuator.type = &family_of(settings);
    read_actuator(settings, design, troubles);
    read_design(settings, design, troubles);
    read_sampling(settings, design.sampling, troubles);
    read_optimiser(settings, problem.study.optimiser, troubles);
    read_solver(settings, design.solver, troubles);
    read_orbit(settings, *design.actuator.type, problem.orbit, troubles);
    read_simulate(settings, *design.actuator.type, problem.simulate, troubles);
    read_sweep(settings, *design.actuator.type, problem.sweep, troubles);
    read_branch(settings, design.actuator, problem.branch, troubles);
    read_locus(settings, design.actuator, problem.locus, troubles);
    read_attractors(settings, *design.actuator.type, problem.attractors, troubles);
    model::apply_defaults(design.actuator);
    fill_in_variables(design);
    check_values(design, use, troubles);

    problem.troubles = troubles.list();
    problem.settings = resolve_settings(problem, settings);
    return problem;
}

}  // namespace

ProblemFile read_problem(const std::filesystem::path& file, std::span<const Setting> options, FrequencyUse use) {
    return assemble(file, options, use, false);
}

ProblemFile inspect_problem(const std::filesystem::path& file, std::span<const Setting> options) {
    return assemble(file, options, FrequencyUse::operates, true);
}

void require_frequency(const ProblemFile& problem) {
    if (!model::has_frequency(problem.study.design.actuator)) {
        const model::Key key = model::frequency_key(problem.study.design.actuator);
        throw ProblemError(std::string(model::key_info(key).name) +
                           " = edge: an orbit is computed at a given frequency, give one");
    }
}

void require_branch_range(const ProblemFile& problem) {
    const study::BranchStudy& branch = problem.branch;
    if (!branch.along || design::is_drive_frequency(*branch.along) || (branch.from && branch.to)) { return; }
    throw ProblemError(std::string(branch.from ? "branch.to" : "branch.from") +
                       " is missing: give both ends of the range of " +
                       std::string(model::key_info(*branch.along).name));
}

void require_locus_range(const ProblemFile& problem) {
    const study::LocusStudy& locus = problem.locus;
    if (!locus.along) {
        throw ProblemError("locus.along is missing: give the key to vary besides the drive frequency, as in --along "
                           "stop.gap");
    }
    if (!locus.from || !locus.to) {
        throw ProblemError(std::string(locus.from ? "locus.to" : "locus.from") +
                           " is missing: give both ends of the "
                           "range of " +
                           std::string(model::key_info(*locus.along).name));
    }
}

int problem_states(const ProblemFile& problem) {
    return static_cast<int>(problem.study.design.actuator.type->states.size());
}

void require_one_objective(const ProblemFile& problem) {
    const design::Problem& design = problem.study.design;
    if (design.variables.empty()) {
        throw ProblemError("design.variable is missing: optimise needs at least one, as in "
                           "'stop.gap in 0.2 mm .. 1.6 mm'");
    }
    if (design.objectives.empty()) {
        throw ProblemError("design.maximise is missing: optimise needs one quantity to maximise or minimise");
    }
    if (design.objectives.size() > 1) {
        throw ProblemError("design.maximise and design.minimise name " + std::to_string(design.objectives.size()) +
                           " objectives: optimise takes exactly one");
    }
}

}  // namespace percuss::io
