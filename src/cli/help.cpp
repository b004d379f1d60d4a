#include "cli/help.hpp"

#include "cli/arguments.hpp"
#include "design/quantity.hpp"
#include "model/registry.hpp"
#include "results/presentation.hpp"

#include <algorithm>
#include <array>
#include <functional>

#include <sys/ioctl.h>
#include <unistd.h>

namespace percuss::cli {

namespace {

using results::Block;
using results::Presentation;

std::string option_text(std::string_view name, std::string_view value) {
    return "--" + std::string(name) + (value.empty() ? "" : " " + std::string(value));
}

Block common_block() {
    Block block{"Options of every verb", "", {"option", "meaning"}, {}};
    for (const CommonOption& option : common_options()) {
        block.rows.push_back({option_text(option.name, option.value), std::string(option.meaning)});
    }
    return block;
}

/// The keys that `listed` tells, one line each: name, what is allowed and the default, meaning.
Block keys_block(const std::function<bool(const problem::Row&)>& listed) {
    Block block{"Keys of problem files, each also an option (--stop.gap \"0.4 mm\"), which then wins",
                "",
                {"key", "meaning, what is allowed, default"},
                {}};
    for (const problem::Section& section : verbs::sections()) {
        for (const problem::Row& row : section.rows) {
            if (!listed(row)) { continue; }
            const std::string unit = row.unit.empty() ? "" : " [" + row.unit + "]";
            const std::string fallback = row.fallback.empty() ? "required" : "default " + row.fallback;
            std::string meaning = row.meaning;
            meaning.append(row.repeatable() ? " (repeatable)" : "").append("; ").append(row.allowed);
            meaning.append(unit).append("; ").append(fallback);
            block.rows.push_back({row.name, meaning});
        }
    }
    return block;
}

Block values_block() {
    std::string kinds;
    for (const model::Actuator* actuator : model::actuators()) {
        kinds += (kinds.empty() ? "" : ", or ") + std::string(actuator->sections_in_words);
    }
    return results::sentence(
        "Values carry units (\"0.6 mm\", \"51.9 N/mm\"); a bare number is in the unit listed. Keys "
        "of [nondimensional] are plain numbers. Required keys are those of the kind of actuator "
        "described: " +
        kinds +
        ". A repeatable "
        "key given as an option adds to the list of the file or replaces its entry about the same "
        "quantity or key; none clears the list first.");
}

/// A row of the registry among those of its type: "dielectric-elastomer", or "[nondimensional]" for those told by their
/// section.
std::string name_of(const model::Actuator& actuator) {
    return std::string(actuator.nondimensional ? actuator.sections_in_words : actuator.type);
}

}  // namespace

std::string general_help(std::size_t width) {
    Presentation help;
    help.title = "percuss VERB PROBLEM [options]: design of resonant impact actuators";
    Block verb_block{"Verbs", "", {"verb", "does"}, {}};
    for (const verbs::Verb& verb : verbs::verbs()) {
        const bool available = verb.run != nullptr;
        verb_block.rows.push_back(
            {std::string(verb.name), std::string(verb.summary) + (available ? "" : " (not in this version)")});
    }
    help.blocks.push_back(verb_block);
    help.blocks.push_back(common_block());
    help.blocks.push_back(
        results::sentence("percuss VERB --help lists the options and keys of a verb, percuss help keys all keys of "
                          "problem files, percuss "
                          "help quantities what can be asked for; percuss --version prints the version."));
    help.blocks.push_back(
        results::sentence("Exit status: 0 done and verified, 1 internal error, 2 bad usage or problem file, 3 no "
                          "feasible design or no impact, 4 budget spent or not certified, 5 some evaluations failed, "
                          "130 interrupted."));
    return results::plain_text(help, width);
}

std::string verb_help(const verbs::Verb& verb, std::size_t width) {
    Presentation help;
    const std::string_view operand = verb.folders.empty() ? "PROBLEM" : verb.folders;
    help.title =
        "percuss " + std::string(verb.name) + " " + std::string(operand) + " [options]: " + std::string(verb.summary);
    Block own{"Options of " + std::string(verb.name), "", {"option", "meaning"}, {}};
    for (const verbs::VerbOption& option : verb.options) {
        own.rows.push_back({option_text(option.name, option.value), std::string(option.meaning)});
    }
    if (!own.rows.empty()) { help.blocks.push_back(own); }
    help.blocks.push_back(common_block());
    if (!verb.folders.empty()) { return results::plain_text(help, width); }
    help.blocks.push_back(keys_block([&](const problem::Row& row) { return verbs::reads(verb, row); }));
    help.blocks.push_back(values_block());
    return results::plain_text(help, width);
}

std::string keys_help(std::size_t width) {
    Presentation help;
    help.title = "Keys of problem files";
    help.blocks.push_back(keys_block([](const problem::Row&) { return true; }));
    help.blocks.push_back(values_block());
    return results::plain_text(help, width);
}

std::string quantities_help(std::size_t width) {
    Presentation help;
    help.title = "Quantities: for design.maximise, design.minimise and design.limit";
    Block block{"", "", {"quantity", "unit", "meaning", "actuators"}, {}};
    for (const design::QuantityInfo& info : design::all_quantities()) {
        std::string having;
        for (const model::Actuator* each : model::actuators()) {
            const auto all = design::reported_quantities(*each);
            const bool has = std::find(all.begin(), all.end(), info.quantity) != all.end();
            if (has) { having += (having.empty() ? "" : ", ") + name_of(*each); }
        }
        block.rows.push_back({std::string(info.name), info.unit == "1" ? "-" : std::string(info.unit),
                              std::string(info.meaning), having});
    }
    help.blocks.push_back(block);
    return results::plain_text(help, width);
}

std::size_t terminal_width() {
    constexpr std::size_t usual = 80;
    constexpr std::size_t least = 40;
    winsize size{};
    const bool known = isatty(STDOUT_FILENO) != 0 && ioctl(STDOUT_FILENO, TIOCGWINSZ, &size) == 0 && size.ws_col > 0;
    return known ? std::max<std::size_t>(size.ws_col, least) : usual;
}

}  // namespace percuss::cli
