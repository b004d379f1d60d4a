#include "io/resolved_settings.hpp"

#include "io/problem_sections.hpp"
#include "model/number_text.hpp"
#include "model/units.hpp"

#include "study/branch_setup.hpp"
#include <algorithm>

#include <array>
#include <cmath>
#include <cstdio>
#include <numbers>

namespace percuss::io {

namespace {

using model::Key;

std::string_view single_stable_text(design::SingleStable level) {
    switch (level) {
        case design::SingleStable::off: return "off";
        case design::SingleStable::orbit: return "orbit";
        case design::SingleStable::sampled: return "sampled";
        case design::SingleStable::refuted: return "refuted";
    }
    return "unknown";
}

std::string variable_text(const design::DesignVariable& variable) {
    std::string text = std::string(model::key_info(variable.key).name) + " in " +
                       text_of(variable.key, variable.lower) + " .. " + text_of(variable.key, variable.upper);
    text += variable.logarithmic ? " log" : "";
    text += variable.integer ? " integer" : "";
    return text;
}

std::string exact_variable_text(const design::DesignVariable& variable) {
    return std::string(model::key_info(variable.key).name) + " in " + model::exact_text(variable.lower) + " .. " +
           model::exact_text(variable.upper) + (variable.logarithmic ? " log" : "") +
           (variable.integer ? " integer" : "");
}

std::string limit_text(const ProblemFile& problem, const design::Limit& limit) {
    return std::string(design::quantity_info(limit.quantity).name) + (limit.upper ? " <= " : " >= ") +
           text_of(problem, limit.quantity, limit.bound);
}

std::string state_text(const std::vector<double>& state) {
    std::string text;
    for (const double value : state) { text += (text.empty() ? "" : ", ") + model::exact_text(value); }
    return text;
}

class Resolver {
public:
    Resolver(const ProblemFile& problem, const SettingList& given) : problem_(problem), given_(given) {}

    std::vector<ResolvedSetting> run() {
        const design::Problem& design = problem_.study.design;
        text("actuator.type", std::string(design.actuator.type->type));
        model_keys();
        text("stop.law", std::string(model::to_string(design.actuator.law)));
        if (!model::has_frequency(design.actuator)) { number("drive.margin", design.margin, ""); }
        design_keys(design);
        number("uniqueness.starts", static_cast<double>(design.sampling.starts), "");
        number("uniqueness.cycles", design.sampling.cycles, "");
        if (design.sampling.margin) { number("uniqueness.margin", *design.sampling.margin, ""); }
        const study::OptimiserOptions& optimiser = problem_.study.optimiser;
        text("optimiser.method", optimiser.method);
        number("optimiser.starts", optimiser.starts, "");
        number("optimiser.samples", optimiser.samples, "");
        number("optimiser.max_evaluations", optimiser.max_evaluations, "");
        number("optimiser.tolerance", optimiser.tolerance, "");
        number("solver.tolerance", design.solver.tolerance, "");
        text("solver.integrator", design.solver.integrator);
        text("solver.instruction_set", design.solver.instruction_set);
        if (problem_.orbit.start) { text("orbit.start", state_text(*problem_.orbit.start)); }
        number("orbit.period", problem_.orbit.period, "");
        simulate_keys(problem_.simulate, *design.actuator.type);
        sweep_keys(problem_.sweep, *design.actuator.type);
        branch_keys();
        attractors_keys(problem_.attractors);
        return std::move(resolved_);
    }

private:
    void model_keys() {
        const model::Specification& spec = problem_.study.design.actuator;
        for (const Key key : spec.type->keys) {
            const model::KeyInfo& info = model::key_info(key);
            if (spec.has(key)) {
                number(std::string(info.name), spec.value(key), info.unit);
            } else if (model::is_frequency(key)) {  // of several ways to give it one is in use
                const bool at_edge = !model::has_frequency(spec) && key == model::frequency_key(spec);
                if (at_edge) { text(std::string(info.name), "edge"); }
            } else if (model::is_required(spec, key)) {
                text(std::string(info.name), "");
            }
        }
    }

    void design_keys(const design::Problem& design) {
        for (const design::DesignVariable& variable : design.variables) {
            text("design.variable", variable_text(variable));
        }
        for (const design::Objective& objective : design.objectives) {
            text(objective.maximise ? "design.maximise" : "design.minimise",
                 std::string(design::quantity_info(objective.quantity).name));
        }
        for (const design::Limit& limit : design.limits) { text("design.limit", limit_text(problem_, limit)); }
        text("design.single_stable", std::string(single_stable_text(design.single_stable)));
    }

    void simulate_keys(const study::SimulateStudy& study, const model::Actuator& family) {
        const bool given = study.from == study::SimulationStart::state;
        text("simulate.start", given                                         ? state_text(study.start)
                               : study.from == study::SimulationStart::orbit ? "orbit"
                                                                             : "rest");
        number("simulate.cycles", study.cycles, "");
        number("simulate.samples", study.samples, "");
        text("simulate.kick", study.kick ? kick_text(*study.kick, family) : "none");
    }

    void sweep_keys(const study::SweepStudy& study, const model::Actuator& family) {
        const bool plain = family.nondimensional;
        const double unit = plain ? 1.0 : 2.0 * std::numbers::pi;
        text("sweep.mode", study.mode == study::SweepMode::chirp ? "chirp" : "steps");
        if (study.from) { number("sweep.from", *study.from / unit, plain ? "" : "Hz"); }
        if (study.to) { number("sweep.to", *study.to / unit, plain ? "" : "Hz"); }
        number("sweep.steps", study.steps, "");
        number("sweep.tolerance", study.tolerance, "");
        number("sweep.max_cycles", study.max_cycles, "");
        number("sweep.longest_period", study.longest_period, "");
        number("sweep.chirp_cycles", study.chirp_cycles, "");
    }

    void branch_keys() {
        const study::BranchStudy& branch = problem_.branch;
        const Key along = branch.along.value_or(model::frequency_key(problem_.study.design.actuator));
        if (branch.along) { text("branch.along", std::string(model::key_info(along).name)); }
        if (branch.from) { number("branch.from", *branch.from, model::key_info(along).unit); }
        if (branch.to) { number("branch.to", *branch.to, model::key_info(along).unit); }
        number("branch.period", branch.period, "");
        number("branch.starts", branch.starts, "");
        number("branch.max_points", branch.max_points, "");
        const study::LocusStudy& locus = problem_.locus;
        text("locus.boundary", std::string(boundary::to_string(locus.kind)));
        if (locus.along) {
            text("locus.along", std::string(model::key_info(*locus.along).name));
            if (locus.from) { number("locus.from", *locus.from, model::key_info(*locus.along).unit); }
            if (locus.to) { number("locus.to", *locus.to, model::key_info(*locus.along).unit); }
        }
        number("locus.steps", locus.steps, "");
        number("locus.max_points", locus.max_points, "");
    }

    void attractors_keys(const study::AttractorsStudy& study) {
        number("attractors.starts", study.starts, "");
        number("attractors.cycles", study.cycles, "");
        if (study.lower) { text("attractors.lower", state_text(*study.lower)); }
        if (study.upper) { text("attractors.upper", state_text(*study.upper)); }
    }

    void number(const std::string& name, double value, std::string_view unit) {
        ResolvedSetting& setting = add(name);
        setting.value = value;
        setting.unit = unit == "1" ? "" : std::string(unit);
        setting.text = model::format_quantity(value, unit);
    }

    void text(const std::string& name, std::string words) { add(name).text = std::move(words); }

    ResolvedSetting& add(const std::string& name) {
        ResolvedSetting setting;
        setting.name = name;
        const Setting* given = given_.find(name);
        setting.origin = given == nullptr ? Origin::fallback : given->from_option ? Origin::option : Origin::file;
        setting.trouble = trouble_of(name);
        resolved_.push_back(std::move(setting));
        return resolved_.back();
    }

    /// Only keys that stand once: a trouble with one of several limits is not a trouble with the others.
    [[nodiscard]] std::string trouble_of(const std::string& name) const {
        if (name.starts_with("design.")) { return ""; }
        for (const std::string& trouble : problem_.troubles) {
            for (const std::string& beginning : {name + " ", name + ":", "--" + name + " ", "option --" + name + ":"}) {
                if (trouble.starts_with(beginning)) { return trouble; }
            }
        }
        return "";
    }

    const ProblemFile& problem_;
    const SettingList& given_;
    std::vector<ResolvedSetting> resolved_;
};

class Fnv1a {
public:
    void add(std::string_view text) {
        for (const char c : text) { hash_ = (hash_ ^ static_cast<unsigned char>(c)) * prime; }
    }
    [[nodiscard]] std::string text() const {
        std::array<char, 17> digits{};
        std::snprintf(digits.data(), digits.size(), "%016llx", static_cast<unsigned long long>(hash_));
        return digits.data();
    }

private:
    static constexpr std::uint64_t offset_basis = 14695981039346656037U;
    static constexpr std::uint64_t prime = 1099511628211U;
    std::uint64_t hash_ = offset_basis;
};

}  // namespace

std::vector<ResolvedSetting> resolve_settings(const ProblemFile& problem, const SettingList& given) {
    return Resolver(problem, given).run();
}

std::string problem_hash(const ProblemFile& problem) {
    const design::Problem& design = problem.study.design;
    Fnv1a hash;
    for (const ResolvedSetting& setting : problem.settings) {
        const bool is_rounded = setting.name == "design.variable" || setting.name == "design.limit";
        if (!is_rounded) {
            const bool is_number = !std::isnan(setting.value);
            hash.add(setting.name + "=" + (is_number ? model::exact_text(setting.value) : setting.text) + "\n");
        }
    }
    for (const design::DesignVariable& variable : design.variables) { hash.add(exact_variable_text(variable) + "\n"); }
    for (const design::Limit& limit : design.limits) {
        hash.add(std::string(design::quantity_info(limit.quantity).name) + (limit.upper ? "<=" : ">=") +
                 model::exact_text(limit.bound) + "\n");
    }
    return hash.text();
}

std::string_view units_of(const ProblemFile& problem) {
    const bool plain = problem.study.design.actuator.type->nondimensional;
    return plain ? "nondimensional" : "si";
}

std::string text_of(const ProblemFile& problem, design::Quantity quantity, double value) {
    return model::format_quantity(value, units_of(problem) == "si" ? design::quantity_info(quantity).unit : "1");
}

std::string text_of(Key key, double value) { return model::format_quantity(value, model::key_info(key).unit); }

}  // namespace percuss::io
