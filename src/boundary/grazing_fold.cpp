#include "boundary/grazing_fold.hpp"

#include "numerics/arclength.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace percuss::boundary {
namespace {

/// (d omega / d v)/v along the impacting branch: finite at grazing, where d omega / d v itself is zero, and zero again
/// at the fold.
struct Probe {
    bool ok = false;
    double speed = 0.0;
    double value = 0.0;
    orbit::SpeedSolution solution;
};

/// The motion of the impacting branch at this entry speed, with its slope.
Probe probe(const flow::System& system, const orbit::ContactSequence& guess, double omega, double speed) {
    Probe p;
    p.speed = speed;
    p.solution = orbit::solve_at_speed(system, guess, omega, speed);
    p.ok = p.solution.ok;
    p.value = p.solution.slope / speed;
    return p;
}

/// Probe at another speed, started from the tangent of one that succeeded.
Probe probe_from(const flow::System& system, const Probe& from, double speed) {
    const orbit::SpeedSolution guess = orbit::predict_at_speed(system, from.solution, speed);
    return probe(system, guess.sequence, guess.omega, speed);
}

/// The impacting branch as a curve in (v, theta, t_c, q..., omega/omega_grazing), for stops so soft that v itself turns
/// back before the frequency does. Sets `fold`: found (to the accuracy of a Hermite cubic between two points), none
/// within reach, or failed.
void follow_by_arclength(const flow::System& system, const Boundary& grazing, const Probe& from, GrazingFold& fold) {
    const int n = system.states() + 1;
    const double unit = grazing.omega;
    const flow::ParameterVector by_omega = orbit::unit_direction(system.integrator->info().omega);
    const auto equations = [&](const numerics::Vector& u, numerics::Vector& f, numerics::Matrix& j) {
        if (!(u[n] > 0.0)) { return false; }
        const auto sequence = orbit::unpack(system, u.head(n), 1);
        const auto r = orbit::evaluate(system.at_omega(u[n] * unit), sequence, {&by_omega, 1});
        if (!r) { return false; }
        f = r->value;
        j.resize(n, n + 1);
        j.leftCols(n) = r->by_unknowns;
        j.col(n) = r->by_directions.col(0) * unit;
        return true;
    };
    numerics::ArclengthWalker walker(equations, {.first_step = 0.01, .largest_step = 0.2, .target_angle = 0.2});
    numerics::Vector u(n + 1);
    u.head(n) = orbit::pack(system, from.solution.sequence);
    u[n] = from.solution.omega / unit;
    if (!walker.start(u, -1.0)) { return; }
    for (int step = 0; step < 200; ++step) {
        const numerics::Vector before = walker.point();
        const double slope_before = walker.tangent()[n];
        if (!walker.advance()) { return; }
        const double slope = walker.tangent()[n];
        if (slope >= 0.0) {
            // omega along the step: s in [0, 1], slopes per step length
            const double length = (walker.point() - before).norm();
            // Where the slope passes through zero, linearly; there the cubic with the ends' values and slopes.
            const double s = slope_before / (slope_before - slope);
            const double h00 = (1.0 + 2.0 * s) * (1.0 - s) * (1.0 - s);
            const double h10 = s * (1.0 - s) * (1.0 - s);
            const double h01 = s * s * (3.0 - 2.0 * s);
            const double h11 = s * s * (s - 1.0);
            const double lowest =
                h00 * before[n] + h10 * length * slope_before + h01 * walker.point()[n] + h11 * length * slope;
            fold.status = GrazingFold::Status::found;
            fold.omega = lowest * unit;
            fold.offset = 1.0 - lowest;
            fold.speed = before[0] + s * (walker.point()[0] - before[0]);
            fold.sequence = orbit::unpack(system, walker.point().head(n), 1);
            return;
        }
        // Back at grazing or beyond it: that is no motion.
        if (walker.point()[0] <= 0.0) { return; }
        if (1.0 - walker.point()[n] > fold.reach) {
            fold.status = GrazingFold::Status::none;
            return;
        }
    }
}

/// Goes up in v until the slope changes sign: by linear extrapolation from the last two probes, but at least doubling
/// and at most thirtyfold. False when there is no fold within reach (or trouble); `fold` then says which.
bool bracket_fold(const flow::System& system, const Boundary& grazing, GrazingFold& fold, Probe& low, Probe& high) {
    double factor = 4.0;
    while (true) {
        const double speed = low.speed * factor;
        high = probe_from(system, low, speed);
        if (!high.ok) {
            // No motion so far up, or none found from so far off: half as far, in logarithms. Where even a tenth more
            // fails the speed itself turns back.
            factor = std::sqrt(factor);
            if (factor < 1.1) {
                follow_by_arclength(system, grazing, low, fold);
                return false;
            }
            continue;
        }
        if (high.value > 0.0) { return true; }
        if (grazing.omega - high.solution.omega > fold.reach * grazing.omega) {
            fold.status = GrazingFold::Status::none;
            return false;
        }
        const double slope = (high.value - low.value) / (high.speed - low.speed);
        const double crossing = high.speed - high.value / slope;
        // 5 % beyond the crossing, so that the fold is bracketed; not further than thirty times, where a line through
        // two probes says nothing any more, and not less than twice, so that a crossing placed too near does not make
        // it creep.
        factor = slope > 0.0 ? std::clamp(1.05 * crossing / high.speed, 2.0, 30.0) : 4.0;
        low = high;
    }
}

}  // namespace

orbit::ContactSequence grazing_sequence(const flow::System& system, const orbit::ReturnMap& map,
                                        const Boundary& grazing) {
    const flow::System there = system.at_omega(grazing.omega);
    flow::Request request;
    request.state = grazing.state;
    request.theta = map.phase;
    request.duration = grazing.theta_contact - map.phase;
    request.stop = flow::StopMode::off;
    flow::Result result;
    there.run(request, result);
    orbit::ContactSequence sequence;
    orbit::ContactUnknowns contact;
    contact.phase = grazing.theta_contact;
    for (std::size_t k = 2; k < static_cast<std::size_t>(system.states()); ++k) {
        contact.rest[k - 2] = result.state[k];
    }
    // x'' = omega dv/dtheta < 0: a contact entered with speed v lasts 2 v / |x''| in tau.
    const double deceleration = -result.rate[1] * grazing.omega;
    // The speed of the first probe: its contact is the grazing motion's parabola cut at the stop.
    constexpr double unit_speed = 1e-6;
    contact.speed = unit_speed;
    contact.duration = 2.0 * unit_speed / deceleration * grazing.omega;
    sequence.contacts.push_back(contact);
    return sequence;
}

GrazingFold find_fold_beside(const flow::System& system, const Boundary& grazing, double reach) {
    GrazingFold fold;
    fold.reach = reach;
    fold.status = GrazingFold::Status::failed;
    orbit::ReturnMap map;
    const orbit::ContactSequence start = grazing_sequence(system, map, grazing);
    Probe low = probe(system, start, grazing.omega, 1e-6);
    if (!low.ok) { return fold; }
    // The frequency rises with the speed from the start, back over the range of the free motion.
    if (low.value >= 0.0) {
        fold.status = GrazingFold::Status::at_once;
        fold.omega = grazing.omega;
        fold.sequence = low.solution.sequence;
        return fold;
    }
    Probe high = low;
    if (!bracket_fold(system, grazing, fold, low, high)) { return fold; }
    Probe middle = std::abs(high.value) < std::abs(low.value) ? high : low;
    // Regula falsi (Illinois) on the nearly linear slope. The frequency is stationary in the speed at the fold, so four
    // digits of the speed give eight of the offset.
    double weight_low = low.value;
    double weight_high = high.value;
    for (int iteration = 0; iteration < 40; ++iteration) {
        const double speed = (low.speed * weight_high - high.speed * weight_low) / (weight_high - weight_low);
        const double before = middle.speed;
        middle = probe_from(system, middle, speed);
        if (!middle.ok) { return fold; }
        if (std::abs(middle.speed - before) <= 1e-4 * middle.speed) { break; }
        if (middle.value < 0.0) {
            low = middle;
            weight_low = middle.value;
            // Illinois: the end that stays counts for half, else it would stay for long.
            weight_high *= 0.5;
        } else {
            high = middle;
            weight_high = middle.value;
            weight_low *= 0.5;
        }
    }
    fold.status = GrazingFold::Status::found;
    fold.speed = middle.speed;
    fold.omega = middle.solution.omega;
    fold.offset = (grazing.omega - fold.omega) / grazing.omega;
    fold.sequence = middle.solution.sequence;
    return fold;
}

}  // namespace percuss::boundary
