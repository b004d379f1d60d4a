#pragma once
/// \file
/// The contact laws of the stop, told once: which phases a motion passes through, which function is watched for a sign
/// change in each of them, and what happens there. The Taylor integrator, its ensemble and the step-by-step backends
/// all follow the table below.
///
/// Watched functions: the gap function x - x_stop, and the stop's force k (x - x_stop) + delta_i x'.

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string_view>

namespace percuss::model {

/// kelvin_voigt: f = k pen + delta_i x' while pen >= 0 (switches on displacement alone, paper eq. (8));
/// no_tension: f = max(0, k pen + delta_i x') while pen >= 0; none: there is no stop.
enum class ContactLaw : std::uint8_t { kelvin_voigt, no_tension, none };

/// Every law, in the order of its enumerators.
inline constexpr std::array contact_laws = {ContactLaw::kelvin_voigt, ContactLaw::no_tension, ContactLaw::none};

/// free: outside the stop; contact: its force acts; slack: inside its zone with no force (no_tension only).
enum class ContactPhase : std::uint8_t { free, contact, slack };

enum class ContactEvent : std::uint8_t { entry, exit, release, reload, leave };

enum class Watched : std::uint8_t { gap, force };

/// One row: in a phase, a watched function that changes sign in a direction is an event, with these consequences.
struct Transition {
    Watched watched = Watched::gap;
    int direction = +1;  ///< sign towards which the function passes zero
    ContactEvent event = ContactEvent::entry;
    ContactPhase next = ContactPhase::free;
    bool on_surface = false;  ///< the state is put on the surface of the stop, x = x_stop
    /// The first watched function of the next phase is zero right after the event: it is divided by the time since
    /// (deflated) when its next sign change is sought.
    bool deflates = false;
    /// Where the mass crosses the surface while a damped force switches on or off there, the sensitivities jump by
    /// S = I + saltation delta_i e_v e_x^T: -1 entry, +1 exit. 0: the force is continuous, S = I.
    int saltation = 0;
};

/// The rows of one phase; `rows` beyond `count` mean nothing.
struct PhaseRows {
    std::array<Transition, 2> rows{};
    std::size_t count = 0;
    [[nodiscard]] constexpr const Transition* begin() const { return rows.data(); }
    [[nodiscard]] constexpr const Transition* end() const { return rows.data() + count; }
};

/// Everything about one law, for a stop with damping or without.
struct ContactRules {
    std::string_view name;           ///< in problem files
    bool has_stop = true;            ///< false: no phase but free, no event
    bool releases_on_force = false;  ///< contact ends when the force has gone to zero; the force is watched at all
    std::array<PhaseRows, 3> phases{};

    [[nodiscard]] constexpr const PhaseRows& from(ContactPhase phase) const {
        return phases[static_cast<std::size_t>(phase)];
    }
    /// The row by which contact begins; only for laws with a stop.
    [[nodiscard]] constexpr const Transition& entry() const { return from(ContactPhase::free).rows[0]; }
    /// The phase of a motion that starts with this gap function and stop force. On the surface it is still free.
    [[nodiscard]] constexpr ContactPhase first_phase(double gap, double force) const {
        if (!has_stop || !(gap > 0.0)) { return ContactPhase::free; }
        return releases_on_force && force < 0.0 ? ContactPhase::slack : ContactPhase::contact;
    }
    /// Direction in which the rows of a phase watch a function; -1 where they do not (a bound on the function in that
    /// direction is then merely not needed).
    [[nodiscard]] constexpr int direction(ContactPhase phase, Watched watched) const {
        for (const Transition& row : from(phase)) {
            if (row.watched == watched) { return row.direction; }
        }
        return -1;
    }
};

namespace contact_table {

using enum ContactEvent;
using enum Watched;
using Phase = ContactPhase;

//                                          watched direction event    next   on_surface deflates saltation
inline constexpr Transition stiff_entry = {gap, +1, entry, Phase::contact, true, true, -1};
inline constexpr Transition exit_at_surface = {gap, -1, exit, Phase::free, true, true, +1};
/// The force of a damped stop begins with delta_i x' > 0: the watched force is not zero at entry.
inline constexpr Transition damped_entry = {gap, +1, entry, Phase::contact, true, false, -1};
inline constexpr Transition release_inside = {force, -1, release, Phase::slack, false, false, 0};
/// Without damping the force vanishes on the surface and with the gap: there is no slack phase.
inline constexpr Transition undamped_release = {force, -1, release, Phase::free, true, true, 0};
inline constexpr Transition leave_zone = {gap, -1, leave, Phase::free, true, true, 0};
inline constexpr Transition load_again = {force, +1, reload, Phase::contact, false, false, 0};

constexpr PhaseRows one(const Transition& a) { return {{a, {}}, 1}; }
constexpr PhaseRows two(const Transition& a, const Transition& b) { return {{a, b}, 2}; }

/// By law (in the order of its enumerators), then damped and undamped; the phases are free, contact, slack. Where two
/// rows may come at the same time the first one counts.
inline constexpr std::array<std::array<ContactRules, 2>, contact_laws.size()> rules = {{
    {{{"kelvin-voigt", true, false, {one(stiff_entry), one(exit_at_surface), {}}},
      {"kelvin-voigt", true, false, {one(stiff_entry), one(exit_at_surface), {}}}}},
    {{{"no-tension", true, true, {one(damped_entry), one(release_inside), two(leave_zone, load_again)}},
      {"no-tension", true, true, {one(stiff_entry), one(undamped_release), two(leave_zone, load_again)}}}},
    {{{"none", false, false, {}}, {"none", false, false, {}}}},
}};

}  // namespace contact_table

/// The rules of a law for a stop with damping delta_i. Not inline, so that kernels compiled for several instruction
/// sets share one table.
const ContactRules& contact_rules(ContactLaw law, bool damped = true);

constexpr bool has_stop(ContactLaw law) { return contact_table::rules[static_cast<std::size_t>(law)][0].has_stop; }
constexpr std::string_view to_string(ContactLaw law) {
    return contact_table::rules[static_cast<std::size_t>(law)][0].name;
}

/// The law of this name in problem files, or nothing.
constexpr std::optional<ContactLaw> find_contact_law(std::string_view name) {
    for (std::size_t i = 0; i < contact_table::rules.size(); ++i) {
        if (contact_table::rules[i][0].name == name) { return static_cast<ContactLaw>(i); }
    }
    return std::nullopt;
}

}  // namespace percuss::model
