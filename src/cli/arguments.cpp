#include "cli/arguments.hpp"

#include "model/units.hpp"
#include "problem/nearest_name.hpp"
#include "problem/problem_error.hpp"

#include <algorithm>
#include <array>
#include <charconv>
#include <stdexcept>

namespace percuss::cli {

namespace {

using problem::ProblemError;
using problem::Setting;

template <class Integer>
Integer parse_integer(const Setting& option, Integer lowest);
double parse_seconds(const Setting& option);

/// A common option with what it does to the arguments.
struct CommonRow {
    CommonOption option;
    void (*apply)(const Setting& option, Arguments& arguments);
};

constexpr std::array common_table = {
    CommonRow{{"out", "DIR",
               "results folder, or none to write no files (default results/PROBLEM-VERB, with six digits of the "
               "problem's hash where options changed the problem)"},
              [](const Setting& s, Arguments& a) { a.run.out = s.value; }},
    CommonRow{{"json", "", "print one JSON document on stdout and nothing else there"},
              [](const Setting&, Arguments& a) { a.json = true; }},
    CommonRow{{"jobs", "N", "threads; results do not depend on it"},
              [](const Setting& s, Arguments& a) { a.run.jobs = parse_integer<int>(s, 1); }},
    CommonRow{{"seed", "N", "seed of everything that is drawn at random"},
              [](const Setting& s, Arguments& a) { a.run.seed = parse_integer<std::uint64_t>(s, 0); }},
    CommonRow{{"time-limit", "S", "end after so many seconds with the results so far"},
              [](const Setting& s, Arguments& a) { a.time_limit = parse_seconds(s); }},
    CommonRow{{"quiet", "", "no progress and no remarks on stderr"},
              [](const Setting&, Arguments& a) { a.quiet = true; }},
    CommonRow{{"force", "", "replace the results of an unfinished run or of another problem"},
              [](const Setting&, Arguments& a) { a.run.force = true; }},
    CommonRow{{"help", "", "describe the options and keys"},
              [](const Setting&, Arguments& a) { a.help = Topic::verb; }},
};

template <class Integer>
Integer parse_integer(const Setting& option, Integer lowest) {
    Integer value = 0;
    const char* end = option.value.data() + option.value.size();
    const auto [last, error] = std::from_chars(option.value.data(), end, value);
    if (error != std::errc() || last != end || value < lowest) {
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

/// An option of a verb stands for a key, or does something of its own.
void apply(const Setting& option, const verbs::VerbOption& info, Arguments& arguments) {
    if (info.apply != nullptr) {
        info.apply(option, arguments.run);
    } else {
        const std::string value = info.value.empty() ? std::string(info.key_value) : option.value;
        arguments.run.keys.push_back({std::string(info.key), value, true});
    }
}

void apply(const Setting& option, Arguments& arguments) {
    for (const CommonRow& row : common_table) {
        if (row.option.name == option.key) { return row.apply(option, arguments); }
    }
    for (const verbs::VerbOption& info : arguments.verb->options) {
        if (info.name == option.key) { return apply(option, info, arguments); }
    }
}

std::vector<problem::RunOption> run_options_of(const verbs::Verb& verb) {
    std::vector<problem::RunOption> options;
    options.reserve(std::size(common_table) + verb.options.size());
    for (const CommonRow& row : common_table) {
        options.push_back({std::string(row.option.name), !row.option.value.empty()});
    }
    for (const verbs::VerbOption& info : verb.options) {
        options.push_back({std::string(info.name), !info.value.empty()});
    }
    return options;
}

/// "percuss help", "percuss help keys", "percuss help VERB".
Arguments parse_help(std::span<const std::string> words) {
    Arguments parsed;
    parsed.help = Topic::general;
    if (words.size() > 1) { throw ProblemError("unexpected argument '" + words[1] + "' after help " + words[0]); }
    if (words.empty()) { return parsed; }
    if (words[0] == "keys" || words[0] == "quantities") {
        parsed.help = words[0] == "keys" ? Topic::keys : Topic::quantities;
        return parsed;
    }
    parsed.help = Topic::verb;
    parsed.verb = &verbs::find_verb(words[0]);
    return parsed;
}

}  // namespace

std::span<const CommonOption> common_options() {
    static const auto options = [] {
        std::array<CommonOption, common_table.size()> out;
        for (std::size_t i = 0; i < out.size(); ++i) { out[i] = common_table[i].option; }
        return out;
    }();
    return options;
}

Arguments parse_arguments(std::span<const std::string> arguments) {
    Arguments parsed;
    if (arguments.empty()) { throw ProblemError("give a verb and a problem file; percuss --help lists the verbs"); }
    const std::string& first = arguments.front();
    if (first == "--help" || first == "-h" || first == "--version") {
        parsed.help = first == "--version" ? Topic::none : Topic::general;
        parsed.version = first == "--version";
        return parsed;
    }
    if (first == "help") { return parse_help(arguments.subspan(1)); }
    if (first.starts_with('-')) {
        throw ProblemError("the first argument must be a verb, not " + first + "; percuss --help lists them");
    }
    parsed.verb = &verbs::find_verb(first);
    const auto line =
        problem::parse_command_line(arguments.subspan(1), run_options_of(*parsed.verb), verbs::sections());
    parsed.run.keys = line.keys;
    for (const Setting& option : line.run_options) { apply(option, parsed); }
    if (parsed.help != Topic::none) { return parsed; }
    const std::string name(parsed.verb->name);
    if (!parsed.verb->folders.empty()) {
        if (line.positional.empty()) { throw ProblemError(name + " needs " + std::string(parsed.verb->folders)); }
        parsed.run.folders.assign(line.positional.begin(), line.positional.end());
        return parsed;
    }
    if (line.positional.empty()) { throw ProblemError(name + " needs a problem file"); }
    if (line.positional.size() > 1) {
        throw ProblemError("unexpected argument '" + line.positional[1] + "' after the problem file " +
                           line.positional[0]);
    }
    parsed.run.file = line.positional.front();
    return parsed;
}

}  // namespace percuss::cli
