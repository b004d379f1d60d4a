#include "orbit/orbit.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace percuss::orbit {
namespace {

using numerics::SmallMatrix;
using numerics::SmallVector;
using std::numbers::pi;

/// One evaluation of the shooting equations.
struct Iterate {
    Image image;
    SmallVector y;
    SmallVector defect;  ///< P(y) - y
    double norm = 0.0;
};

Iterate look(const flow::System& system, const ReturnMap& map, const SmallVector& y) {
    Iterate it;
    it.y = y;
    it.image = apply(system, map, to_state(y), Differentiate::state);
    if (it.image.ok()) {
        it.defect = to_vector(system, it.image.state) - y;
        it.norm = it.defect.norm();
    }
    return it;
}

SmallVector newton_step(const Iterate& it) {
    const int n = static_cast<int>(it.y.size());
    const SmallMatrix jacobian = SmallMatrix(it.image.derivative) - SmallMatrix::Identity(n, n);
    return jacobian.partialPivLu().solve(-it.defect);
}

}  // namespace

Orbit find_orbit(const flow::System& system, const ReturnMap& map, const flow::State& guess,
                 const NewtonOptions& options) {
    Orbit orbit;
    orbit.map = map;
    orbit.status = OrbitStatus::no_convergence;
    Iterate current = look(system, map, to_vector(system, guess));
    for (orbit.iterations = 1; orbit.iterations <= options.max_iterations; ++orbit.iterations) {
        if (!current.image.ok()) {
            orbit.status = OrbitStatus::flow_failed;
            return orbit;
        }
        const double scale = 1.0 + current.y.norm();
        SmallVector step = newton_step(current);
        if (!step.allFinite()) { break; }
        orbit.residual = current.norm;
        orbit.last_step = step.norm();
        if (current.norm <= options.residual_tolerance * scale && step.norm() <= options.step_tolerance * scale) {
            orbit.status = OrbitStatus::converged;
            current.y += step;
            break;
        }
        if (step.norm() > options.max_step * scale) { step *= options.max_step * scale / step.norm(); }
        Iterate next;
        double fraction = 1.0;
        for (int halving = 0; halving <= options.max_halvings; ++halving, fraction *= 0.5) {
            next = look(system, map, current.y + fraction * step);
            if (next.image.ok() && next.norm < (1.0 - 0.1 * fraction) * current.norm) { break; }
        }
        const bool progressed = next.image.ok() && next.norm < current.norm;
        if (!progressed && !(current.norm <= 100.0 * options.residual_tolerance * scale)) { break; }
        if (!progressed) {  // at the rounding floor of a badly conditioned orbit
            if (current.norm <= 10.0 * options.residual_tolerance * scale) { orbit.status = OrbitStatus::converged; }
            break;
        }
        current = std::move(next);
    }
    orbit.state = to_state(current.y);
    orbit.monodromy = current.image.derivative;
    orbit.contacts = std::move(current.image.contacts);
    return orbit;
}

numerics::SmallComplexVector multipliers(const Orbit& orbit) {
    numerics::SmallComplexVector values = orbit.monodromy.eigenvalues();
    if (orbit.map.mirrored) { values = values.array().square().matrix().eval(); }
    std::sort(values.begin(), values.end(), [](const auto& a, const auto& b) {
        const double na = std::abs(a);
        const double nb = std::abs(b);
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
    map.precise = true;
    portrait.image = apply(system, map, orbit.state, Differentiate::all, directions, observe);
    portrait.status = portrait.image.status;
    if (!portrait.ok()) { return portrait; }
    portrait.monodromy = portrait.image.derivative.leftCols(n);
    portrait.residual = (to_vector(system, portrait.image.state) - to_vector(system, orbit.state)).norm();
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
    const SmallMatrix jacobian = SmallMatrix::Identity(n, n) - portrait.monodromy;
    const SmallVector correction =
        jacobian.partialPivLu().solve(to_vector(tighter, image.state) - to_vector(tighter, orbit.state));
    constexpr double rounding = 4.0 * std::numeric_limits<double>::epsilon();
    estimate.state = correction.norm() + rounding;
    for (std::size_t q = 0; q < observable_count; ++q) {
        const Observed& o = portrait.image.observed[q];
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
