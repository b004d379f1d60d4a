#include "orbit/orbit.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace percuss::orbit {
namespace {

using numerics::SmallMatrix;
using numerics::SmallVector;
using std::numbers::pi;

/// The shooting equations P(y) - y = 0 at a point, with the flow that they come from.
struct Shot : numerics::Linearised<SmallVector, SmallMatrix> {
    Image image;
};

}  // namespace

Orbit find_orbit(const flow::System& system, const ReturnMap& map, const flow::State& guess,
                 const NewtonOptions& options) {
    Orbit orbit;
    orbit.map = map;
    const int n = system.states();
    const auto shoot = [&](const SmallVector& y, Shot& shot) {
        shot.image = apply(system, map, to_state(y), Differentiate::state);
        if (!shot.image.ok()) { return false; }
        shot.residual = to_vector(system, shot.image.state) - y;
        shot.jacobian = SmallMatrix(shot.image.derivative) - SmallMatrix::Identity(n, n);
        return true;
    };
    auto found = numerics::newton<Shot>(to_vector(system, guess), shoot, options);
    orbit.iterations = found.iterations;
    if (found.status == numerics::NewtonStatus::evaluation_failed) {
        orbit.status = OrbitStatus::flow_failed;
        return orbit;
    }
    orbit.status = found.ok() ? OrbitStatus::converged : OrbitStatus::no_convergence;
    orbit.residual = found.residual;
    orbit.last_step = found.last_step;
    orbit.state = to_state(found.x);
    orbit.monodromy = found.at.image.derivative;
    orbit.contacts = std::move(found.at.image.contacts);
    return orbit;
}

numerics::SmallComplexVector multipliers(const Orbit& orbit) {
    numerics::SmallComplexVector values = orbit.monodromy.eigenvalues();
    // The map of a whole period is the mirrored half-cycle map applied twice.
    if (orbit.map.mirrored) { values = values.array().square().matrix().eval(); }
    std::sort(values.begin(), values.end(), [](const auto& a, const auto& b) {
        const double na = std::abs(a);
        const double nb = std::abs(b);
        // Of a complex pair the one with the positive imaginary part first: the order must not depend on the eigenvalue
        // solver.
        return na != nb ? na > nb : a.imag() > b.imag();
    });
    return values;
}

double max_multiplier(const Orbit& orbit) { return std::abs(multipliers(orbit)[0]); }

std::optional<flow::State> settle(const flow::System& system, const flow::State& from, int cycles,
                                  flow::StopMode stop) {
    flow::Request request;
    request.state = from;
    request.duration = 2.0 * pi * cycles;
    request.stop = stop;
    // A cap, so that chatter ends with a status instead of without end.
    request.max_events = 64 * (cycles + 1);
    flow::Result result;
    system.run(request, result);
    if (result.status != flow::Status::ok) { return std::nullopt; }
    return result.state;
}

Orbit away_from_contact(const flow::System& system, const Orbit& orbit) {
    if (orbit.contacts.empty()) { return orbit; }
    const double start = orbit.map.phase;
    const double whole = orbit.map.duration();
    // flights between consecutive contacts, cyclically
    double longest = -1.0;
    double middle = start;
    const std::size_t n = orbit.contacts.size();
    for (std::size_t i = 0; i < n; ++i) {
        const double begin = orbit.contacts[i].theta_out;
        const double end = i + 1 < n ? orbit.contacts[i + 1].theta_in : orbit.contacts[0].theta_in + whole;
        // A contact cut by the strobe phase is followed by no flight yet: its other half is the first of the list.
        if (orbit.contacts[i].open_out) { continue; }
        if (end - begin > longest) {
            longest = end - begin;
            middle = 0.5 * (begin + end);
        }
    }
    if (longest < 0.0) { return orbit; }
    flow::Request request;
    request.state = orbit.state;
    request.theta = start;
    request.duration = middle - start;
    flow::Result result;
    system.run(request, result);
    if (result.status != flow::Status::ok) { return orbit; }
    ReturnMap map = orbit.map;
    map.phase = std::fmod(middle, 2.0 * pi);
    Orbit moved = find_orbit(system, map, result.state);
    return moved.ok() ? moved : orbit;
}

double Portrait::total(ObservableIndex q, int i) const {
    const Observed& o = image.observed[q];
    const int n = static_cast<int>(monodromy.rows());
    double sum = o.d[static_cast<std::size_t>(n + i)];
    for (int k = 0; k < n; ++k) { sum += o.d[static_cast<std::size_t>(k)] * d_state(k, i); }
    return sum;
}

Portrait portray(const flow::System& system, const Orbit& orbit, std::span<const flow::ParameterVector> directions,
                 std::uint32_t observe) {
    Portrait portrait;
    const int n = system.states();
    ReturnMap map = orbit.map;
    // Newton's method does with derivative series that stop four orders early, which is 1.7 times cheaper; gradients
    // that are reported do not.
    map.precise = true;
    portrait.image = apply(system, map, orbit.state, Differentiate::all, directions, observe);
    portrait.status = portrait.image.status;
    if (!portrait.ok()) { return portrait; }
    portrait.monodromy = portrait.image.derivative.leftCols(n);
    portrait.residual = (to_vector(system, portrait.image.state) - to_vector(system, orbit.state)).norm();
    // Implicit differentiation of P(y, p) = y: (I - M) dy/dp = dP/dp.
    const SmallMatrix jacobian = SmallMatrix::Identity(n, n) - portrait.monodromy;
    portrait.d_state =
        jacobian.partialPivLu().solve(portrait.image.derivative.rightCols(static_cast<int>(directions.size())));
    return portrait;
}

ErrorEstimate estimate_errors(const flow::System& tighter, const Orbit& orbit, const Portrait& portrait,
                              std::uint32_t observe) {
    ErrorEstimate estimate;
    const int n = tighter.states();
    const Image image = apply(tighter, orbit.map, orbit.state, Differentiate::nothing, {}, observe);
    // (I - M) dy = P_tighter(y) - y: how far the orbit moves when the integration error is taken away.
    const SmallMatrix jacobian = SmallMatrix::Identity(n, n) - portrait.monodromy;
    const SmallVector correction =
        jacobian.partialPivLu().solve(to_vector(tighter, image.state) - to_vector(tighter, orbit.state));
    // No estimate below rounding: where both integrators are that exact their difference may vanish by chance.
    constexpr double rounding = 4.0 * std::numeric_limits<double>::epsilon();
    estimate.state = correction.norm() + rounding;
    for (std::size_t q = 0; q < observable_count; ++q) {
        const Observed& o = portrait.image.observed[q];
        // Along the orbit, not at the old state: the observable there and what the correction of the state adds.
        double moved = image.observed[q].value - o.value;
        double spread = 0.0;
        for (int k = 0; k < n; ++k) {
            moved += o.d[static_cast<std::size_t>(k)] * correction[k];
            spread += std::abs(o.d[static_cast<std::size_t>(k)]) * rounding;
        }
        estimate.observed[q] = std::abs(moved) + spread + rounding * std::abs(o.value);
    }
    return estimate;
}

}  // namespace percuss::orbit
