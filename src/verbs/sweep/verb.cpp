#include "verbs/sweep/verb.hpp"

#include "model/units.hpp"
#include "problem/row_types.hpp"
#include "verbs/sweep/sweep_results.hpp"

#include <numbers>

namespace percuss::verbs {

namespace {

using problem::bad_value;
using problem::Context;
using problem::Echo;
using problem::Setting;

constexpr int longest_sweep_period = 12;  // drive cycles: what orbit::settle_until_repeating compares

bool is_plain(const Context& context) { return context.actuator.type->nondimensional; }

bool takes_rad_per_second(const model::Actuator& actuator) {
    return std::any_of(actuator.frequencies.begin(), actuator.frequencies.end(),
                       [](model::Key key) { return model::key_info(key).unit == "rad/s"; });
}

/// An angular frequency: omega of a nondimensional problem, else in Hz, or for spring-mass problems also in rad/s.
double parse_frequency(const Setting& setting, const Context& context) {
    double value = 0.0;
    try {
        if (is_plain(context)) {
            value = model::parse_plain_number(setting.value);
        } else if (takes_rad_per_second(*context.actuator.type) && setting.value.find("rad") != std::string::npos) {
            value = model::parse_quantity(setting.value, "rad/s");
        } else {
            value = 2.0 * std::numbers::pi * problem::parse_key_value(model::Key::drive_frequency, setting.value);
        }
    } catch (const std::invalid_argument& error) { throw bad_value(setting, error.what()); }
    if (!(value > 0.0)) { throw bad_value(setting, "must be above 0"); }
    return value;
}

std::vector<Echo> frequency_echo(const std::optional<double>& omega, const Context& context) {
    if (!omega) { return {}; }
    return {is_plain(context) ? problem::number_echo(*omega, "")
                              : problem::number_echo(*omega / (2.0 * std::numbers::pi), "Hz")};
}

Outcome run(Session& session) {
    session.start({"sweep.csv"});
    SweepResult result;
    {
        const auto rows = session.table("sweep.csv");
        result = run_sweep(session.study(), session.get<SweepOptions>(), rows.get(), session.observer(),
                           session.cancelled());
    }
    result.ending = session.ending_of(result.ending);
    return {result.ending, std::string(status_of(result)), result.reason, sweep_document(session.problem(), result),
            present_sweep(session.problem(), result)};
}

}  // namespace

problem::Section sweep_section() {
    using namespace problem;
    using Options = SweepOptions;
    const std::string kind = ", or omega of a nondimensional problem; spring-mass problems take rad/s as well";
    return section_of<Options>({
        choice<Options, SweepMode>("sweep.mode", &Options::mode,
                                   {{"steps", SweepMode::steps}, {"chirp", SweepMode::chirp}},
                                   "steps: settle at every frequency, on from the state of the one before; chirp: "
                                   "never settle, the frequency moves on with every drive cycle at a constant rate in "
                                   "time"),
        setting<Options>(
            "sweep.from", "Hz", "above 0", "0.6 linear resonance", "lowest drive frequency" + kind,
            [](Options& o, const Setting& s, const Context& c) { o.from = parse_frequency(s, c); },
            [](const Options& o, const Context& c) { return frequency_echo(o.from, c); }),
        setting<Options>(
            "sweep.to", "Hz", "above sweep.from", "2 linear resonance", "highest drive frequency" + kind,
            [](Options& o, const Setting& s, const Context& c) {
                o.to = parse_frequency(s, c);
                if (o.from && !(*o.from < *o.to)) { throw bad_value(s, "must be above sweep.from"); }
            },
            [](const Options& o, const Context& c) { return frequency_echo(o.to, c); }),
        count<Options>("sweep.steps", &Options::steps, Whole{1, 1'000'000}, "frequency steps in each direction"),
        number<Options>("sweep.tolerance", &Options::tolerance, Between{1e-12, 1e-2},
                        "a motion has settled when its strobed change and what is left to the orbit (one Newton step; "
                        "change rho/(1 - rho) for a multiplier rho) are below this, relative to 1 + |state|"),
        count<Options>("sweep.max_cycles", &Options::max_cycles, Whole{1, 1'000'000},
                       "drive cycles to wait for that at each frequency"),
        count<Options>("sweep.longest_period", &Options::longest_period, Whole{1, longest_sweep_period},
                       "repeats after up to so many drive cycles are recognised"),
        count<Options>("sweep.chirp_cycles", &Options::chirp_cycles, Whole{1, 10'000'000},
                       "drive cycles of a chirp in each direction"),
    });
}

Verb sweep_verb() {
    Verb verb;
    verb.name = "sweep";
    verb.summary = "forward and backward frequency sweeps in the time domain";
    verb.options = {{"from", "VALUE", "short for --sweep.from", "sweep.from"},
                    {"to", "VALUE", "short for --sweep.to", "sweep.to"},
                    {"steps", "N", "short for --sweep.steps", "sweep.steps"},
                    {"chirp", "", "short for --sweep.mode chirp", "sweep.mode", "chirp"}};
    verb.sections = {"sweep"};
    verb.run = run;
    verb.frequency = problem::FrequencyUse::ranges;
    return verb;
}

}  // namespace percuss::verbs
