#include "design/uniqueness.hpp"

#include "boundary/free_branch.hpp"
#include "design/integrators.hpp"
#include "orbit/polish.hpp"

#include <algorithm>
#include <cmath>

namespace percuss::design {
namespace {

/// States nearer than this, nondimensional, are of the same orbit.
/// Orbits come out of Newton's method to 1e-9 or better.
constexpr double same_orbit = 1e-6;

/// Half the stroke of a free motion; NaN where it cannot be followed.
double free_amplitude(const flow::System& system, const boundary::FreePoint& p) {
    // By symmetry the largest displacement from the centre is half the stroke, and the clearance is what it leaves of
    // the gap.
    if (system.symmetric()) {
        return p.clearance + system.stop_position() - system.integrator->centre(system.parameters);
    }
    const orbit::Image image = orbit::apply(system, boundary::FreeBranch::map_of(system), p.state,
                                            orbit::Differentiate::nothing, {}, flow::observe_extrema);
    if (!image.ok()) { return absent; }
    return 0.5 * (image.observed[orbit::x_max].value - image.observed[orbit::x_min].value);
}

Attractor free_attractor(const UniquenessCase& c, const boundary::FreePoint& p) {
    Attractor other;
    other.period = 1;
    other.state = to_user(p.state, c.scales, c.system.states());
    other.peak_force = 0.0;
    other.amplitude = c.scales.length * free_amplitude(c.system, p);
    // Of a symmetric motion the radius belongs to the half-cycle map.
    other.max_multiplier = c.system.symmetric() ? p.radius * p.radius : p.radius;
    return other;
}

/// In the units of the problem; `at_zero` is the state of `found` at theta = 0.
Attractor struck_attractor(const UniquenessCase& c, const orbit::Orbit& found, const flow::State& at_zero) {
    const orbit::Image image = orbit::apply(c.system, found.map, found.state, orbit::Differentiate::nothing, {},
                                            flow::observe_extrema | flow::observe_force);
    Attractor other;
    other.period = 1;
    other.state = to_user(at_zero, c.scales, c.system.states());
    other.peak_force = c.scales.force * image.observed[orbit::peak_force].value;
    other.amplitude = 0.5 * c.scales.length * (image.observed[orbit::x_max].value - image.observed[orbit::x_min].value);
    other.max_multiplier = orbit::max_multiplier(found);
    return other;
}

/// From rest; from the stop at speed; from far behind.
flow::State start_state(const flow::System& system, int i) {
    flow::State start = system.integrator->rest_state(system.parameters);
    const double gap = system.stop_position() - start[0];
    if (i == 1) {
        start[0] += 0.9 * gap;
        start[1] = 2.0 * system.omega() * gap;
    } else if (i == 2) {
        start[0] -= 3.0 * gap;
    }
    return start;
}

/// The first stable period-1 orbit other than the tuned one that one of the starts leads to.
std::optional<Attractor> refute_by_starts(const UniquenessCase& c, int count) {
    const flow::State here = orbit::state_at_zero(c.system, c.orbit);
    for (int i = 0; i < count; ++i) {
        const auto found = stable_orbit_from(c.system, start_state(c.system, i));
        if (!found) { continue; }
        const flow::State there = orbit::state_at_zero(c.system, *found);
        double distance = 0.0;
        for (std::size_t k = 0; k < there.size(); ++k) { distance = std::max(distance, std::abs(there[k] - here[k])); }
        if (distance > same_orbit) { return struck_attractor(c, *found, there); }
    }
    return std::nullopt;
}

}  // namespace

TierOne check_tier_one(const UniquenessCase& c) {
    using FoldStatus = boundary::GrazingFold::Status;
    TierOne result;
    Uniqueness& u = result.uniqueness;
    u.tier = 1;
    const bool located =
        c.fold != nullptr && (c.fold->status == FoldStatus::found || c.fold->status == FoldStatus::at_once);
    for (const boundary::FreePoint& p : c.free_orbits.points) {
        if (p.clearance < 0.0 && p.stable()) { u.attractors.push_back(free_attractor(c, p)); }
    }
    if (u.attractors.empty()) {
        // Where no fold is located less is known of the impacting branches, and two more starts are tried:
        // problems/soft-impact.ini with cubic 0.1, force 3 has two impacting orbits and passed for unique before there
        // were starts.
        u.starts = located ? 1 : 3;
        if (const auto other = refute_by_starts(c, static_cast<int>(u.starts))) { u.attractors.push_back(*other); }
    }

    if (!u.attractors.empty()) {
        const bool clear = u.attractors.front().peak_force == 0.0;
        result.rejection = clear ? "a stable motion clear of the stop coexists at the operating frequency"
                                 : "another stable motion that strikes coexists at the operating frequency";
    } else if (located && !(c.fold_offset <= c.margin)) {
        // Between the fold and the edge the free motion goes on as a stable one of slow impacts, beside the tuned
        // orbit.
        result.rejection = "the fold beside the edge lies further below it than the margin";
    }
    if (!result.rejection.empty()) {
        u.verdict = Verdict::not_unique;
        u.checked = "tier 1: " + result.rejection;
    } else if (c.fold != nullptr && c.fold->status == FoldStatus::failed) {
        u.checked = "tier 1: the fold beside the edge could not be located";
    } else if (!c.free_orbits.complete) {
        u.checked = "tier 1: the free motion could not be followed below the operating frequency";
    } else {
        u.verdict = Verdict::unique;
        u.checked = located
                      ? "tier 1: alone among the period-1 motions found (the free motion followed past the operating "
                        "frequency, the fold beside the edge within the margin, the start from rest leads here); "
                        "longer periods not searched"
                      : "tier 1: alone among the period-1 motions found (the free motion followed past the operating "
                        "frequency, three starts lead here, no fold located); longer periods not searched";
    }
    return result;
}

}  // namespace percuss::design
