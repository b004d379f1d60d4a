#pragma once
/// \file
/// Tier 2 of the uniqueness check: does any of many independent starts lead to another motion than the tuned one?

#include "design/evaluation.hpp"
#include "flow/flow.hpp"
#include "model/specification.hpp"
#include "numerics/cancel.hpp"
#include "orbit/orbit.hpp"

#include <string>

namespace percuss::design {

struct SampledCase {
    const flow::System& system;  ///< at the operating frequency
    const flow::System& scout;   ///< the same, looser
    const model::Scales& scales;
    const orbit::Orbit& orbit;  ///< the tuned one, stable
    double amplitude = 0.0;     ///< of it, nondimensional: the box of starts is made for it
    const Sampling& sampling;
    const numerics::CancelRequest& cancelled;
};

/// Uniform starts over the box of attractor/box.hpp, each followed until it is captured (attractor/ensemble.hpp). None
/// of N elsewhere: verdict unique, which means not refuted; other basins then hold less than missed_share_bound of the
/// box at 95 % confidence. One elsewhere: not_unique, with every motion that the N starts lead to and its share. Starts
/// that could not be classified, or a motion whose kind is undecided, leave it not_checked; so does being cancelled.
struct TierTwo {
    Uniqueness uniqueness;
    std::string rejection;  ///< empty unless not_unique
};
TierTwo check_tier_two(const SampledCase& c);

}  // namespace percuss::design
