#include "orbit/motion.hpp"

#include "orbit/polish.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace percuss::orbit {
namespace {

using numerics::Matrix;
using numerics::Vector;
using std::numbers::pi;

/// Contact-sequence shooting takes this many directions at a time.
constexpr std::size_t block_of_directions = 3;

/// P(y) - y_end, where y_end is y unless another end is given.
std::optional<SequenceResidual> shoot_strobed(const flow::System& system, const Motion& motion,
                                              std::span<const flow::ParameterVector> directions,
                                              const Motion& closing) {
    const int n = system.states();
    const Image image = apply(system, map_of(motion), motion.state, Differentiate::all, directions);
    if (!image.ok()) { return std::nullopt; }
    SequenceResidual out;
    out.value = to_vector(system, image.state) - to_vector(system, closing.state);
    out.by_closing = -Matrix::Identity(n, n);
    out.by_unknowns = image.derivative.leftCols(n);
    out.by_unknowns += out.by_closing;
    out.by_directions = image.derivative.rightCols(static_cast<int>(directions.size()));
    return out;
}

/// The equations of a contact sequence, by any number of directions.
std::optional<SequenceResidual> shoot_sequence(const flow::System& system, const Motion& motion,
                                               std::span<const flow::ParameterVector> directions,
                                               const Motion& closing) {
    const ContactUnknowns* end = &closing.sequence.contacts.front();
    const std::size_t first = std::min(block_of_directions, directions.size());
    auto out = evaluate(system, motion.sequence, directions.first(first), end);
    for (std::size_t at = first; out && at < directions.size(); at += block_of_directions) {
        const std::size_t count = std::min(block_of_directions, directions.size() - at);
        const auto more = evaluate(system, motion.sequence, directions.subspan(at, count), end);
        if (!more) { return std::nullopt; }
        Matrix joined(out->by_directions.rows(), out->by_directions.cols() + more->by_directions.cols());
        joined << out->by_directions, more->by_directions;
        out->by_directions = joined;
    }
    return out;
}

/// The sequence begun with the contact that follows the longest flight.
/// Contacts that come before it are moved on by one period.
ContactSequence rotated_to_longest_flight(const ContactSequence& sequence) {
    const std::size_t n = sequence.contacts.size();
    const double whole = 2.0 * pi * sequence.period;
    std::size_t best = 0;
    double longest = -1.0;
    for (std::size_t i = 0; i < n; ++i) {
        const ContactUnknowns& before = sequence.contacts[(i + n - 1) % n];
        const double flight = sequence.contacts[i].phase - before.phase - before.duration + (i == 0 ? whole : 0.0);
        if (flight > longest) {
            longest = flight;
            best = i;
        }
    }
    ContactSequence rotated;
    rotated.period = sequence.period;
    for (std::size_t i = 0; i < n; ++i) {
        ContactUnknowns contact = sequence.contacts[(best + i) % n];
        if (best + i >= n) { contact.phase += whole; }
        rotated.contacts.push_back(contact);
    }
    return rotated;
}

/// Phase from the end of the last contact to the first one, a period later.
double flight_before_first(const ContactSequence& sequence) {
    const ContactUnknowns& last = sequence.contacts.back();
    return sequence.contacts.front().phase + 2.0 * pi * sequence.period - last.phase - last.duration;
}

}  // namespace

ReturnMap map_of(const Motion& motion) {
    ReturnMap map;
    map.stop = motion.form == Form::free ? flow::StopMode::off : flow::StopMode::hybrid;
    map.phase = motion.phase;
    map.period = motion.period;
    map.mirrored = motion.mirrored;
    return map;
}

Motion motion_of_map(const ReturnMap& map, const flow::State& state) {
    Motion motion;
    motion.form = map.stop == flow::StopMode::off ? Form::free : Form::strobed;
    motion.period = map.period;
    motion.mirrored = map.mirrored;
    motion.phase = map.phase;
    motion.state = state;
    return motion;
}

int Motion::unknowns(const flow::System& system) const {
    return form == Form::sequence ? sequence.unknowns(system) : system.states();
}

Vector pack(const flow::System& system, const Motion& motion) {
    if (motion.form == Form::sequence) { return pack(system, motion.sequence); }
    return to_vector(system, motion.state);
}

Motion unpack(const flow::System& system, const Vector& z, const Motion& like) {
    Motion motion = like;
    if (like.form == Form::sequence) {
        motion.sequence = unpack(system, z, like.period);
    } else {
        motion.state = to_state(z);
    }
    return motion;
}

Vector unit_of_unknowns(const flow::System& system, const Motion& motion, double size) {
    const int n = system.states();
    // Displacements and stretches are of the size of the motion, speeds that times omega, phases and durations of order
    // 1 rad.
    Vector unit = Vector::Constant(motion.unknowns(system), size);
    if (motion.form != Form::sequence) {
        unit[1] = size * system.omega();
        return unit;
    }
    for (int at = 0; at < unit.size(); at += n + 1) {
        unit[at] = size * system.omega();
        unit[at + 1] = 1.0;
        unit[at + 2] = 1.0;
    }
    return unit;
}

std::optional<SequenceResidual> shoot(const flow::System& system, const Motion& motion,
                                      std::span<const flow::ParameterVector> directions, const Motion* closing) {
    const Motion& end = closing != nullptr ? *closing : motion;
    return motion.form == Form::sequence ? shoot_sequence(system, motion, directions, end)
                                         : shoot_strobed(system, motion, directions, end);
}

std::optional<Motion> solve(const flow::System& system, const Motion& guess) {
    // Predictions along a branch or a line in the design are near: the plain method does, and where it needs more than
    // that a shorter step of the caller is the better answer. 0.3 keeps durations and phases from changing sign or
    // order in one step. 1e-9 before the last step is rounding size after it.
    const numerics::NewtonOptions options{
        .max_iterations = 20, .max_halvings = 0, .residual_tolerance = 1e-9, .step_tolerance = 1e-9, .max_step = 0.3};
    const auto shot = [&](const Vector& z, numerics::Linearised<Vector, Matrix>& at) {
        auto r = shoot(system, unpack(system, z, guess), {});
        if (!r) { return false; }
        at.residual = std::move(r->value);
        at.jacobian = std::move(r->by_unknowns);
        return true;
    };
    const auto found = numerics::newton<numerics::Linearised<Vector, Matrix>>(pack(system, guess), shot, options);
    if (!found.ok()) { return std::nullopt; }
    return unpack(system, found.x, guess);
}

std::optional<Orbit> strobe(const flow::System& system, const Motion& motion) {
    Orbit orbit;
    orbit.map = map_of(motion);
    orbit.state = motion.state;
    orbit.status = OrbitStatus::converged;
    if (motion.form != Form::sequence) { return orbit; }
    const ContactSequence sequence = rotated_to_longest_flight(motion.sequence);
    const ContactUnknowns& first = sequence.contacts.front();
    // Backward the flow is unstable in its viscous states: so not further than needed.
    // A quarter of a cycle clears the contact by enough for the strobe phase; the middle of the flight where that is
    // shorter.
    const double back = std::min(0.5 * flight_before_first(sequence), 0.5 * pi);
    const auto state = state_at(system, sequence, first.phase - back);
    if (!state) { return std::nullopt; }
    orbit.state = *state;
    orbit.map.phase = std::remainder(first.phase - back, 2.0 * pi);
    if (orbit.map.phase < 0.0) { orbit.map.phase += 2.0 * pi; }
    return orbit;
}

Motion halved_if_symmetric(const flow::System& system, const Motion& motion) {
    if (motion.form != Form::free || motion.period != 1 || !system.symmetric()) { return motion; }
    Motion half = motion;
    half.mirrored = true;
    const auto r = shoot(system, half, {});
    // The residual of a motion without the symmetry is its asymmetry; of one with it, what Newton's method has left.
    return r && r->value.norm() < 1e-6 ? half : motion;
}

Motion motion_of(const flow::System& system, const Orbit& orbit) {
    Motion motion;
    motion.period = orbit.map.period;
    motion.phase = orbit.map.phase;
    motion.state = orbit.state;
    if (orbit.contacts.empty()) {
        motion.mirrored = orbit.map.mirrored;
        return motion;
    }
    const auto sequence = sequence_of(system, orbit);
    motion.form = sequence ? Form::sequence : Form::strobed;
    if (sequence) { motion.sequence = *sequence; }
    return motion;
}

}  // namespace percuss::orbit
