#include "verbs/verbs.hpp"

#include "model/registry.hpp"
#include "problem/nearest_name.hpp"
#include "problem/problem_error.hpp"
#include "verbs/attractors/verb.hpp"
#include "verbs/branch/verb.hpp"
#include "verbs/check/verb.hpp"
#include "verbs/evaluate/verb.hpp"
#include "verbs/explore/verb.hpp"
#include "verbs/locus/verb.hpp"
#include "verbs/merge/verb.hpp"
#include "verbs/optimise/verb.hpp"
#include "verbs/orbit/verb.hpp"
#include "verbs/simulate/verb.hpp"
#include "verbs/sweep/verb.hpp"

#include <algorithm>

namespace percuss::verbs {

namespace {

/// A verb that is only named: known by help, refused when called.
Verb later(std::string_view name, std::string_view summary) {
    Verb verb;
    verb.name = name;
    verb.summary = summary;
    return verb;
}

const std::vector<Verb>& table() {
    static const std::vector<Verb> verbs = {
        check_verb(),
        simulate_verb(),
        later("force-displacement", "quasi-static curve of one membrane"),
        sweep_verb(),
        orbit_verb(),
        branch_verb(),
        locus_verb(),
        attractors_verb(),
        evaluate_verb(),
        explore_verb(),
        merge_verb(),
        optimise_verb(),
        later("pareto", "the front of two or three objectives"),
        later("benchmark", "compare optimisers over problems and seeds"),
        later("report", "one self-contained page from a results folder"),
    };
    return verbs;
}

}  // namespace

std::span<const Verb> verbs() { return table(); }

const Verb& find_verb(std::string_view word) {
    const std::string name(word == "optimize" ? "optimise" : word);
    std::vector<std::string> names;
    for (const Verb& verb : table()) {
        if (verb.name == name && verb.run != nullptr) { return verb; }
        if (verb.name == name) {
            throw problem::ProblemError("the verb " + name + " is not available in this version");
        }
        names.emplace_back(verb.name);
    }
    throw problem::ProblemError("unknown verb '" + std::string(word) + "'; the nearest one is " +
                                problem::nearest_name(name, names));
}

std::span<const problem::Section> sections() {
    static const std::vector<problem::Section> all = {
        problem::actuator_section(),
        problem::design_section(),
        problem::uniqueness_section(),
        optimiser_section(),
        problem::solver_section(),
        orbit_section(),
        simulate_section(),
        sweep_section(),
        branch_section(),
        locus_section(),
        attractors_section(),
        explore_section(),
    };
    return all;
}

VerbOption gradients_option() {
    VerbOption option{"gradients", "", "also the derivatives of what was found", ""};
    option.apply = [](const problem::Setting&, RunSettings& settings) { settings.gradients = true; };
    return option;
}

bool reads(const Verb& verb, const problem::Row& row) {
    constexpr std::array<std::string_view, 4> common = {"actuator", "stop", "drive", "solver"};
    const auto in = [&](const auto& names) { return std::find(names.begin(), names.end(), row.section()); };
    const auto actuators = model::actuators();
    const bool of_actuators = std::any_of(actuators.begin(), actuators.end(), [&](const model::Actuator* actuator) {
        return std::any_of(actuator->sections.begin(), actuator->sections.end(), [&](std::string_view section) {
            return section.substr(0, section.find('.')) == row.section();
        });
    });
    return verb.inspects || of_actuators || in(common) != common.end() || in(verb.sections) != verb.sections.end();
}

StudyProblem study_problem(const problem::ProblemFile& problem) {
    StudyProblem study;
    study.design = problem.design;
    study.optimiser = problem.get<OptimiserOptions>();
    study.seed = problem.design.sampling.seed;
    study.jobs = problem.design.sampling.jobs;
    return study;
}

problem::ProblemFile read_problem(const std::filesystem::path& file, std::span<const problem::Setting> options,
                                  problem::FrequencyUse use) {
    return problem::read_problem(file, options, sections(), use);
}

problem::ProblemFile parse_problem(const std::string& name, const std::string& text) {
    return problem::parse_problem(name, text, sections());
}

problem::ProblemFile inspect_problem(const std::filesystem::path& file, std::span<const problem::Setting> options) {
    return problem::inspect_problem(file, options, sections());
}

}  // namespace percuss::verbs
