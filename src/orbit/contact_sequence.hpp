#pragma once
/// \file
/// Contact-sequence shooting: the unknowns are, for each contact of the orbit, the entry speed v, the entry phase
/// theta, the remaining states q (viscous stretches) at entry and the contact's duration t_c, all in the drive phase.
/// Contact and flight are integrated for fixed times without any event, so the equations stay smooth through grazing, v
/// = 0, where stroboscopic shooting has a corner. The contact's end is imposed as (x(t_c) - x_stop)/t_c = 0, or as zero
/// force for a stop that releases on force.

#include "flow/flow.hpp"
#include "numerics/linear.hpp"
#include "orbit/orbit.hpp"

#include <optional>
#include <span>
#include <vector>

namespace percuss::orbit {

/// One contact, in unknowns.
struct ContactUnknowns {
    double speed = 0.0;
    double phase = 0.0;                               ///< entry theta
    double duration = 0.0;                            ///< in theta
    std::array<double, flow::max_states - 2> rest{};  ///< states 2.. at entry
};

struct ContactSequence {
    std::vector<ContactUnknowns> contacts;  ///< in order of phase
    int period = 1;                         ///< drive cycles
    [[nodiscard]] int unknowns_per_contact(const flow::System& system) const { return system.states() + 1; }
    [[nodiscard]] int unknowns(const flow::System& system) const {
        return static_cast<int>(contacts.size()) * unknowns_per_contact(system);
    }
};

/// Unknowns as one vector, contact by contact: (v, theta, t_c, q...), and back.
numerics::Vector pack(const flow::System& system, const ContactSequence& sequence);
ContactSequence unpack(const flow::System& system, const numerics::Vector& z, int period);

/// Shooting equations: residual (as many as unknowns), derivatives with respect to the unknowns and to at most three
/// parameter directions. Empty when the flow failed, or when a contact or flight does not fit into the period.
struct SequenceResidual {
    numerics::Vector value;
    numerics::Matrix by_unknowns;
    /// The part of by_unknowns that comes from the first contact as the end of the last flight, one period later:
    /// by_unknowns + (mu - 1) by_closing is singular where mu is a Floquet multiplier.
    numerics::Matrix by_closing;
    numerics::Matrix by_directions;
};
/// closing: the contact that the last flight shall end in, one period later; the first one unless given.
std::optional<SequenceResidual> evaluate(const flow::System& system, const ContactSequence& sequence,
                                         std::span<const flow::ParameterVector> directions,
                                         const ContactUnknowns* closing = nullptr);

/// The sequence of an orbit whose contacts were recorded over one map from a phase in flight; empty when a contact is
/// open at the ends.
std::optional<ContactSequence> sequence_of(const flow::System& system, const Orbit& orbit);

/// Newton on the shooting equations with all parameters fixed.
struct SequenceSolution {
    bool ok = false;
    ContactSequence sequence;
    double residual = 0.0;
    int iterations = 0;
};
SequenceSolution solve_sequence(const flow::System& system, const ContactSequence& guess);

/// Newton with the first contact's entry speed given and the drive frequency unknown instead; also returns
/// d(omega)/d(speed) along the branch.
struct SpeedSolution {
    bool ok = false;
    ContactSequence sequence;
    double omega = 0.0;
    double slope = 0.0;  ///< d(omega)/d(speed)
    /// d(unknowns)/d(speed), packed as by pack() with d(omega) in the place of the first contact's speed.
    numerics::Vector tangent;
};

/// The solution carried along its tangent to another speed: a guess for solve_at_speed (sequence and frequency).
SpeedSolution predict_at_speed(const flow::System& system, const SpeedSolution& from, double speed);
SpeedSolution solve_at_speed(const flow::System& system, const ContactSequence& guess, double omega, double speed);

/// State of the sequence at phase `phase`, by following the flight before the first contact back (or forward).
std::optional<flow::State> state_at(const flow::System& system, const ContactSequence& sequence, double phase);

}  // namespace percuss::orbit
