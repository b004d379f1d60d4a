#include "branch/point.hpp"

#include "orbit/polish.hpp"

#include <cmath>

namespace percuss::branch {
namespace {

/// How near 1 the determinant must be. Rounding and the integrator leave less (an undamped Duffing oscillator shows
/// 1e-15); a damping ratio of 1e-8 leaves more. With less damping than that multipliers do not tell.
constexpr double neutral_accuracy = 1e-7;

/// Counts the multipliers beyond the unit circle, a complex pair once.
void count_unstable(Point& point) {
    for (const auto& mu : point.map_multipliers) {
        if (!(std::abs(mu) > 1.0)) { continue; }
        const bool real = std::abs(mu.imag()) <= 1e-10 * std::abs(mu);
        if (!real) {
            point.pairs_beyond += mu.imag() > 0.0 ? 1 : 0;
        } else if (mu.real() > 0.0) {
            ++point.beyond_plus;
        } else {
            ++point.beyond_minus;
        }
    }
}

/// Contacts that the hybrid flow meets in a period from the point's state; none where it fails.
std::vector<flow::Contact> contacts_met(const flow::System& system, const Point& point) {
    flow::Request request;
    request.state = point.state;
    request.theta = point.phase;
    orbit::ReturnMap map;
    map.period = point.motion.period;
    request.duration = map.duration();
    flow::Result result;
    system.run(request, result);
    if (result.status != flow::Status::ok) { return {}; }
    return result.contacts;
}

}  // namespace

Look look(const flow::ParameterFamily& family, const orbit::Motion& motion, double parameter) {
    Look result;
    const flow::System system = family.at(parameter);
    auto strobed = orbit::strobe(system, motion);
    if (!strobed) { return result; }
    Point& point = result.point;
    point.parameter = parameter;
    point.omega = system.omega();
    point.motion = motion;
    point.state = strobed->state;
    point.phase = strobed->map.phase;
    orbit::Image image = orbit::apply(system, strobed->map, strobed->state, orbit::Differentiate::state, {},
                                      flow::observe_extrema | flow::observe_force);
    if (!image.ok()) { return result; }
    point.x_max = image.observed[orbit::x_max].value;
    point.x_min = image.observed[orbit::x_min].value;
    point.peak_force = image.observed[orbit::peak_force].value;
    point.contacts = std::move(image.contacts);
    // Half a cycle was followed: the other half is its mirror image, and reaches as far the other way.
    if (motion.mirrored) {
        const double centre = system.integrator->centre(system.parameters);
        const double size = std::max(point.x_max - centre, centre - point.x_min);
        point.x_max = centre + size;
        point.x_min = centre - size;
    }
    // Followed without the stop it met none. That there is one to be met is known from how far it goes.
    if (motion.form == orbit::Form::free && point.x_max >= system.stop_position()) {
        point.contacts = contacts_met(system, point);
    }
    strobed->monodromy = image.derivative;
    point.multipliers = orbit::multipliers(*strobed);
    point.map_multipliers = point.multipliers;
    if (motion.mirrored) { point.map_multipliers = strobed->monodromy.eigenvalues(); }
    count_unstable(point);
    point.neutral = std::abs(std::abs(strobed->monodromy.determinant()) - 1.0) < neutral_accuracy;
    // The points are solved to 1e-7. A contact that the sequence has and the flow does not meet, or the other way
    // round, throws the end off by the order of its speed.
    const numerics::SmallVector y = orbit::to_vector(system, strobed->state);
    const double gap = (orbit::to_vector(system, image.state) - y).norm();
    result.status = gap <= 1e-6 * (1.0 + y.norm()) ? Look::Status::ok : Look::Status::not_closed;
    return result;
}

bool same_motion(const Point& a, const Point& b, double size) {
    // Both are solved to 1e-7. Multipliers are compared a hundred times more loosely: beside grazing they move by far
    // more than the motion (for the paper's defaults from 0.885 to 12 while the frequency moves by 6e-9).
    const auto near = [](double x, double y, double unit) { return std::abs(x - y) <= 1e-6 * unit; };
    return a.contacts.size() == b.contacts.size() && near(a.x_max, b.x_max, size) && near(a.x_min, b.x_min, size) &&
           near(a.peak_force, b.peak_force, 1.0 + a.peak_force) &&
           near(a.max_multiplier(), b.max_multiplier(), 1e2 * (1.0 + a.max_multiplier()));
}

flow::State state_at_zero(const flow::System& system, const Point& point) {
    orbit::Orbit orbit;
    orbit.state = point.state;
    orbit.map.phase = point.phase;
    orbit.map.period = point.motion.period;
    orbit.map.stop = point.motion.form == orbit::Form::free ? flow::StopMode::off : flow::StopMode::hybrid;
    return orbit::state_at_zero(system, orbit);
}

}  // namespace percuss::branch
