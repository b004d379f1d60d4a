#pragma once
/// \file
/// A periodic motion as the zero of smooth equations F(z) = 0, in the unknowns that suit it: the state at a strobe
/// phase for motions clear of the stop (and, where contact sequences do not apply, for any), the contact sequence for
/// motions that strike. Within one form F is smooth in z and in all parameters; forms meet at grazing points.

#include "flow/flow.hpp"
#include "numerics/linear.hpp"
#include "orbit/contact_sequence.hpp"
#include "orbit/orbit.hpp"

#include <cstdint>
#include <optional>
#include <span>

namespace percuss::orbit {

enum class Form : std::uint8_t {
    free,      ///< state at a strobe phase, stop taken away; valid while the motion stays clear of the stop
    sequence,  ///< contact sequence; valid while every contact of the motion is in it
    strobed,   ///< state at a strobe phase, hybrid flow; has corners at grazing
};

struct Motion {
    Form form = Form::free;
    int period = 1;
    bool mirrored = false;     ///< free: half a cycle and the mirror image, for motions that have the symmetry
    double phase = 0.0;        ///< free and strobed: strobe phase
    flow::State state{};       ///< free and strobed: at the strobe phase
    ContactSequence sequence;  ///< sequence: its period is `period`
    [[nodiscard]] int unknowns(const flow::System& system) const;
    [[nodiscard]] std::size_t contacts() const { return sequence.contacts.size(); }
};

/// The return map of a motion of free or strobed form.
ReturnMap map_of(const Motion& motion);
/// A motion of free (stop off) or strobed form: the fixed point `state` of a return map.
Motion motion_of_map(const ReturnMap& map, const flow::State& state);

numerics::Vector pack(const flow::System& system, const Motion& motion);
/// The motion of the same form as `like` with unknowns z.
Motion unpack(const flow::System& system, const numerics::Vector& z, const Motion& like);

/// What counts as one unit of each unknown, for step lengths and tolerances, when the motion's size is `size`.
numerics::Vector unit_of_unknowns(const flow::System& system, const Motion& motion, double size);

/// F and its derivatives with respect to the unknowns and to any number of parameter directions.
/// closing: F depends on the unknowns as the beginning and as the end of the period; given, it takes the latter's place
/// (z + (multiplier) dz for second derivatives along Floquet modes). Empty when the flow failed.
std::optional<SequenceResidual> shoot(const flow::System& system, const Motion& motion,
                                      std::span<const flow::ParameterVector> directions,
                                      const Motion* closing = nullptr);

/// Newton with all parameters fixed. Empty without convergence.
std::optional<Motion> solve(const flow::System& system, const Motion& guess);

/// The motion as an orbit of the return map at a strobe phase in its longest flight, not yet checked: state and map are
/// set. Empty when the flow failed.
std::optional<Orbit> strobe(const flow::System& system, const Motion& motion);

/// A motion of free form and one drive cycle that has the mirror symmetry, to be followed over half a cycle; any other
/// motion as it is.
Motion halved_if_symmetric(const flow::System& system, const Motion& motion);

/// The best form for an orbit: free without contacts, else its sequence, or strobed where a contact is open.
Motion motion_of(const flow::System& system, const Orbit& orbit);

}  // namespace percuss::orbit
