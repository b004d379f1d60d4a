#include "verbs/simulate/kick.hpp"

#include "model/number_text.hpp"
#include "model/units.hpp"

namespace percuss::verbs {

namespace {

using model::trimmed;
using problem::bad_value;
using problem::ProblemError;
using problem::Setting;

constexpr double largest_share = 10.0;

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
    // The last place: the text before it may hold the word too.
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
        // out.back() is safe: trimmed text begins with no blank.
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

}  // namespace

Kick parse_kick(const Setting& setting, const model::Actuator& family) { return KickParser(setting, family).parse(); }

std::string kick_text(const Kick& kick, const model::Actuator& family) {
    const std::string at = " at cycle " + model::exact_text(kick.at);
    if (kick.kind == Kick::Kind::velocity) {
        const bool plain = family.nondimensional;
        return "velocity " + model::exact_text(kick.velocity) + (plain ? "" : " m/s") + at;
    }
    return std::string(family.drive_word) + " " + model::exact_text(kick.share) + " for " +
           model::exact_text(kick.duration) + (kick.duration == 1.0 ? " cycle" : " cycles") + at;
}

}  // namespace percuss::verbs
