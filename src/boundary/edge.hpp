#pragma once
/// \file
/// The edge below which an actuator strikes for certain: coming down in frequency, the first boundary of the free
/// motion at which it can no longer stay clear of the stop.

#include "boundary/free_branch.hpp"
#include "boundary/grazing_fold.hpp"

#include <span>
#include <string>
#include <vector>

namespace percuss::boundary {

struct EdgeOptions {
    double start_ratio = 3.0;    ///< the branch is followed down from this times the linear resonance
    double lowest_ratio = 0.05;  ///< and given up at this times the linear resonance
    int settle_cycles = 300;     ///< beyond a fold, flip or torus: cycles simulated to see where the motion goes
    double below = 1e-3;         ///< how far below such a boundary that simulation is done, relative
    int max_steps = 600;
};

enum class EdgeStatus : std::uint8_t {
    not_run,
    found,
    no_impact,  ///< the free motion never reaches the stop, or jumps to one that does not
    failed,
};

struct Edge {
    EdgeStatus status = EdgeStatus::not_run;
    std::string reason;          ///< one sentence unless found
    Boundary boundary;           ///< kind, omega, state, derivatives
    double searched_from = 0.0;  ///< drive frequencies between which the free motion was followed
    double searched_to = 0.0;
    int steps = 0;
};

/// Follows the free orbit down and applies the rule: a grazing of the stable free orbit is the edge; at a fold, flip or
/// torus met before, the motion is let settle just below, and it is an edge of that kind if the settled motion strikes,
/// else there is no impact (the tip of a softening resonance). The branch is left standing at the edge, so that a
/// caller can follow it on.
Edge find_edge(FreeBranch& branch, const flow::System& system, const EdgeOptions& options,
               std::span<const flow::ParameterVector> directions);

/// Every point of the free branch at `omega`, met by following it on from where it stands until it has passed below
/// `lowest`. `complete` is false when it could not be followed that far.
struct FreeOrbitsAt {
    std::vector<FreePoint> points;
    bool complete = false;
};
FreeOrbitsAt free_orbits_at(FreeBranch& branch, const flow::System& system, double omega, double lowest);

}  // namespace percuss::boundary
