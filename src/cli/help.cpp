#include "cli/help.hpp"

#include "cli/arguments.hpp"
#include "verbs/presentation.hpp"
#include "verbs/setting_table.hpp"

namespace percuss::cli {

namespace {

results::Block options_block(std::string_view verb) {
    results::Block block{"Options", "", {"option", "meaning"}, {}};
    for (const OptionInfo& option : run_options()) {
        const bool applies = option.only_for.empty() || verb.empty() || option.only_for.find(verb) != std::string::npos;
        if (!applies) { continue; }
        std::string name = "--" + std::string(option.name);
        name += option.value.empty() ? "" : " " + std::string(option.value);
        std::string meaning(option.meaning);
        if (verb.empty() && !option.only_for.empty()) { meaning += " (" + std::string(option.only_for) + ")"; }
        block.rows.push_back({name, meaning});
    }
    return block;
}

results::Block keys_block() {
    results::Block block{"Keys of problem files, each also an option (--stop.gap \"0.4 mm\"), which then wins",
                         "",
                         {"key", "unit", "allowed", "default", "meaning"},
                         {}};
    for (const verbs::SettingInfo& info : verbs::setting_table()) {
        block.rows.push_back({info.name, info.unit.empty() ? "-" : info.unit, info.allowed,
                              info.fallback.empty() ? "required" : info.fallback,
                              info.meaning + (info.repeatable ? " (repeatable)" : "")});
    }
    return block;
}

}  // namespace

std::string general_help() {
    results::Presentation help;
    help.title = "percuss VERB PROBLEM [options]: design of resonant impact actuators";
    results::Block verb_block{"Verbs", "", {"verb", "does"}, {}};
    for (const VerbInfo& verb : verbs()) {
        verb_block.rows.push_back(
            {std::string(verb.name), std::string(verb.summary) + (verb.available ? "" : " (not in this version)")});
    }
    help.blocks.push_back(verb_block);
    help.blocks.push_back(options_block(""));
    results::Block more;
    more.sentence =
        "percuss VERB --help lists every key of a problem file; percuss --version prints the version.\n"
        "Exit status: 0 done and verified, 1 internal error, 2 bad usage or problem file, 3 no feasible "
        "design\nor no impact, 4 budget spent or not certified, 5 some evaluations failed, 130 interrupted.";
    help.blocks.push_back(more);
    return results::plain_text(help);
}

std::string verb_help(std::string_view verb) {
    results::Presentation help;
    help.title = "percuss " + std::string(verb) + " PROBLEM [options]";
    for (const VerbInfo& info : verbs()) {
        if (info.name == verb) { help.title += ": " + std::string(info.summary); }
    }
    help.blocks.push_back(options_block(verb));
    help.blocks.push_back(keys_block());
    results::Block more;
    more.sentence = "Values carry units (\"0.6 mm\", \"51.9 N/mm\"); a bare number is in the unit listed. Keys of "
                    "[nondimensional] are plain numbers.\nRequired keys are those of the kind of actuator described: "
                    "[nondimensional], or [actuator] and [material], or [spring-mass].";
    help.blocks.push_back(more);
    return results::plain_text(help);
}

}  // namespace percuss::cli
