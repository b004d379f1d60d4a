#pragma once
/// \file
/// Where a design is driven: decided here and nowhere else.

#include "boundary/edge.hpp"
#include "design/evaluation.hpp"
#include "design/reach.hpp"
#include "flow/flow.hpp"
#include "model/specification.hpp"

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace percuss::design {

/// A design made ready to be driven.
struct DrivenDesign {
    const model::Specification& actuator;
    const model::Scaled& scaled;  ///< of the actuator
    flow::System system;          ///< at the problem's tolerance; its frequency is not looked at
    flow::System scout;           ///< the same with a looser integrator, to follow the free branch with
};

struct OperationOptions {
    double margin = 0.01;          ///< below an edge: operate at (1 - margin) of it
    bool find_neighbours = false;  ///< at an edge: also the fold beside it, and the free orbits at the frequency
    std::span<const flow::ParameterVector> directions{};  ///< to differentiate an edge along
};

enum class OperationStatus : std::uint8_t {
    not_run,
    found,
    no_impact,  ///< there is no edge: the free motion stays clear of the stop, or jumps to one that does
    failed,     ///< the free motion could not be followed
};

/// A frequency to drive at, and what was met on the way to it.
struct Operation {
    OperationStatus status = OperationStatus::not_run;
    std::string reason;    ///< one sentence unless found
    OperatingPoint point;  ///< in the units of reports; frequencies only when found
    flow::System system;   ///< at that frequency
    flow::System scout;
    std::optional<boundary::Boundary> edge;  ///< nothing at a frequency that was given
    std::vector<double> d_omega;             ///< along the directions, (1 - margin) d_edge; empty without an edge
    /// When neighbours were asked for, at an edge: the free orbits at the operating frequency, with their clearance.
    std::optional<boundary::FreeOrbitsAt> free_orbits;
    std::optional<boundary::GrazingFold> fold;  ///< likewise, when the edge is a grazing
    [[nodiscard]] bool found() const { return status == OperationStatus::found; }
};

/// The operating point of a design. A frequency in the actuator's specification is taken as it is; without one the
/// design is driven the margin below its edge, the first frequency from above at which the free motion can no longer
/// stay clear of the stop (boundary/edge.hpp). Throws std::invalid_argument for an edge without a stop.
Operation operate(const DrivenDesign& design, const OperationOptions& options);

/// The motion that the design makes at its operating point (found): at a given frequency what is reached from rest,
/// below an edge the impacting orbit that the free motion falls to.
Reached reach_motion(const Operation& operation);

/// Free orbits that stay clear of the stop at the operating point (all amplitudes met on the branch from above);
/// those that operate() has found already, else followed for now.
boundary::FreeOrbitsAt free_orbits_at(const Operation& operation);

}  // namespace percuss::design
