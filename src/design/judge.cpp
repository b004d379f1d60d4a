#include "design/judge.hpp"

#include "design/sampled_check.hpp"
#include "design/uniqueness.hpp"

#include <utility>

namespace percuss::design {
namespace {

/// Half the stroke, nondimensional.
double amplitude_of(const flow::System& system, const orbit::Orbit& orbit) {
    const orbit::Image image =
        orbit::apply(system, orbit.map, orbit.state, orbit::Differentiate::nothing, {}, flow::observe_extrema);
    return 0.5 * (image.observed[orbit::x_max].value - image.observed[orbit::x_min].value);
}

}  // namespace

Judgement judge(const JudgedCase& c) {
    const Operation& operation = c.operation;
    const boundary::FreeOrbitsAt free = free_orbits_at(operation);
    TierOne first =
        check_tier_one({operation.system, c.scales, c.orbit, free, operation.fold ? &*operation.fold : nullptr,
                        operation.point.fold_offset, c.problem.margin});
    // The cheap check first: where it refutes, no start is needed.
    const bool by_starts = c.problem.single_stable > SingleStable::orbit;
    if (!by_starts || first.uniqueness.verdict == Verdict::not_unique) {
        return {std::move(first.uniqueness), std::move(first.rejection)};
    }
    TierTwo second = check_tier_two({operation.system, operation.scout, c.scales, c.orbit,
                                     amplitude_of(operation.system, c.orbit), c.problem.sampling});
    second.uniqueness.checked += "; " + first.uniqueness.checked;
    return {std::move(second.uniqueness), std::move(second.rejection)};
}

}  // namespace percuss::design
