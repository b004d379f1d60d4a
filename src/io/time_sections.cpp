#include "io/problem_sections.hpp"

#include "io/setting_values.hpp"
#include "model/number_text.hpp"
#include "model/units.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

namespace percuss::io {

namespace {

using model::trimmed;
using study::Kick;
using study::SimulationStart;
using study::SweepMode;

constexpr double largest_share = 10.0;
constexpr int longest_sweep_period = 12;  // drive cycles

ProblemError bad_kick(const Setting& setting, const model::Actuator& family, const std::string& why) {
    const std::string drive(family.drive_word);
    const std::string unit = family.nondimensional ? "" : " m/s";
    return bad_value(setting, why + "; allowed are 'velocity VALUE at cycle N' and '" + drive +
                                  " SHARE for N cycles at cycle N', as in 'velocity 0.05" + unit +
                                  " at cycle 50' and '" + drive + " 50 % for 1 cycle at cycle 50'");
}

/// Splits at the last place where `word` stands by itself; false if there is none.
bool split_at(std::string_view text, std::string_view word, std::string_view& before, std::string_view& after) {
    const std::string between = " " + std::string(word) + " ";
    const auto at = text.rfind(between);
    if (at == std::string_view::npos) { return false; }
    before = trimmed(text.substr(0, at));
    after = trimmed(text.substr(at + between.size()));
    return true;
}

/// Every stretch of white space as one blank.
std::string with_single_blanks(std::string_view text) {
    std::string out;
    for (const char c : trimmed(text)) {
        const char plain = c == '\t' ? ' ' : c;
        if (plain != ' ' || out.back() != ' ') { out += plain; }
    }
    return out;
}

class KickParser {
public:
    KickParser(const Setting& setting, const model::Actuator& family) : setting_(setting), family_(family) {}

    [[nodiscard]] Kick parse() const {
        const std::string text = with_single_blanks(setting_.value);
        std::string_view what;
        std::string_view when;
        if (!split_at(text, "at cycle", what, when)) { throw trouble("it does not say 'at cycle N'"); }
        Kick kick;
        kick.at = cycles(when, "the cycle", true);
        const std::string_view word = what.substr(0, what.find(' '));
        const std::string_view rest = trimmed(what.substr(word.size()));
        if (word == "velocity") {
            kick.velocity = velocity(rest);
        } else if (word == family_.drive_word) {
            kick.kind = Kick::Kind::drive;
            read_drive(rest, kick);
        } else {
            throw trouble("'" + std::string(word) + "' is not a kind of kick here");
        }
        return kick;
    }

private:
    [[nodiscard]] ProblemError trouble(const std::string& why) const { return bad_kick(setting_, family_, why); }

    [[nodiscard]] double cycles(std::string_view text, const std::string& what, bool zero_allowed) const {
        const auto value = model::whole_number_text(text);
        if (!(value && (*value > 0.0 || (zero_allowed && *value == 0.0)))) {
            throw trouble(what + " is '" + std::string(text) + "', which must be a number " +
                          (zero_allowed ? "of at least 0" : "above 0"));
        }
        return *value;
    }

    [[nodiscard]] double velocity(std::string_view text) const {
        try {
            return family_.nondimensional ? model::parse_plain_number(text) : model::parse_quantity(text, "m/s");
        } catch (const std::invalid_argument& error) { throw trouble(std::string("velocity: ") + error.what()); }
    }

    void read_drive(std::string_view text, Kick& kick) const {
        std::string_view share;
        std::string_view duration;
        if (!split_at(text, "for", share, duration)) { throw trouble("it does not say 'for N cycles'"); }
        for (const std::string_view unit : {" cycles", " cycle"}) {
            if (duration.ends_with(unit)) {
                duration = trimmed(duration.substr(0, duration.size() - unit.size()));
                break;
            }
        }
        kick.duration = cycles(duration, "the number of cycles", false);
        try {
            kick.share = model::parse_quantity(share, "1");
        } catch (const std::invalid_argument& error) { throw trouble(std::string("share: ") + error.what()); }
        if (!(kick.share >= 0.0 && kick.share <= largest_share)) {
            throw trouble("the share is " + model::number_text(kick.share) + ", which must be at least 0, at most " +
                          model::number_text(largest_share));
        }
    }

    const Setting& setting_;
    const model::Actuator& family_;
};

void read_start(const Setting& setting, const model::Actuator& family, study::SimulateStudy& study) {
    const std::string_view text = trimmed(setting.value);
    if (text == "rest" || text == "orbit") {
        study.from = text == "rest" ? SimulationStart::rest : SimulationStart::orbit;
        return;
    }
    const bool is_word =
        !text.empty() && std::string_view("+-.0123456789").find(text.front()) == std::string_view::npos;
    if (is_word || text.empty()) {
        throw bad_value(setting, "must be rest, orbit or " + std::to_string(states_of(family)) + " numbers");
    }
    study.start = parse_state(setting, states_of(family));
    study.from = SimulationStart::state;
}

bool takes_rad_per_second(const model::Actuator& actuator) {
    return std::any_of(actuator.frequencies.begin(), actuator.frequencies.end(),
                       [](model::Key key) { return model::key_info(key).unit == "rad/s"; });
}

/// An angular frequency: omega of a nondimensional problem, else in Hz, or for spring-mass problems also in rad/s.
double parse_frequency(const Setting& setting, const model::Actuator& family) {
    double value = 0.0;
    try {
        if (family.nondimensional) {
            value = model::parse_plain_number(setting.value);
        } else if (takes_rad_per_second(family) && setting.value.find("rad") != std::string::npos) {
            value = model::parse_quantity(setting.value, "rad/s");
        } else {
            value = 2.0 * std::numbers::pi * model::parse_quantity(setting.value, "Hz");
        }
    } catch (const std::invalid_argument& error) { throw bad_value(setting, error.what()); }
    if (!(value > 0.0)) { throw bad_value(setting, "must be above 0"); }
    return value;
}

SweepMode parse_mode(const Setting& setting) {
    const std::array<std::string, 2> modes = {"steps", "chirp"};
    return parse_choice(setting, modes) == "chirp" ? SweepMode::chirp : SweepMode::steps;
}

}  // namespace

void read_simulate(const SettingList& settings, const model::Actuator& family, study::SimulateStudy& study,
                   Troubles& troubles) {
    with(settings, "simulate.start", troubles, [&](const Setting& s) { read_start(s, family, study); });
    with(settings, "simulate.cycles", troubles, [&](const Setting& s) { study.cycles = parse_count(s, 1); });
    with(settings, "simulate.samples", troubles, [&](const Setting& s) { study.samples = parse_count(s, 1, 100000); });
    with(settings, "simulate.kick", troubles, [&](const Setting& s) {
        if (trimmed(s.value) == "none") { return; }
        const Kick kick = KickParser(s, family).parse();
        if (!(kick.end() <= study.cycles)) {
            throw bad_value(s, "it ends at cycle " + model::number_text(kick.end()) +
                                   ", after the series (cycles = " + std::to_string(study.cycles) + ")");
        }
        study.kick = kick;
    });
}

void read_sweep(const SettingList& settings, const model::Actuator& family, study::SweepStudy& study,
                Troubles& troubles) {
    with(settings, "sweep.mode", troubles, [&](const Setting& s) { study.mode = parse_mode(s); });
    with(settings, "sweep.from", troubles, [&](const Setting& s) { study.from = parse_frequency(s, family); });
    with(settings, "sweep.to", troubles, [&](const Setting& s) {
        study.to = parse_frequency(s, family);
        if (study.from && !(*study.from < *study.to)) { throw bad_value(s, "must be above sweep.from"); }
    });
    with(settings, "sweep.steps", troubles, [&](const Setting& s) { study.steps = parse_count(s, 1, 1'000'000); });
    with(settings, "sweep.tolerance", troubles,
         [&](const Setting& s) { study.tolerance = parse_between(s, 1e-12, 1e-2); });
    with(settings, "sweep.max_cycles", troubles,
         [&](const Setting& s) { study.max_cycles = parse_count(s, 1, 1'000'000); });
    with(settings, "sweep.longest_period", troubles,
         [&](const Setting& s) { study.longest_period = parse_count(s, 1, longest_sweep_period); });
    with(settings, "sweep.chirp_cycles", troubles,
         [&](const Setting& s) { study.chirp_cycles = parse_count(s, 1, 10'000'000); });
}

std::string kick_text(const Kick& kick, const model::Actuator& family) {
    const std::string at = " at cycle " + model::exact_text(kick.at);
    if (kick.kind == Kick::Kind::velocity) {
        const bool plain = family.nondimensional;
        return "velocity " + model::exact_text(kick.velocity) + (plain ? "" : " m/s") + at;
    }
    return std::string(family.drive_word) + " " + model::exact_text(kick.share) + " for " +
           model::exact_text(kick.duration) + (kick.duration == 1.0 ? " cycle" : " cycles") + at;
}

}  // namespace percuss::io
