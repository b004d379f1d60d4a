#include "io/setting_table.hpp"

#include "design/problem.hpp"
#include "model/number_text.hpp"
#include "optimise/solve.hpp"
#include "study/attractors.hpp"
#include "study/branch.hpp"
#include "study/locus.hpp"
#include "study/orbit.hpp"
#include "study/simulate.hpp"
#include "study/study.hpp"
#include "study/sweep.hpp"

#include <algorithm>

namespace percuss::io {

namespace {

SettingInfo from_model(model::Key key) {
    const model::KeyInfo& info = model::key_info(key);
    const bool is_frequency = model::is_frequency(key);
    SettingInfo setting;
    setting.name = info.name;
    setting.unit = info.unit == "1" ? "" : std::string(info.unit);
    setting.allowed = allowed_range(info) + (is_frequency ? ", or edge" : "");
    setting.fallback = info.fallback ? model::number_text(*info.fallback) : (is_frequency ? "edge" : "");
    setting.meaning = info.meaning;
    return setting;
}

void add_model_keys(std::vector<SettingInfo>& table, std::string_view section) {
    for (const model::Key key : model::all_keys()) {
        if (model::key_info(key).name.starts_with(section)) { table.push_back(from_model(key)); }
    }
}

void add_simulate_keys(std::vector<SettingInfo>& table) {
    const study::SimulateStudy study;
    table.push_back({"simulate.start", "", "rest, orbit, or numbers separated by commas or blanks", "rest",
                     "state at theta = 0; orbit: the orbit that verb orbit finds (orbit.start, orbit.period)"});
    table.push_back({"simulate.cycles", "", "whole number, at least 1", std::to_string(study.cycles),
                     "length of the series in drive cycles"});
    table.push_back({"simulate.samples", "", "whole number, at least 1", std::to_string(study.samples),
                     "rows of the series per drive cycle"});
    table.push_back(
        {"simulate.kick", "", "velocity ... | voltage ... | force ... | none", "none",
         "a disturbance: 'velocity 0.05 m/s at cycle 50': x' jumps by so much; 'voltage 50 % for 2 cycles at "
         "cycle 50' (spring-mass: force): the drive is that share of itself; cycles may be fractions"});
}

void add_sweep_keys(std::vector<SettingInfo>& table) {
    const study::SweepStudy study;
    const std::string frequency = "above 0";
    const std::string kind = ", or omega of a nondimensional problem; spring-mass problems take rad/s as well";
    table.push_back({"sweep.from", "Hz", frequency, "0.6 linear resonance", "lowest drive frequency" + kind});
    table.push_back({"sweep.to", "Hz", frequency, "2 linear resonance", "highest drive frequency" + kind});
    table.push_back({"sweep.mode", "", "steps | chirp", "steps",
                     "steps: settle at every frequency, on from the state of the one before; chirp: never settle, the "
                     "frequency moves on with every drive cycle at a constant rate in time"});
    table.push_back({"sweep.steps", "", "whole number, at least 1", std::to_string(study.steps),
                     "frequency steps in each direction"});
    table.push_back({"sweep.tolerance", "", "above 1e-12, below 0.01", model::number_text(study.tolerance),
                     "a motion has settled when its strobed change and what is left to the orbit (one Newton step; "
                     "change rho/(1 - rho) for a multiplier rho) are below this, relative to 1 + |state|"});
    table.push_back({"sweep.max_cycles", "", "whole number, at least 1", std::to_string(study.max_cycles),
                     "drive cycles to wait for that at each frequency"});
    table.push_back({"sweep.longest_period", "", "whole number, at least 1, at most 12",
                     std::to_string(study.longest_period), "repeats after up to so many drive cycles are recognised"});
    table.push_back({"sweep.chirp_cycles", "", "whole number, at least 1", std::to_string(study.chirp_cycles),
                     "drive cycles of a chirp in each direction"});
}

void add_branch_keys(std::vector<SettingInfo>& table) {
    const study::BranchStudy branch;
    const study::LocusStudy locus;
    table.push_back({"branch.along", "", "a key of the actuator", "the drive frequency", "what is varied"});
    table.push_back({"branch.from", "", "a value of that key", "3 linear resonance", "start of the range"});
    table.push_back({"branch.to", "", "a value of that key", "0.6 linear resonance", "end of the range"});
    table.push_back({"branch.period", "", "whole number, at least 1", std::to_string(branch.period),
                     "also branches of motions of up to this many drive cycles"});
    table.push_back({"branch.starts", "", "whole number, at least 0", std::to_string(branch.starts),
                     "starts of the search for such motions, at each frequency it looks at"});
    table.push_back({"branch.max_points", "", "whole number, at least 2", std::to_string(branch.max_points),
                     "most points of a branch"});
    table.push_back({"locus.boundary", "", "fold | flip | torus | grazing", "fold", "kind of boundary to follow"});
    table.push_back({"locus.along", "", "a key of the actuator", "none", "what is varied besides the drive frequency"});
    table.push_back({"locus.from", "", "a value of that key", "none", "start of the range"});
    table.push_back({"locus.to", "", "a value of that key", "none", "end of the range"});
    table.push_back({"locus.steps", "", "whole number, at least 1", std::to_string(locus.steps),
                     "about so many round values of the key are among the points"});
    table.push_back({"locus.max_points", "", "whole number, at least 2", std::to_string(locus.max_points),
                     "most points of a curve"});
}

void add_attractors_keys(std::vector<SettingInfo>& table) {
    const study::AttractorsStudy study;
    const std::string corner = "numbers separated by commas or blanks; both corners or none";
    table.push_back({"attractors.starts", "", "whole number, at least 1", std::to_string(study.starts),
                     "starts drawn from the box"});
    table.push_back({"attractors.cycles", "", "whole number, at least 1", std::to_string(study.cycles),
                     "drive cycles each start is followed at most (four times that when it creeps towards an orbit)"});
    table.push_back({"attractors.lower", "", corner, "from gap and stroke", "corner of the box: lowest states"});
    table.push_back({"attractors.upper", "", corner, "from gap and stroke", "corner of the box: highest states"});
}

std::vector<SettingInfo> make_table() {
    const design::Problem problem;
    const study::OptimiserOptions optimiser;
    const study::OrbitStudy orbit;
    const auto number = [](double value) { return model::number_text(value); };

    std::vector<SettingInfo> table;
    table.push_back({"actuator.type", "", "dielectric-elastomer | spring-mass", "told by the sections present",
                     "kind of actuator"});
    add_model_keys(table, "actuator.");
    add_model_keys(table, "material.");
    table.push_back({"stop.law", "", "kelvin-voigt | no-tension | none", "kelvin-voigt",
                     "force law of the stop; none: there is no stop"});
    add_model_keys(table, "stop.");
    add_model_keys(table, "drive.");
    table.push_back({"drive.margin", "", "at least 0, below 1", number(problem.margin),
                     "operate this fraction of the edge below it"});
    add_model_keys(table, "nondimensional.");
    add_model_keys(table, "spring-mass.");

    table.push_back(
        {"design.variable", "", "KEY in LOWER .. UPPER [log] [integer]", "none", "a key that may be varied", true});
    table.push_back({"design.maximise", "", "a quantity", "none", "what to make large", true});
    table.push_back({"design.minimise", "", "a quantity", "none", "what to make small", true});
    table.push_back(
        {"design.limit", "", "QUANTITY <= VALUE or QUANTITY >= VALUE", "none", "what a design must respect", true});
    table.push_back(
        {"design.single_stable", "", "off | orbit | sampled | refuted", "orbit",
         "how it is checked that the motion is the only stable one: among the period-1 motions; by starts all "
         "over a box; and with what refutes a design avoided by the optimiser"});

    table.push_back({"uniqueness.starts", "", "whole number, at least 1", std::to_string(problem.sampling.starts),
                     "starts of the sampled check of uniqueness (single_stable = sampled or refuted)"});
    table.push_back({"uniqueness.cycles", "", "whole number, at least 1", std::to_string(problem.sampling.cycles),
                     "drive cycles that each of them may take to settle"});
    table.push_back({"uniqueness.margin", "", "at least 0, below 0.5", "drive.margin",
                     "distance kept from the frequencies at which a motion that refuted a design exists"});
    table.push_back({"optimiser.method", "", alternatives(optimise::methods()), optimiser.method, "optimiser"});
    table.push_back({"optimiser.starts", "", "whole number, at least 1", std::to_string(optimiser.starts),
                     "local solves per layer count"});
    table.push_back({"optimiser.samples", "", "whole number, at least 0", std::to_string(optimiser.samples),
                     "space-filling designs looked at before, per layer count"});
    table.push_back({"optimiser.max_evaluations", "", "whole number, at least 1",
                     std::to_string(optimiser.max_evaluations), "budget per layer count"});
    table.push_back({"optimiser.tolerance", "", "above 0, below 1", number(optimiser.tolerance),
                     "KKT residual at which a point is certified"});

    table.push_back({"solver.tolerance", "", "above 1e-16, below 0.01", number(problem.solver.tolerance),
                     "relative tolerance of an integration step"});
    table.push_back({"solver.integrator", "", "taylor | erk | cvode", problem.solver.integrator, "integrator"});
    table.push_back({"solver.instruction_set", "", "auto | v2 | v3 | v4 | generic", problem.solver.instruction_set,
                     "x86-64 level of the kernels"});

    table.push_back({"orbit.start", "", "numbers separated by commas or blanks", "the motion reached from rest",
                     "state at theta = 0 that Newton's method starts from"});
    table.push_back({"orbit.period", "", "whole number, at least 1", std::to_string(orbit.period),
                     "period of the orbit in drive cycles"});
    add_simulate_keys(table);
    add_sweep_keys(table);
    add_branch_keys(table);
    add_attractors_keys(table);
    return table;
}

const std::vector<SettingInfo>& table_instance() {
    static const std::vector<SettingInfo> table = make_table();
    return table;
}

}  // namespace

std::span<const SettingInfo> setting_table() { return table_instance(); }

const SettingInfo* find_setting(std::string_view name) {
    const auto& table = table_instance();
    const auto found =
        std::find_if(table.begin(), table.end(), [&](const SettingInfo& info) { return info.name == name; });
    return found == table.end() ? nullptr : &*found;
}

std::string alternatives(std::span<const std::string> names) {
    std::string text;
    for (const std::string& name : names) { text += (text.empty() ? "" : " | ") + name; }
    return text;
}

}  // namespace percuss::io
