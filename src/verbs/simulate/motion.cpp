#include "verbs/simulate/motion.hpp"

#include "design/integrators.hpp"
#include "orbit/polish.hpp"

namespace percuss::verbs {
namespace {

/// Four times what a sweep point has by default: one motion is looked at here, hundreds there. A motion with the
/// largest multiplier 0.99 has forgotten its start to 2e-9 by then.
constexpr int patience = 2000;  // drive cycles
/// Settled points of the sweep of wu2022-nondimensional lie within 1e-7 of their orbits.
constexpr double near_enough = 1e-5;  // of a settled state to its orbit, and of two states of one motion, relative

/// Newton's method from the settled state, nondimensional; changes nothing unless it ends at the motion that was there.
void polish(const flow::System& system, SettledMotion& motion) {
    const orbit::Orbit found = orbit::polish_orbit(system, motion.own_state, motion.period);
    if (!found.ok()) { return; }
    const flow::State exact = orbit::state_at_zero(system, found);
    // Newton may have gone to another orbit; then what was settled on is reported as it is.
    if (orbit::relative_distance(system, exact, motion.own_state) > near_enough) { return; }
    motion.polished = true;
    motion.own_state = exact;
    motion.max_multiplier = orbit::max_multiplier(found);
    motion.remaining_error = found.last_step;
}

}  // namespace

SettledMotion identify_motion(const flow::System& system, const flow::State& start, const model::Scales& scales) {
    SettledMotion motion;
    orbit::SettlingOptions options;
    options.max_cycles = patience;
    const orbit::Settling settling = orbit::settle_until_repeating(system, start, options);
    motion.status = settling.status;
    motion.settled = settling.settled;
    motion.period = settling.settled ? settling.period : 0;
    motion.cycles = settling.cycles;
    motion.strobed_change = settling.change;
    motion.remaining_error = settling.remaining_error;
    motion.own_state = settling.state;
    if (motion.status != flow::Status::ok) { return motion; }
    if (motion.settled) { polish(system, motion); }

    // A motion that has not settled has no period to be observed over.
    const int watched = motion.settled ? motion.period : options.longest_period;
    const orbit::Extremes extremes = orbit::observe_cycles(system, motion.own_state, watched);
    motion.status = extremes.status;
    if (extremes.status != flow::Status::ok) { return motion; }
    motion.contacts = extremes.contacts;
    motion.amplitude = scales.length * extremes.amplitude();
    motion.x_max = scales.length * extremes.x_max;
    motion.x_min = scales.length * extremes.x_min;
    motion.peak_force = scales.force * extremes.peak_force;
    motion.state = design::to_user(motion.own_state, scales, system.states());
    return motion;
}

bool same_motion(const flow::System& system, const SettledMotion& a, const SettledMotion& b) {
    if (!a.settled || !b.settled || a.period != b.period) { return false; }
    // A motion of period n has n states at phase 0, and either motion may be told by any of them.
    flow::State state = a.own_state;
    for (int cycle = 0; cycle < a.period; ++cycle) {
        if (orbit::relative_distance(system, state, b.own_state) < near_enough) { return true; }
        const orbit::Extremes next = orbit::observe_cycles(system, state, 1);
        if (next.status != flow::Status::ok) { return false; }
        state = next.state;
    }
    return false;
}

}  // namespace percuss::verbs
