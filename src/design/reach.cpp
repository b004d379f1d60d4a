#include "design/reach.hpp"

#include "attractor/box.hpp"
#include "attractor/trap.hpp"
#include "orbit/polish.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <random>
#include <string>
#include <utility>

namespace percuss::design {
namespace {

using orbit::Orbit;

std::size_t index(int i) { return static_cast<std::size_t>(i); }

/// An orbit that was found, and strikes where it must.
bool counts(const Orbit& orbit, bool must_strike) { return orbit.ok() && !(must_strike && orbit.contacts.empty()); }

/// Random starts tried for an orbit of a longer period than the motion from rest has.
constexpr int most_starts = 200;
/// Cycles that such a start is followed for before Newton's method is tried.
constexpr int cycles_per_start = 150;
/// Half the size of the box of starts where the stop leaves less room, nondimensional.
constexpr double smallest_size = 0.05;

/// A state about rest: from two gaps behind it up to the stop, at speeds up to twice that of a motion of the size
/// of the gap, internal states near rest.
flow::State random_start(const flow::System& system, double gap, std::mt19937_64& generator) {
    const auto uniform = [&](double low, double high) {
        // 53 bits by hand: standard distributions differ between libraries, and the same problem must give the same
        // digits.
        return low + (high - low) * static_cast<double>(generator() >> 11U) * 0x1.0p-53;
    };
    const double size = std::max(gap, smallest_size);
    flow::State y = system.integrator->rest_state(system.parameters);
    y[0] += uniform(-2.0 * size, gap);
    y[1] = uniform(-2.0, 2.0) * system.omega() * size;
    for (int k = 2; k < system.states(); ++k) { y[index(k)] *= uniform(0.97, 1.03); }
    return y;
}

/// Drive cycles, per cycle of the period sought, after which a motion that no orbit has captured counts as not settled.
/// A multiplier of 0.998 needs some 3,500 to come from order one to the 1e-3 at which a typical trap begins.
constexpr int patience = 4096;
/// Cycles before the first try of Newton's method; each further try comes after twice as many, so that the tries never
/// cost more than the following.
constexpr int first_try = 8;
/// Where no trap could be set up (an orbit beside a contact that is about to graze) the motion must have come this near
/// in units of the trap, which is all that double precision leaves of a transient.
constexpr double all_but_there = 1e-9;

/// A stable orbit that Newton's method proposes, and the neighbourhood that motions contract in.
struct Proposal {
    Orbit orbit;
    attractor::Trap trap;

    Proposal(const flow::System& system, Orbit found)
        : orbit(std::move(found)),
          trap(system, orbit, unit_of_distance(system, orbit)) {}

    /// As an ensemble around this motion would measure it.
    static flow::State unit_of_distance(const flow::System& system, const Orbit& orbit) {
        const orbit::Image image =
            orbit::apply(system, orbit.map, orbit.state, orbit::Differentiate::nothing, {}, flow::observe_extrema);
        const double amplitude =
            image.ok() ? 0.5 * (image.observed[orbit::x_max].value - image.observed[orbit::x_min].value) : 0.0;
        flow::State ones;
        ones.fill(1.0);
        if (!(amplitude > 0.0)) { return ones; }
        return attractor::distance_scale(system, attractor::ensemble_box(system, amplitude));
    }
};

/// The motion itself, followed cycle by cycle until the trap of a stable orbit has captured it. Newton's method only
/// proposes: from an early transient it may jump to an orbit that the motion never comes to (4 of 59 random motions on
/// springs with soft stops did).
class Following {
public:
    Following(const flow::System& system, const flow::State& from, int period)
        : system_(system),
          state_(from),
          period_(period) {}

    Reached run() {
        int next_try = first_try * period_;
        for (int cycle = 1; cycle <= patience * period_; ++cycle) {
            const auto next = orbit::settle(system_, state_, 1);
            if (!next) { return lost(); }
            state_ = *next;
            // Asked every cycle: between two tries of Newton's method the motion may come to the orbit proposed before.
            if (is_captured()) { return captured(); }
            if (cycle == next_try) {
                propose();
                next_try *= 2;
            }
        }
        return not_settled();
    }

private:
    [[nodiscard]] bool is_captured() {
        if (!proposal_) { return false; }
        const std::array<const attractor::Trap*, 1> traps = {&proposal_->trap};
        return watch_.see(state_, traps).has_value() || proposal_->trap.distance(state_) < all_but_there;
    }

    void propose() {
        Orbit found = orbit::polish_orbit(system_, state_, period_);
        if (!found.ok()) { return; }
        if (!(orbit::max_multiplier(found) < 1.0)) {
            unstable_ = std::move(found);
            return;
        }
        // The same orbit proposed again keeps its trap and what the watch has seen; 1e-6 of its scale is above what
        // Newton's method leaves.
        const bool known = proposal_ && proposal_->trap.distance(orbit::state_at_zero(system_, found)) < 1e-6;
        if (known) { return; }
        proposal_.emplace(system_, std::move(found));
        watch_ = {};
    }

    [[nodiscard]] Reached captured() const {
        Reached reached;
        reached.kind = Reached::Kind::stable;
        reached.orbit = proposal_->orbit;
        return reached;
    }
    [[nodiscard]] static Reached lost() {
        Reached reached;
        reached.kind = Reached::Kind::failed;
        reached.reason = "the motion could not be followed (too many contacts or divergence)";
        return reached;
    }
    [[nodiscard]] Reached not_settled() const {
        Reached reached;
        reached.kind = Reached::Kind::unsettled;
        const std::string of_period = " of period " + std::to_string(period_);
        reached.reason = "no orbit" + of_period + " was reached";
        if (proposal_) {
            reached.reason = "the motion from rest has not contracted to an orbit" + of_period + " within " +
                             std::to_string(patience * period_) + " drive cycles";
        } else if (unstable_) {
            reached.kind = Reached::Kind::unstable;
            reached.orbit = *unstable_;
            reached.reason = "the orbit" + of_period + " is unstable";
        }
        return reached;
    }

    const flow::System& system_;
    flow::State state_;
    int period_;
    std::optional<Proposal> proposal_;
    std::optional<Orbit> unstable_;
    attractor::Watch watch_;
};

}  // namespace

Reached reach_orbit(const flow::System& system, const flow::State& from, int period, bool must_strike) {
    Reached reached;
    reached.kind = Reached::Kind::unsettled;
    reached.reason = "no orbit of period " + std::to_string(period) + " was reached";
    flow::State state = from;
    // Doubling: a try of Newton's method costs a few cycles, so it never costs more than the following does, and a
    // motion that settles early is caught early. Newton's method may land on an orbit that the motion only passes by:
    // that is kept as an answer only if it is stable, else the motion is followed on. 256 twice at the end: what has
    // not settled after some 760 periods is called unsettled.
    for (int cycles : {8, 16, 32, 64, 128, 256, 256}) {
        const auto settled = orbit::settle(system, state, cycles * period);
        if (!settled) {
            reached.kind = Reached::Kind::failed;
            reached.reason = "the motion could not be followed (too many contacts or divergence)";
            return reached;
        }
        state = *settled;
        const Orbit found = orbit::polish_orbit(system, state, period);
        if (found.ok() && found.contacts.empty() && orbit::max_multiplier(found) < 1.0) {
            reached.settled_clear = true;
        }
        if (!counts(found, must_strike)) { continue; }
        const bool stable = orbit::max_multiplier(found) < 1.0;
        if (stable || reached.kind != Reached::Kind::unstable) { reached.orbit = found; }
        reached.kind = stable ? Reached::Kind::stable : Reached::Kind::unstable;
        if (stable) {
            reached.reason.clear();
            return reached;
        }
        reached.reason = "the orbit of period " + std::to_string(period) + " is unstable";
    }
    return reached;
}

Reached reach_from_rest(const flow::System& system, int period) {
    Reached reached = Following(system, system.integrator->rest_state(system.parameters), period).run();
    const auto fits = [&](const Reached& r) {
        return r.kind == Reached::Kind::stable && orbit::minimal_period(system, r.orbit) == period;
    };
    // Whatever contracts to a map of one cycle has period 1. For more cycles the orbit from rest may be of a divisor:
    // then other starts are tried.
    if (period == 1 || fits(reached)) { return reached; }
    std::mt19937_64 generator(1);
    const double gap = std::abs(system.stop_position() - system.integrator->rest_state(system.parameters)[0]);
    for (int attempt = 0; attempt < most_starts; ++attempt) {
        const auto settled = orbit::settle(system, random_start(system, gap, generator), cycles_per_start);
        if (!settled) { continue; }
        Reached candidate = reach_by_newton(system, *settled, period);
        if (fits(candidate)) { return candidate; }
    }
    reached = Reached{};  // what was reached instead is not an answer
    reached.kind = Reached::Kind::unsettled;
    reached.reason = "no stable orbit of period " + std::to_string(period) + " was found from " +
                     std::to_string(most_starts) + " starts";
    return reached;
}

Reached reach_by_newton(const flow::System& system, const flow::State& from, int period) {
    Reached reached;
    reached.orbit = orbit::polish_orbit(system, from, period);
    if (!reached.orbit.ok()) {
        reached.kind = Reached::Kind::unsettled;
        reached.reason = "Newton's method from orbit.start did not converge";
        return reached;
    }
    reached.kind = orbit::max_multiplier(reached.orbit) < 1.0 ? Reached::Kind::stable : Reached::Kind::unstable;
    if (reached.kind == Reached::Kind::unstable) { reached.reason = "the orbit is unstable"; }
    return reached;
}

std::optional<Orbit> stable_orbit_from(const flow::System& system, const flow::State& from) {
    // This many cycles bring the motion within the reach of Newton's method, whose orbit must be stable but need not be
    // the one the start would have led to in the end: any other stable orbit refutes as well.
    constexpr int cycles = 48;
    const auto settled = orbit::settle(system, from, cycles);
    if (!settled) { return std::nullopt; }
    const Orbit found = orbit::polish_orbit(system, *settled, 1);
    if (!found.ok() || !(orbit::max_multiplier(found) < 1.0)) { return std::nullopt; }
    return found;
}

std::optional<Orbit> continue_orbit(const flow::System& system, const Orbit& start, double to_omega) {
    // Steps this small next to the whole frequency mean a fold or grazing point in between: the orbit ends there.
    constexpr double smallest_step = 1e-7;
    Orbit current = start;
    double omega = system.omega();
    double step = to_omega - omega;
    const double smallest = smallest_step * std::abs(to_omega);
    while (omega != to_omega) {
        const double target = std::abs(to_omega - omega) <= std::abs(step) ? to_omega : omega + step;
        const Orbit next = orbit::find_orbit(system.at_omega(target), current.map, current.state);
        // Newton's method may land on another orbit; one with other contacts cannot be the same without a grazing in
        // between.
        const bool same = next.ok() && next.contacts.size() == current.contacts.size();
        if (same) {
            current = next;
            omega = target;
        } else {
            step *= 0.5;
            if (std::abs(step) < smallest) { return std::nullopt; }
        }
    }
    return current;
}

}  // namespace percuss::design
