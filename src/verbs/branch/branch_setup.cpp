#include "verbs/branch/branch_setup.hpp"

#include "design/families.hpp"
#include "design/operating_point.hpp"
#include "design/reach.hpp"
#include "orbit/polish.hpp"
#include "verbs/limits.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>

namespace percuss::verbs {
namespace {

using model::Key;

/// Default range in units of the linear resonance: the resonance of a motion that bounces on a stiff stop lies below
/// twice that of the free one.
constexpr double default_from = 3.0;
constexpr double default_to = 0.6;

double unit_in_user(Key key, const model::Scales& scales) { return model::per_radian(key) / scales.time; }

}  // namespace

BranchSetup::BranchSetup(const StudyProblem& p, const BranchOptions& study, const numerics::CancelRequest& cancelled)
    : problem(p),
      integrators(design::make_integrators(p.design)),
      specification(p.design.actuator),
      cost(limited_cost(cancelled)) {
    model::validate(specification);
    const model::Scaled scaled = model::scale(specification);
    scales = scaled.scales;
    system = {integrators.own.get(), scaled.parameters, &cost};
    omega_index = static_cast<std::size_t>(system.integrator->info().omega);
    const double resonance = system.integrator->linear_resonance(system.parameters);
    const Key frequency = model::frequency_key(specification);
    along = study.along.value_or(frequency);
    along_frequency = model::is_frequency(along);
    const bool has_stop = model::has_stop(specification.law);
    if (!model::has_frequency(specification) && !along_frequency) {
        // The frequency of the operating point is held.
        // The edge is sought with the scout first and refined with the integrator of the problem.
        flow::System looser = system;
        looser.integrator = integrators.scout.get();
        design::OperationOptions options;
        options.margin = p.design.margin;
        const design::Operation operation = design::operate({specification, scaled, system, looser}, options);
        if (!operation.found()) {
            throw std::invalid_argument("drive.frequency = edge: this design has no edge to operate at (" +
                                        operation.reason + "); give a frequency to be held");
        }
        specification.set(frequency, from_omega(operation.point.omega));
        system = system.with(model::scale(specification).parameters);
    }
    if (along_frequency) {
        user_from = study.from.value_or(from_omega(default_from * resonance));
        user_to = study.to.value_or(from_omega(default_to * resonance));
        from = to_omega(user_from);
        to = to_omega(user_to);
        system = system.at_omega(from);
        family = design::frequency_family(system);
    } else {
        if (!study.from || !study.to) {
            throw std::invalid_argument("branch.from and branch.to: give the range of " +
                                        std::string(model::key_info(along).name));
        }
        user_from = from = *study.from;
        user_to = to = *study.to;
        family = design::key_family(system, specification, along, std::abs(to - from));
    }
    if (!(std::abs(to - from) > 0.0)) {
        throw std::invalid_argument("branch.from and branch.to are equal: the range is empty");
    }
    scout = system;
    scout.integrator = integrators.scout.get();
    // Without a stop there is no gap to measure motions by; the unit of length is all there is.
    size = has_stop ? design::motion_size(system) : 1.0;
}

double BranchSetup::to_omega(double user) const {
    return user / unit_in_user(model::frequency_key(specification), scales);
}
double BranchSetup::from_omega(double omega) const {
    return omega * unit_in_user(model::frequency_key(specification), scales);
}

std::optional<branch::Departure> BranchSetup::departure() const {
    branch::Departure departure;
    departure.parameter = from;
    if (!along_frequency) {
        // In a design variable from the problem's own value, the design that the user has; in frequency from the
        // beginning of the range, by default well above the resonance.
        departure.parameter = std::clamp(specification.value(along), std::min(from, to), std::max(from, to));
    }
    departure.direction = to > from ? 1.0 : -1.0;
    const flow::System there = family.at(departure.parameter);
    const flow::State rest = there.integrator->rest_state(there.parameters);
    const design::Reached reached = design::reach_orbit(there, rest, 1, false);
    if (!reached.orbit.ok()) { return std::nullopt; }
    departure.motion = orbit::motion_of(there, reached.orbit);
    // Over half a cycle where the symmetry allows: half the work, and the loss of the symmetry is a multiplier -1 of
    // the half-cycle map, a flip like any other.
    if (departure.motion.form == orbit::Form::free) {
        departure.motion.phase = 0.0;
        departure.motion.state = orbit::state_at_zero(there, reached.orbit);
        departure.motion = orbit::halved_if_symmetric(there, departure.motion);
    }
    return departure;
}

}  // namespace percuss::verbs
