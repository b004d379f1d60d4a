#include "boundary/grazing_fold.hpp"

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

Probe probe(const flow::System& system, const orbit::ContactSequence& guess, double omega, double speed) {
    Probe p;
    p.speed = speed;
    p.solution = orbit::solve_at_speed(system, guess, omega, speed);
    p.ok = p.solution.ok;
    p.value = p.solution.slope / speed;
    return p;
}

/// The sequence scaled to another (small) speed: the duration is proportional to it.
orbit::ContactSequence rescaled(orbit::ContactSequence sequence, double speed) {
    const double old = sequence.contacts[0].speed;
    if (old > 0.0) { sequence.contacts[0].duration *= speed / old; }
    sequence.contacts[0].speed = speed;
    return sequence;
}

/// Goes up in v until the slope changes sign: by linear extrapolation from the last two probes, but at least doubling
/// and at most thirtyfold. False when there is no fold within reach (or trouble); `fold` then says which.
bool bracket_fold(const flow::System& system, const Boundary& grazing, GrazingFold& fold, Probe& low, Probe& high) {
    double factor = 4.0;
    while (true) {
        const double speed = low.speed * factor;
        high = probe(system, rescaled(low.solution.sequence, speed), low.solution.omega, speed);
        if (!high.ok) {
            factor = std::sqrt(factor);
            if (factor < 1.01) { return false; }
            continue;
        }
        if (high.value > 0.0) { return true; }
        if (grazing.omega - high.solution.omega > fold.reach * grazing.omega) {
            fold.status = GrazingFold::Status::none;
            return false;
        }
        const double slope = (high.value - low.value) / (high.speed - low.speed);
        const double crossing = high.speed - high.value / slope;
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
        middle = probe(system, rescaled(middle.solution.sequence, speed), middle.solution.omega, speed);
        if (!middle.ok) { return fold; }
        if (std::abs(middle.speed - before) <= 1e-4 * middle.speed) { break; }
        if (middle.value < 0.0) {
            low = middle;
            weight_low = middle.value;
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
