#pragma once
/// \file
/// Tier 1 of the uniqueness check: is the tuned orbit alone among the period-1 motions?

#include "boundary/edge.hpp"
#include "design/evaluation.hpp"
#include "design/reach.hpp"

#include <optional>
#include <string>

namespace percuss::design {

/// What tier 1 looks at, nondimensional but for the scales.
struct UniquenessCase {
    const flow::System& system;  ///< at the operating frequency
    const model::Scales& scales;
    const orbit::Orbit& orbit;                    ///< the tuned one, stable
    const boundary::FreeOrbitsAt& free_orbits;    ///< at the operating frequency
    const boundary::GrazingFold* fold = nullptr;  ///< null: another kind of edge, or a frequency that was given
    double fold_offset = 0.0;                     ///< relative; of a fold that was found
    double margin = 0.0;
};

/// No stable free orbit at the operating frequency, no fold beside the edge beyond the margin, and the motion from rest
/// is the tuned one; where no fold is located two more starts must lead to it too. The verdict is unique, not_unique
/// (with `rejection`, and the attractor where one was met) or not_checked where something could not be followed;
/// `checked` says which in one sentence.
struct TierOne {
    Uniqueness uniqueness;
    std::string rejection;  ///< empty unless not_unique
};
TierOne check_tier_one(const UniquenessCase& c);

}  // namespace percuss::design
