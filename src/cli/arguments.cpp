#include "cli/arguments.hpp"

#include "model/units.hpp"
#include "problem/nearest_name.hpp"
#include "problem/problem_error.hpp"
#include "verbs/setting_table.hpp"

#include <algorithm>
#include <array>
#include <charconv>
#include <stdexcept>

namespace percuss::cli {

namespace {

using problem::ProblemError;
using verbs::Setting;

constexpr std::array verb_table = {
    VerbInfo{"check", "print every value of a problem with units, say what is missing or out of range", true},
    VerbInfo{"simulate", "time series from a start state, with or without a kick", true},
    VerbInfo{"force-displacement", "quasi-static curve of one membrane", false},
    VerbInfo{"sweep", "forward and backward frequency sweeps in the time domain", true},
    VerbInfo{"orbit", "the periodic orbit at one frequency: state, multipliers, quantities", true},
    VerbInfo{"branch", "continuation in the drive frequency or a design variable: hysteresis map, all boundaries",
             true},
    VerbInfo{"locus", "follow a boundary in two parameters", true},
    VerbInfo{"attractors", "every stable motion found at one operating point", true},
    VerbInfo{"evaluate", "one design: operating point, quantities, uniqueness", true},
    VerbInfo{"explore", "a table over the design space", false},
    VerbInfo{"optimise", "the best design, certified", true},
    VerbInfo{"pareto", "the front of two or three objectives", false},
    VerbInfo{"benchmark", "compare optimisers over problems and seeds", false},
    VerbInfo{"report", "one self-contained page from a results folder", false},
};

constexpr std::array option_table = {
    OptionInfo{"out", "DIR", "results folder, or none to write no files (default results/PROBLEM-VERB)", ""},
    OptionInfo{"json", "", "print one JSON document on stdout and nothing else there", ""},
    OptionInfo{"jobs", "N", "threads; results do not depend on it", ""},
    OptionInfo{"seed", "N", "seed of everything that is drawn at random", ""},
    OptionInfo{"time-limit", "S", "stop after so many seconds with the results so far", ""},
    OptionInfo{"quiet", "", "no progress and no remarks on stderr", ""},
    OptionInfo{"force", "", "replace the results of an unfinished run", ""},
    OptionInfo{"help", "", "describe the options and keys", ""},
    OptionInfo{"gradients", "", "also the derivatives of what was found", "evaluate orbit branch"},
    OptionInfo{"period", "N", "short for --orbit.period or --branch.period", "orbit simulate branch"},
    OptionInfo{"start", "STATE", "short for --simulate.start", "simulate"},
    OptionInfo{"cycles", "N", "short for --simulate.cycles", "simulate"},
    OptionInfo{"kick", "TEXT", "short for --simulate.kick", "simulate"},
    OptionInfo{"from", "VALUE", "short for --VERB.from", "sweep branch locus"},
    OptionInfo{"to", "VALUE", "short for --VERB.to", "sweep branch locus"},
    OptionInfo{"steps", "N", "short for --VERB.steps", "sweep locus"},
    OptionInfo{"along", "KEY", "short for --VERB.along", "branch locus"},
    OptionInfo{"boundary", "KIND", "short for --locus.boundary", "locus"},
    OptionInfo{"starts", "N", "short for --VERB.starts", "branch attractors"},
    OptionInfo{"chirp", "", "short for --sweep.mode chirp", "sweep"},
};

bool applies(const OptionInfo& option, std::string_view verb) {
    if (option.only_for.empty()) { return true; }
    std::string_view rest = option.only_for;
    while (!rest.empty()) {
        const auto blank = std::min(rest.find(' '), rest.size());
        if (rest.substr(0, blank) == verb) { return true; }
        rest.remove_prefix(std::min(blank + 1, rest.size()));
    }
    return false;
}

/// The verb in its canonical spelling.
std::string parse_verb(const std::string& word) {
    std::string name = word == "optimize" ? "optimise" : word;
    std::vector<std::string> names;
    for (const VerbInfo& info : verbs()) {
        if (info.name == name && info.available) { return name; }
        if (info.name == name) { throw ProblemError("the verb " + name + " is not available in this version"); }
        names.emplace_back(info.name);
    }
    if (word.starts_with('-')) {
        throw ProblemError("the first argument must be a verb, not " + word + "; percuss --help lists them");
    }
    throw ProblemError("unknown verb '" + word + "'; the nearest one is " + problem::nearest_name(name, names));
}

template <class Integer>
Integer parse_integer(const Setting& option, Integer lowest) {
    Integer value = 0;
    const char* end = option.value.data() + option.value.size();
    const auto [stopped, error] = std::from_chars(option.value.data(), end, value);
    if (error != std::errc() || stopped != end || value < lowest) {
        throw ProblemError(as_written(option) + ": must be a whole number, at least " + std::to_string(lowest));
    }
    return value;
}

double parse_seconds(const Setting& option) {
    double seconds = 0.0;
    try {
        seconds = model::parse_quantity(option.value, "s");
    } catch (const std::invalid_argument& error) { throw ProblemError(as_written(option) + ": " + error.what()); }
    if (!(seconds > 0.0)) { throw ProblemError(as_written(option) + ": must be above 0 s"); }
    return seconds;
}

void apply(const Setting& option, Arguments& arguments) {
    if (option.key == "out") {
        arguments.out = option.value;
    } else if (option.key == "json") {
        arguments.json = true;
    } else if (option.key == "jobs") {
        arguments.jobs = parse_integer<int>(option, 1);
    } else if (option.key == "seed") {
        arguments.seed = parse_integer<std::uint64_t>(option, 0);
    } else if (option.key == "time-limit") {
        arguments.time_limit = parse_seconds(option);
    } else if (option.key == "quiet") {
        arguments.quiet = true;
    } else if (option.key == "force") {
        arguments.force = true;
    } else if (option.key == "help") {
        arguments.help = true;
    } else if (option.key == "gradients") {
        arguments.gradients = true;
    } else if (option.key == "chirp") {
        arguments.keys.push_back({"sweep.mode", "chirp", true});
    } else {
        const std::string own = arguments.verb + "." + option.key;  // the verb's section, or that of orbits
        const bool has_own = verbs::find_setting(own) != nullptr;
        arguments.keys.push_back({has_own ? own : "orbit." + option.key, option.value, true});
    }
}

std::vector<verbs::RunOption> run_options_of(std::string_view verb) {
    std::vector<verbs::RunOption> options;
    for (const OptionInfo& info : option_table) {
        if (applies(info, verb)) { options.push_back({std::string(info.name), !info.value.empty()}); }
    }
    return options;
}

}  // namespace

std::span<const VerbInfo> verbs() { return verb_table; }

std::span<const OptionInfo> run_options() { return option_table; }

Arguments parse_arguments(std::span<const std::string> arguments) {
    Arguments parsed;
    if (arguments.empty()) { throw ProblemError("give a verb and a problem file; percuss --help lists the verbs"); }
    const std::string& first = arguments.front();
    if (first == "--help" || first == "-h" || first == "--version") {
        parsed.help = first != "--version";
        parsed.version = !parsed.help;
        return parsed;
    }
    parsed.verb = parse_verb(first);
    const auto line = verbs::parse_command_line(arguments.subspan(1), run_options_of(parsed.verb));
    parsed.keys = line.keys;
    for (const Setting& option : line.run_options) { apply(option, parsed); }
    if (parsed.help) { return parsed; }
    if (line.positional.empty()) { throw ProblemError(parsed.verb + " needs a problem file"); }
    if (line.positional.size() > 1) {
        throw ProblemError("unexpected argument '" + line.positional[1] + "' after the problem file " +
                           line.positional[0]);
    }
    parsed.problem = line.positional.front();
    return parsed;
}

}  // namespace percuss::cli
