#include "problem/problem_file.hpp"

#include "problem/reading.hpp"
#include "problem/resolved_settings.hpp"
#include "problem/values.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <utility>

namespace percuss::problem {

namespace {

/// A variable without a value of its own starts in the middle of its range.
void fill_in_variables(design::Problem& problem) {
    for (const design::DesignVariable& variable : problem.variables) {
        if (problem.actuator.has(variable.key)) { continue; }
        double middle =
            variable.logarithmic ? std::sqrt(variable.lower * variable.upper) : 0.5 * (variable.lower + variable.upper);
        // Of an integer range the middle may lie between two whole numbers.
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

/// What can be said of the values without computing, apart from what reading complained of already.
void check_values(const design::Problem& problem, FrequencyUse use, Troubles& troubles) {
    for (const std::string& violation : model::violations(problem.actuator)) {
        if (!is_known_trouble(troubles, violation)) { troubles.add(violation); }
    }
    // Verbs that give the frequency themselves need no edge.
    if (use == FrequencyUse::operates && !model::has_stop(problem.actuator.law) &&
        !model::has_frequency(problem.actuator) && !is_known_trouble(troubles, "drive.frequency ")) {
        troubles.add("drive.frequency = edge: stop.law = none leaves no edge to operate at, give a frequency");
    }
}

/// Gives every row of a section its settings.
void read_section(const Section& section, void* options, const SettingList& settings, const Context& context,
                  Troubles& troubles) {
    const auto read = [&](const Row& row, const Setting& setting) {
        if (row.name == setting.key) {
            troubles.attempt([&] { row.set(options, setting, context); });
        }
    };
    // What is listed stays in the order in which it was written, whatever key it is under. Elsewhere the rows have
    // their own order, since one may depend on those above it.
    if (section.in_file_order) {
        for (const Setting& setting : settings.all()) {
            for (const Row& row : section.rows) { read(row, setting); }
        }
        return;
    }
    for (const Row& row : section.rows) {
        for (const Setting& setting : settings.all()) { read(row, setting); }
    }
}

ProblemFile assemble(std::string name, std::vector<Setting> given, std::span<const Section> sections, FrequencyUse use,
                     bool keep_going) {
    const SettingList settings(std::move(given));
    Troubles troubles(keep_going);
    ProblemFile problem;
    problem.name = std::move(name);

    design::Problem& design = problem.design;
    // First of all: which keys there are, and how values are read, follows from the type.
    design.actuator.type = &family_of(settings);
    const Context context{design.actuator};
    for (const Section& section : sections) {
        if (!section.of_problem) { problem.options.emplace(section.options, section.make()); }
        void* target = section.of_problem ? static_cast<void*>(&design) : problem.options.at(section.options).get();
        read_section(section, target, settings, context, troubles);
    }
    model::apply_defaults(design.actuator);
    fill_in_variables(design);
    check_values(design, use, troubles);

    problem.troubles = troubles.list();
    problem.settings = resolve_settings(problem, sections, settings);
    return problem;
}

}  // namespace

const void* ProblemFile::find(std::type_index type) const {
    const auto found = options.find(type);
    if (found == options.end()) { throw std::logic_error("problem: these options were not read with the problem"); }
    return found->second.get();
}

const void* options_of(const ProblemFile& problem, const Section& section) {
    return section.of_problem ? static_cast<const void*>(&problem.design) : problem.find(section.options);
}

ProblemFile read_problem(const std::filesystem::path& file, std::span<const Setting> options,
                         std::span<const Section> sections, FrequencyUse use) {
    return assemble(file.stem().string(), merge_settings(read_settings(file, sections), options, sections), sections,
                    use, false);
}

ProblemFile parse_problem(const std::string& name, const std::string& text, std::span<const Section> sections,
                          FrequencyUse use) {
    return assemble(name, parse_settings(text, name, sections), sections, use, false);
}

ProblemFile inspect_problem(const std::filesystem::path& file, std::span<const Setting> options,
                            std::span<const Section> sections) {
    return assemble(file.stem().string(), merge_settings(read_settings(file, sections), options, sections), sections,
                    FrequencyUse::operates, true);
}

int problem_states(const ProblemFile& problem) { return static_cast<int>(states_of(*problem.design.actuator.type)); }

}  // namespace percuss::problem
