#include "verbs/simulate/verb.hpp"

#include "model/number_text.hpp"
#include "problem/row_types.hpp"
#include "verbs/orbit/orbit.hpp"
#include "verbs/simulate/kick.hpp"
#include "verbs/simulate/simulate_results.hpp"

namespace percuss::verbs {

namespace {

using model::trimmed;
using problem::bad_value;
using problem::Context;
using problem::Echo;
using problem::Setting;

void read_start(SimulateOptions& options, const Setting& setting, const Context& context) {
    const std::string_view text = trimmed(setting.value);
    if (text == "rest" || text == "orbit") {
        options.from = text == "rest" ? SimulationStart::rest : SimulationStart::orbit;
        return;
    }
    const std::size_t states = problem::states_of(*context.actuator.type);
    // A misspelt word deserves the list of words; what begins like a number goes on to be read as a state.
    const bool is_word =
        !text.empty() && std::string_view("+-.0123456789").find(text.front()) == std::string_view::npos;
    if (is_word || text.empty()) {
        throw bad_value(setting, "must be rest, orbit or " + std::to_string(states) + " numbers");
    }
    options.start = problem::parse_state(setting, states);
    options.from = SimulationStart::state;
}

std::vector<Echo> start_echo(const SimulateOptions& options, const Context& /*context*/) {
    if (options.from == SimulationStart::state) { return {{problem::state_text(options.start)}}; }
    return {{options.from == SimulationStart::orbit ? "orbit" : "rest"}};
}

void read_kick(SimulateOptions& options, const Setting& setting, const Context& context) {
    if (trimmed(setting.value) == "none") { return; }
    const Kick kick = parse_kick(setting, *context.actuator.type);
    if (!(kick.end() <= options.cycles)) {
        throw bad_value(setting, "it ends at cycle " + model::number_text(kick.end()) +
                                     ", after the series (cycles = " + std::to_string(options.cycles) + ")");
    }
    options.kick = kick;
}

std::vector<Echo> kick_echo(const SimulateOptions& options, const Context& context) {
    return {{options.kick ? kick_text(*options.kick, *context.actuator.type) : "none"}};
}

Outcome run(Session& session) {
    SimulateOptions options = session.get<SimulateOptions>();
    options.orbit_start = session.get<OrbitOptions>().start;
    options.orbit_period = session.get<OrbitOptions>().period;
    session.start({"series.csv", "contacts.csv"});
    SimulateResult result;
    {
        const auto series = session.table("series.csv");
        const auto contacts = session.table("contacts.csv");
        result = run_simulate(session.study(), options, series.get(), contacts.get(), session.observer(),
                              session.cancelled());
    }
    result.ending = session.ending_of(result.ending);
    return {result.ending, std::string(status_of(result)), result.reason, simulate_document(session.problem(), result),
            present_simulation(session.problem(), result)};
}

}  // namespace

problem::Section simulate_section() {
    using namespace problem;
    using Options = SimulateOptions;
    return section_of<Options>({
        setting<Options>("simulate.start", "", "rest, orbit, or numbers separated by commas or blanks", "rest",
                         "state at theta = 0; orbit: the orbit that verb orbit finds (orbit.start, orbit.period)",
                         read_start, start_echo),
        count<Options>("simulate.cycles", &Options::cycles, Whole{1}, "length of the series in drive cycles"),
        count<Options>("simulate.samples", &Options::samples, Whole{1, 100'000}, "rows of the series per drive cycle"),
        setting<Options>("simulate.kick", "", "velocity ... | voltage ... | force ... | none", "none",
                         "a disturbance: 'velocity 0.05 m/s at cycle 50': x' jumps by so much; 'voltage 50 % for 2 "
                         "cycles at cycle 50' (spring-mass: force): the drive is that share of itself; cycles may be "
                         "fractions",
                         read_kick, kick_echo),
    });
}

Verb simulate_verb() {
    Verb verb;
    verb.name = "simulate";
    verb.summary = "time series from a start state, with or without a kick";
    verb.options = {{"period", "N", "short for --orbit.period", "orbit.period"},
                    {"start", "STATE", "short for --simulate.start", "simulate.start"},
                    {"cycles", "N", "short for --simulate.cycles", "simulate.cycles"},
                    {"kick", "TEXT", "short for --simulate.kick", "simulate.kick"}};
    verb.sections = {"simulate", "orbit"};
    verb.run = run;
    return verb;
}

}  // namespace percuss::verbs
