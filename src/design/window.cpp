#include "design/window.hpp"

#include "boundary/critical.hpp"
#include "branch/trace.hpp"
#include "design/families.hpp"
#include "design/integrators.hpp"
#include "orbit/polish.hpp"

#include <algorithm>
#include <cmath>

namespace percuss::design {
namespace {

using boundary::Kind;
using model::Key;
using model::Specification;

/// The branch is followed within these multiples of the frequency where the motion was met.
constexpr double range_below = 0.5;
constexpr double range_above = 2.0;
/// As a share of the way from the design where the window was met to the one asked for; steps double after each
/// success.
constexpr double first_step = 0.125;
constexpr double bold_distance = 0.05;  ///< a design so near is tried in one step
/// Shorter steps mean that an end is lost or that both have met.
constexpr double smallest_step = 1.0 / 1024.0;

WindowEnd end_from(const branch::BoundaryPoint& found) {
    return {found.kind, found.point.motion, found.contact, found.angle, found.point.parameter};
}

/// A fold so near a grazing point of the same branch that both are one end: then the grazing point, whose equations
/// stay well scaled when the design moves.
const branch::BoundaryPoint& grazing_beside(const branch::Branch& branch, const branch::BoundaryPoint& found) {
    constexpr double one_end = 1e-5;  // relative; the margin is a thousand times that
    if (found.kind != Kind::fold) { return found; }
    for (const branch::BoundaryPoint& other : branch.boundaries) {
        const double apart = std::abs(other.point.parameter - found.point.parameter);
        if (other.kind == Kind::grazing && apart <= one_end * found.point.parameter) { return other; }
    }
    return found;
}

/// The design at `share` of the way; keys that b does not have stay as in a.
Specification between(const Specification& a, const Specification& b, double share) {
    Specification spec = a;
    for (std::size_t i = 0; i < spec.values.size(); ++i) {
        if (!std::isnan(b.values[i])) { spec.values[i] = a.values[i] + share * (b.values[i] - a.values[i]); }
    }
    return spec;
}

/// The system of a specification, at a frequency of ours in place of its own.
flow::System at_design(const flow::System& system, const Specification& spec, double omega) {
    flow::ParameterVector parameters = model::scale(spec).parameters;
    parameters[static_cast<std::size_t>(system.integrator->info().omega)] = omega;
    return system.with(parameters);
}

/// An end of the window at a design, by Newton from a guess, with d(omega) along the keys at the end's own frequency.
boundary::CriticalPoint solve_end(const flow::System& system, const Specification& spec, const WindowEnd& guess,
                                  std::span<const Key> keys) {
    const flow::System here = at_design(system, spec, guess.omega);
    const flow::ParameterFamily family = frequency_family(here);
    std::vector<flow::ParameterVector> directions;
    const auto omega = static_cast<std::size_t>(system.integrator->info().omega);
    for (const Key key : keys) {
        directions.push_back(model::scale_derivative(spec, key).parameters);
        // The end lies where it lies, wherever the design is driven.
        directions.back()[omega] = 0.0;
    }
    return boundary::solve_critical(family, guess.kind, guess.motion, guess.omega, guess.contact, guess.angle,
                                    motion_size(here), directions);
}

/// Both ends on their way from one design to another, at share `at` of it.
struct Ends {
    double at = 0.0;
    WindowEnd lower;
    WindowEnd upper;
    [[nodiscard]] double width() const { return upper.omega - lower.omega; }
};

/// The end carried on along the line through its last two places.
WindowEnd predict(const flow::System& system, const WindowEnd& before, const WindowEnd& here, double ratio) {
    WindowEnd guess = here;
    const numerics::Vector from = orbit::pack(system, before.motion);
    const numerics::Vector to = orbit::pack(system, here.motion);
    guess.motion = orbit::unpack(system, to + ratio * (to - from), here.motion);
    guess.omega = here.omega + ratio * (here.omega - before.omega);
    guess.angle = here.angle + ratio * (here.angle - before.angle);
    return guess;
}

/// The end solved for from a guess; false when it is lost or jumps.
bool correct(const flow::System& system, const Specification& spec, WindowEnd& end) {
    const auto solved = solve_end(system, spec, end, {});
    // More than 1 % off the prediction is another boundary.
    if (!solved.ok() || std::abs(solved.parameter - end.omega) > 0.01 * end.omega) { return false; }
    for (const auto& contact : solved.motion.sequence.contacts) {
        // Beyond a grazing the equations go on without a motion (negative entry speed). A grazing point itself has
        // speed 0 up to rounding.
        if (contact.speed < -1e-9) { return false; }
    }
    end.motion = solved.motion;
    end.omega = solved.parameter;
    end.angle = solved.angle;
    return true;
}

/// Both ends at the target, predicted from the last two places; false when one is lost or they fall together.
bool carry(const flow::System& system, const Intruder& intruder, const Specification& design, const Ends& before,
           Ends& ends, double target) {
    const Specification spec = between(intruder.design, design, target);
    const double ratio = ends.at > before.at ? (target - ends.at) / (ends.at - before.at) : 0.0;
    Ends next = {target, predict(system, before.lower, ends.lower, ratio),
                 predict(system, before.upper, ends.upper, ratio)};
    if (!correct(system, spec, next.lower) || !correct(system, spec, next.upper)) { return false; }
    // Where the window closes both ends come together, and a longer step could carry one of them past the other or both
    // to the same point.
    if (!(next.width() > 0.5 * ends.width())) { return false; }
    ends = std::move(next);
    return true;
}

}  // namespace

Intruder find_window(const flow::System& system, const Specification& design, const orbit::Orbit& orbit) {
    Intruder intruder;
    intruder.design = design;
    intruder.period = orbit.map.period;
    branch::TraceOptions options;
    options.from = range_below * system.omega();
    options.to = range_above * system.omega();
    options.size = motion_size(system);
    options.max_points = 4000;
    const flow::ParameterFamily family = frequency_family(system);
    const branch::Branch branch =
        branch::trace_both_ways(family, {orbit::motion_of(system, orbit), system.omega(), 1.0, {}}, options);
    if (branch.boundaries.size() < 2) {
        intruder.trouble = "the branch of the motion has no two boundaries: " + branch.end_reason;
        return intruder;
    }
    const auto by_frequency = [](const auto& a, const auto& b) { return a.point.parameter < b.point.parameter; };
    // Stable or not: between its outermost boundaries lies the whole cascade, all of which is to be kept away from.
    const auto [lowest, highest] =
        std::minmax_element(branch.boundaries.begin(), branch.boundaries.end(), by_frequency);
    intruder.lowest = end_from(*lowest);
    intruder.highest = end_from(*highest);
    intruder.lower = end_from(grazing_beside(branch, *lowest));
    intruder.upper = end_from(grazing_beside(branch, *highest));
    const auto beyond_an_end = [&](const branch::Point& p) {
        // Twice the distance at which a grazing point stands in for a fold: no more than that may the branch reach
        // beyond its ends.
        return p.parameter > intruder.upper.omega * (1.0 + 2e-5) || p.parameter < intruder.lower.omega * (1.0 - 2e-5);
    };
    if (!(intruder.lower.omega < system.omega() && system.omega() < intruder.upper.omega)) {
        intruder.trouble = "the window of the motion does not contain the frequency it was met at";
    } else if (std::any_of(branch.points.begin(), branch.points.end(), beyond_an_end)) {
        intruder.trouble = "the branch of the motion does not end in a fold or grazing point on both sides";
    }
    intruder.ok = intruder.trouble.empty();
    return intruder;
}

Intruder find_window(const Evaluator& evaluator, const Specification& design, double omega,
                     const std::vector<Attractor>& attractors, flow::Cost* cost) {
    Intruder intruder;
    intruder.trouble = "the motion that refutes it is not periodic, so it has no window that could be followed";
    const flow::System system = evaluator.system(design, cost).at_omega(omega);
    const model::Scales scales = model::scale(design).scales;
    for (const Attractor& attractor : attractors) {
        if (cost != nullptr && cost->allowance() != flow::Status::ok) { break; }
        if (attractor.period < 1) { continue; }
        const flow::State state = from_user(attractor.state, "attractor", *design.type, scales, system.states());
        const orbit::Orbit polished = orbit::polish_orbit(system, state, attractor.period);
        if (!polished.ok()) {
            intruder.trouble = "the motion that refutes it could not be polished";
            continue;
        }
        intruder = find_window(system, design, polished);
        if (intruder.ok) { return intruder; }
    }
    return intruder;
}

double distance(const Specification& a, const Specification& b) {
    double largest = 0.0;
    for (std::size_t i = 0; i < a.values.size(); ++i) {
        const double sum = std::abs(a.values[i]) + std::abs(b.values[i]);
        if (sum > 0.0) { largest = std::max(largest, 2.0 * std::abs(a.values[i] - b.values[i]) / sum); }
    }
    return largest;
}

WindowAt window_at(const flow::System& system, const Intruder& intruder, const Specification& design,
                   std::span<const Key> keys) {
    WindowAt window;
    Ends ends = {0.0, intruder.lower, intruder.upper};
    Ends before = ends;
    // Small changes of a design, as an optimiser makes them near its end, take one step; large ones begin with an
    // eighth.
    double step = std::clamp(bold_distance / (distance(intruder.design, design) + 1e-12), first_step, 1.0);
    while (ends.at < 1.0) {
        Ends next = ends;
        if (carry(system, intruder, design, before, next, std::min(1.0, ends.at + step))) {
            before = std::move(ends);
            ends = std::move(next);
            step *= 2.0;
            continue;
        }
        step *= 0.5;
        if (step < smallest_step) {
            if (system.cost != nullptr && system.cost->allowance() != flow::Status::ok) { return window; }
            // Both ends meet where the window closes: then there is nothing left to solve for.
            if (ends.width() < 0.5 * (intruder.upper.omega - intruder.lower.omega)) {
                window.status = WindowAt::Status::vanished;
            }
            return window;
        }
    }
    const WindowEnd& lower = ends.lower;
    const WindowEnd& upper = ends.upper;
    const auto exact_lower = solve_end(system, design, lower, keys);
    const auto exact_upper = solve_end(system, design, upper, keys);
    if (!exact_lower.ok() || !exact_upper.ok()) { return window; }
    // Narrower than what the two ends are solved to.
    if (!(exact_upper.parameter - exact_lower.parameter > 1e-9 * exact_upper.parameter)) {
        window.status = WindowAt::Status::vanished;  // both ends are the same point
        return window;
    }
    window.status = WindowAt::Status::found;
    window.lower = exact_lower.parameter;
    window.upper = exact_upper.parameter;
    window.d_lower = exact_lower.d_parameter;
    window.d_upper = exact_upper.d_parameter;
    window.carried = intruder;
    window.carried.design = design;
    window.carried.lower = lower;
    window.carried.upper = upper;
    return window;
}

}  // namespace percuss::design
