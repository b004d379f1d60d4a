#include "orbit/contact_sequence.hpp"

#include <cmath>
#include <numbers>
#include <stdexcept>

namespace percuss::orbit {
namespace {

using numerics::Matrix;
using numerics::Vector;
using std::numbers::pi;

std::size_t index(int i) { return static_cast<std::size_t>(i); }

/// Offsets inside one contact's block of unknowns.
enum Offset : std::uint8_t { at_speed = 0, at_phase = 1, at_duration = 2, at_rest = 3 };

/// The residual's entries are of unlike size (displacements, and a gap divided by a duration): so its tolerance is
/// absolute. Guesses come from a solution beside this one or from an orbit: no backtracking. With the speed given the
/// step is not limited; its tolerance is that of the frequency, whose distance from grazing, 1e-9 of itself, matters.
constexpr numerics::NewtonOptions sequence_newton{.max_iterations = 20,
                                                  .max_halvings = 0,
                                                  .residual_tolerance = 1e-10,
                                                  .step_tolerance = 1e-11,
                                                  .max_step = numerics::unlimited,
                                                  .residual_is_relative = false};

/// On the stop, with the speed and the other states of the contact.
flow::State entry_state(const flow::System& system, const ContactUnknowns& contact) {
    flow::State y{};
    y[0] = system.stop_position();
    y[1] = contact.speed;
    for (int k = 2; k < system.states(); ++k) { y[index(k)] = contact.rest[index(k - 2)]; }
    return y;
}

/// Phase from the end of contact i to the entry of the next one; after the last it is that of `closing`.
double flight_duration(const ContactSequence& sequence, std::size_t i, const ContactUnknowns& closing) {
    const ContactUnknowns& here = sequence.contacts[i];
    const bool last = i + 1 == sequence.contacts.size();
    const double next = last ? closing.phase + 2.0 * pi * sequence.period : sequence.contacts[i + 1].phase;
    return next - here.phase - here.duration;
}

/// A wild Newton step must not send the integrator off for thousands of cycles: contact and flight fit in one period.
bool plausible(const ContactSequence& sequence, std::size_t i, const ContactUnknowns& closing) {
    const double whole = 2.0 * pi * sequence.period;
    const double flight = flight_duration(sequence, i, closing);
    // More than one period, because beyond grazing (v < 0, no motion but a point of the smooth branch) the duration of
    // the contact is negative and the flight longer by as much.
    return std::abs(sequence.contacts[i].duration) < whole && flight > 0.0 && flight < 1.1 * whole;
}

/// One contact and the flight after it, with everything's derivatives placed in the big matrices.
class Leg {
public:
    Leg(const flow::System& system, const ContactSequence& sequence, std::size_t i, const ContactUnknowns& closing,
        std::span<const flow::ParameterVector> directions)
        : system_(system),
          sequence_(sequence),
          i_(i),
          last_(i + 1 == sequence.contacts.size()),
          target_(last_ ? closing : sequence.contacts[i + 1]),
          flight_duration_(flight_duration(sequence, i, closing)),
          directions_(directions),
          n_(system.states()) {}

    bool run() { return run_contact() && run_flight(); }

    /// Rows: how the contact closes, then the n states at the end of the flight. The flight starts from the contact's
    /// end, so derivatives by what the contact began with go through both by the chain rule; its duration is theta' -
    /// theta - t_c.
    void place(SequenceResidual& out) const {
        const int block = n_ + 1;
        const int row = static_cast<int>(i_) * block;
        const int here = row;
        const int next = last_ ? 0 : here + block;
        const bool on_force = system_.integrator->info().releases_on_force;
        const flow::Sensitive& closing = on_force ? contact_.divided_force : contact_.divided_gap;
        const int first_parameter = n_;  // lanes of the contact: speed, rest..., phase, parameters
        out.value[row] = closing.value;
        out.by_unknowns(row, here + at_speed) += closing.d[0];
        for (int k = 2; k < n_; ++k) { out.by_unknowns(row, here + at_rest + k - 2) += closing.d[index(k - 1)]; }
        out.by_unknowns(row, here + at_phase) += closing.d[index(n_ - 1)];
        out.by_unknowns(row, here + at_duration) += closing_rate(on_force);
        for (std::size_t p = 0; p < directions_.size(); ++p) {
            out.by_directions(row, static_cast<int>(p)) = closing.d[index(first_parameter) + p];
        }

        // Flight residual: x - x_stop, v - v', q - q'.
        const flow::State wanted = entry_state(system_, target_);
        for (int k = 0; k < n_; ++k) {
            const int r = row + 1 + k;
            const auto& d = flight_.state_d[index(k)];  // lanes: states, phase, parameters
            out.value[r] = flight_.state[index(k)] - wanted[index(k)];
            // d(end of flight)/d(unknown of the contact in this lane), by way of the state at the contact's end.
            const auto through = [&](int lane_of_contact) {
                double sum = 0.0;
                for (int m = 0; m < n_; ++m) {
                    sum += d[index(m)] * contact_.state_d[index(m)][index(lane_of_contact)];
                }
                return sum;
            };
            const double by_phase = d[index(n_)];
            const double rate = flight_.rate[index(k)];
            double by_end = by_phase;  // the flight starts later when the contact lasts longer
            for (int m = 0; m < n_; ++m) { by_end += d[index(m)] * contact_.rate[index(m)]; }
            out.by_unknowns(r, here + at_speed) += through(0);
            for (int m = 2; m < n_; ++m) { out.by_unknowns(r, here + at_rest + m - 2) += through(m - 1); }
            // A later entry moves contact and flight to a later phase and makes the flight shorter by as much.
            out.by_unknowns(r, here + at_phase) += through(n_ - 1) + by_phase - rate;
            out.by_unknowns(r, here + at_duration) += by_end - rate;
            const auto by_target = [&](int offset, double d_target) {
                out.by_unknowns(r, next + offset) += d_target;
                if (last_) { out.by_closing(r, next + offset) += d_target; }
            };
            by_target(at_phase, rate);
            if (k == 1) { by_target(at_speed, -1.0); }
            if (k >= 2) { by_target(at_rest + k - 2, -1.0); }
            for (std::size_t p = 0; p < directions_.size(); ++p) {
                double sum = through(first_parameter + static_cast<int>(p)) + d[index(n_ + 1) + p];
                if (k == 0) { sum -= system_.integrator->stop_position_derivative(system_.parameters, directions_[p]); }
                out.by_directions(r, static_cast<int>(p)) = sum;
            }
        }
    }

private:
    /// From the entry for the contact's duration with the stop held, so that there is no event to find.
    bool run_contact() {
        const ContactUnknowns& contact = sequence_.contacts[i_];
        std::array<flow::Direction, flow::max_lanes> lanes{};
        lanes[0].state[1] = 1.0;
        for (int k = 2; k < n_; ++k) { lanes[index(k - 1)].state[index(k)] = 1.0; }
        lanes[index(n_ - 1)].phase = 1.0;
        for (std::size_t p = 0; p < directions_.size(); ++p) {
            flow::Direction& lane = lanes[index(n_) + p];
            lane.parameter = directions_[p];
            // The entry stays on the stop when a parameter moves it.
            lane.state[0] = system_.integrator->stop_position_derivative(system_.parameters, directions_[p]);
        }
        flow::Request request;
        request.state = entry_state(system_, contact);
        request.theta = contact.phase;
        request.duration = contact.duration;
        request.stop = flow::StopMode::held;
        request.directions = std::span(lanes.data(), index(n_) + directions_.size());
        system_.run(request, contact_);
        return contact_.status == flow::Status::ok;
    }

    /// From the end of the contact to the entry of the next one, stop off, likewise without events.
    bool run_flight() {
        const ContactUnknowns& contact = sequence_.contacts[i_];
        std::array<flow::Direction, flow::max_lanes> lanes{};
        for (int k = 0; k < n_; ++k) { lanes[index(k)].state[index(k)] = 1.0; }
        lanes[index(n_)].phase = 1.0;
        for (std::size_t p = 0; p < directions_.size(); ++p) { lanes[index(n_ + 1) + p].parameter = directions_[p]; }
        flow::Request request;
        request.state = contact_.state;
        request.theta = contact.phase + contact.duration;
        request.duration = flight_duration_;
        request.stop = flow::StopMode::off;
        request.directions = std::span(lanes.data(), index(n_ + 1) + directions_.size());
        system_.run(request, flight_);
        return flight_.status == flow::Status::ok;
    }

    /// d(closing)/d(duration).
    [[nodiscard]] double closing_rate(bool on_force) const {
        const double duration = sequence_.contacts[i_].duration;
        const flow::SystemInfo& info = system_.integrator->info();
        const double k = system_.parameters[index(info.stiffness)];
        const double c = system_.parameters[index(info.damping)];
        const double gap_rate = gap_slope(duration);
        if (!on_force) { return gap_rate; }
        const double sign = duration < 0.0 ? -1.0 : 1.0;
        // The residual is force/(k |t| + c), so that it stays of the size of a speed however stiff the stop is;
        // derivative of the quotient.
        const double scale = k * std::abs(duration) + c;
        const double force_rate = k * contact_.rate[0] + c * contact_.rate[1];
        return force_rate / scale - contact_.divided_force.value * k * sign / scale;
    }
    /// d/dt of (x(t) - x_stop)/t: (x'(t) - (x - x_stop)/t)/t; its limit x''/2 where t is too small for the quotient.
    [[nodiscard]] double gap_slope(double duration) const {
        const double slope = contact_.rate[0] - contact_.divided_gap.value;
        // Rounding of the quotient grows as 1e-16/t, the limit is off by the order of t: at 1e-6 both are small.
        if (std::abs(duration) > 1e-6) { return slope / duration; }
        const double w = system_.omega();
        return 0.5 * contact_.rate[1] / w;
    }

    const flow::System& system_;
    const ContactSequence& sequence_;
    std::size_t i_;
    bool last_;
    const ContactUnknowns& target_;
    double flight_duration_;
    std::span<const flow::ParameterVector> directions_;
    int n_;
    flow::Result contact_, flight_;
};

}  // namespace

Vector pack(const flow::System& system, const ContactSequence& sequence) {
    Vector z(sequence.unknowns(system));
    int at = 0;
    for (const ContactUnknowns& contact : sequence.contacts) {
        z[at + at_speed] = contact.speed;
        z[at + at_phase] = contact.phase;
        z[at + at_duration] = contact.duration;
        for (int k = 2; k < system.states(); ++k) { z[at + at_rest + k - 2] = contact.rest[index(k - 2)]; }
        at += sequence.unknowns_per_contact(system);
    }
    return z;
}

ContactSequence unpack(const flow::System& system, const Vector& z, int period) {
    ContactSequence sequence;
    sequence.period = period;
    const int block = sequence.unknowns_per_contact(system);
    for (int at = 0; at < z.size(); at += block) {
        ContactUnknowns contact;
        contact.speed = z[at + at_speed];
        contact.phase = z[at + at_phase];
        contact.duration = z[at + at_duration];
        for (int k = 2; k < system.states(); ++k) { contact.rest[index(k - 2)] = z[at + at_rest + k - 2]; }
        sequence.contacts.push_back(contact);
    }
    return sequence;
}

std::optional<SequenceResidual> evaluate(const flow::System& system, const ContactSequence& sequence,
                                         std::span<const flow::ParameterVector> directions,
                                         const ContactUnknowns* closing) {
    // The flight's lanes are the states, the phase and the directions: with four states and eight lanes three are left.
    if (directions.size() > 3) { throw std::invalid_argument("contact sequence: more than 3 directions"); }
    const int size = sequence.unknowns(system);
    SequenceResidual out;
    out.value = Vector::Zero(size);
    out.by_unknowns = Matrix::Zero(size, size);
    out.by_closing = Matrix::Zero(size, size);
    out.by_directions = Matrix::Zero(size, static_cast<int>(directions.size()));
    const ContactUnknowns& target = closing != nullptr ? *closing : sequence.contacts.front();
    for (std::size_t i = 0; i < sequence.contacts.size(); ++i) {
        if (!plausible(sequence, i, target)) { return std::nullopt; }
        Leg leg(system, sequence, i, target, directions);
        if (!leg.run()) { return std::nullopt; }
        leg.place(out);
    }
    return out;
}

std::optional<ContactSequence> sequence_of(const flow::System& system, const Orbit& orbit) {
    ContactSequence sequence;
    sequence.period = orbit.map.period;
    for (const flow::Contact& met : orbit.contacts) {
        if (met.open_in || met.open_out) { return std::nullopt; }
        ContactUnknowns contact;
        contact.speed = met.state_in[1];
        contact.phase = met.theta_in;
        contact.duration = met.theta_out - met.theta_in;
        for (int k = 2; k < system.states(); ++k) { contact.rest[index(k - 2)] = met.state_in[index(k)]; }
        sequence.contacts.push_back(contact);
    }
    if (sequence.contacts.empty()) { return std::nullopt; }
    return sequence;
}

SequenceSolution solve_sequence(const flow::System& system, const ContactSequence& guess) {
    const auto shot = [&](const Vector& z, numerics::Linearised<Vector, Matrix>& at) {
        auto r = evaluate(system, unpack(system, z, guess.period), {});
        if (!r) { return false; }
        at.residual = std::move(r->value);
        at.jacobian = std::move(r->by_unknowns);
        return true;
    };
    // 0.3 keeps durations and phases from changing sign or order in one step.
    numerics::NewtonOptions options = sequence_newton;
    options.max_step = 0.3;
    options.step_tolerance = 1e-10;
    const auto found = numerics::newton<numerics::Linearised<Vector, Matrix>>(pack(system, guess), shot, options);
    SequenceSolution solution;
    solution.ok = found.ok();
    solution.iterations = found.iterations;
    solution.residual = found.residual;
    solution.sequence = unpack(system, found.x, guess.period);
    return solution;
}

SpeedSolution solve_at_speed(const flow::System& system, const ContactSequence& guess, double omega, double speed) {
    struct Shot : numerics::Linearised<Vector, Matrix> {
        Vector by_speed;
    };
    const flow::ParameterVector by_omega = unit_direction(system.integrator->info().omega);
    const auto with_speed = [&](Vector z) {
        z[at_speed] = speed;
        return unpack(system, z, guess.period);
    };
    const auto shot = [&](const Vector& z, Shot& at) {
        const double w = z[at_speed];
        // A Newton step may lead to a frequency that there is no flow for.
        if (!(w > 0.0)) { return false; }
        auto r = evaluate(system.at_omega(w), with_speed(z), {&by_omega, 1});
        if (!r) { return false; }
        at.by_speed = r->by_unknowns.col(at_speed);
        at.residual = std::move(r->value);
        at.jacobian = std::move(r->by_unknowns);
        // The column of the speed, which is given, becomes that of the frequency.
        at.jacobian.col(at_speed) = r->by_directions.col(0);
        return true;
    };
    Vector start = pack(system, guess);
    start[at_speed] = omega;  // this place holds the frequency while the speed is given
    const auto found = numerics::newton<Shot>(std::move(start), shot, sequence_newton);
    SpeedSolution solution;
    solution.ok = found.ok();
    solution.omega = found.x[at_speed];
    solution.sequence = with_speed(found.x);
    if (!found.ok()) { return solution; }
    // F_z dz + F_v dv = 0 with the frequency among z.
    solution.tangent = found.factors.solve(-found.at.by_speed);
    solution.slope = solution.tangent[at_speed];
    return solution;
}

SpeedSolution predict_at_speed(const flow::System& system, const SpeedSolution& from, double speed) {
    const double change = speed - from.sequence.contacts[0].speed;
    SpeedSolution guess;
    Vector z = pack(system, from.sequence) + change * from.tangent;
    z[at_speed] = speed;
    guess.omega = from.omega + change * from.slope;
    guess.sequence = unpack(system, z, from.sequence.period);
    return guess;
}

std::optional<flow::State> state_at(const flow::System& system, const ContactSequence& sequence, double phase) {
    const ContactUnknowns& first = sequence.contacts.front();
    flow::Request request;
    request.state = entry_state(system, first);
    request.theta = first.phase;
    request.duration = phase - first.phase;
    request.stop = flow::StopMode::off;
    flow::Result result;
    if (request.duration > 0.0) { return std::nullopt; }  // only back along the flight before the first contact
    system.run(request, result);
    if (result.status != flow::Status::ok) { return std::nullopt; }
    return result.state;
}

}  // namespace percuss::orbit
