#pragma once
/// \file
/// The uniqueness check of a design at its operating point, up to the tier that the problem asks for.

#include "design/evaluation.hpp"
#include "design/operating_point.hpp"

#include <string>

namespace percuss::design {

/// What is judged: the tuned orbit (stable, striking) at a found operating point.
struct JudgedCase {
    const Operation& operation;
    const orbit::Orbit& orbit;
    const model::Scales& scales;
    const Problem& problem;
    const numerics::CancelRequest& cancelled;
};

struct Judgement {
    Uniqueness uniqueness;
    std::string rejection;  ///< one sentence, empty unless the verdict is not_unique
};

/// Tier 1 (uniqueness.hpp); then, where it does not refute and the problem asks for starts, tier 2 (sampled_check.hpp).
Judgement judge(const JudgedCase& c);

}  // namespace percuss::design
