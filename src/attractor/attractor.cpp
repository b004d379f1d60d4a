#include "attractor/attractor.hpp"

#include "orbit/polish.hpp"

#include <cmath>

namespace percuss::attractor {
namespace {

/// On a torus the tangent vector neither grows nor shrinks in the long run: the sum of its logarithms stays within what
/// it changes by in one turn.
/// A chaotic motion of exponent L adds 4096 L over the default run: 6 is passed from 1.5e-3 per cycle on.
constexpr double bounded_swing = 6.0;
/// A wider error of the exponent, per cycle, leaves room for chaos: undecided rather than quasi-periodic.
constexpr double sharp_error = 1e-2;

}  // namespace

std::string_view to_string(Kind kind) {
    switch (kind) {
        case Kind::undecided: return "undecided";
        case Kind::periodic: return "periodic";
        case Kind::chaotic: return "chaotic";
        case Kind::quasi_periodic: return "quasi-periodic";
    }
    return "unknown";
}

Attractor measure(const flow::System& exact, const orbit::Orbit& orbit) {
    Attractor motion;
    motion.kind = Kind::periodic;
    motion.period = orbit.map.period;
    motion.orbit = orbit;
    motion.state = orbit::state_at_zero(exact, orbit);
    const orbit::Image image = orbit::apply(exact, orbit.map, orbit.state, orbit::Differentiate::nothing, {},
                                            flow::observe_extrema | flow::observe_force);
    motion.peak_force = image.observed[orbit::peak_force].value;
    motion.x_max = image.observed[orbit::x_max].value;
    motion.x_min = image.observed[orbit::x_min].value;
    motion.contacts = static_cast<int>(orbit.contacts.size());
    motion.contacts_per_cycle = static_cast<double>(motion.contacts) / motion.period;
    motion.multipliers = orbit::multipliers(orbit);
    motion.exponent = {std::log(std::abs(motion.multipliers[0])) / motion.period, 0.0};
    return motion;
}

std::optional<Attractor> measure(const Wander& wander) {
    const Exponent& exponent = wander.exponent;
    if (wander.status != WanderStatus::ok || exponent.negative()) { return std::nullopt; }
    Attractor motion;
    const bool bounded = exponent.error < sharp_error && wander.swing < bounded_swing;
    motion.kind = exponent.positive() ? Kind::chaotic : bounded ? Kind::quasi_periodic : Kind::undecided;
    motion.state = wander.state;
    motion.peak_force = wander.peak_force;
    motion.x_max = wander.x_max;
    motion.x_min = wander.x_min;
    motion.contacts_per_cycle = wander.contacts_per_cycle;
    motion.exponent = exponent;
    return motion;
}

}  // namespace percuss::attractor
