#pragma once
/// \file
/// A block of starts followed until each is captured by a stable periodic orbit or the budget of cycles is over. What
/// comes out depends on the block's own starts and on what was known before alone.

#include "attractor/box.hpp"
#include "attractor/known.hpp"
#include "numerics/cancel.hpp"

#include <vector>

namespace percuss::attractor {

inline constexpr int block_size = 64;

struct FollowOptions {
    int max_cycles = 1000;    ///< budget of each start
    int longest_period = 12;  ///< of orbits looked for while following
    int memory = 256;         ///< strobed states kept of each start
    bool end_at_new = false;  ///< end once an orbit was found that was not known before
    numerics::CancelRequest cancelled{};
};

/// What became of one start.
enum class Fate : std::uint8_t {
    pending,
    captured,
    unsettled,  ///< the budget is over
    failed,     ///< the flow failed: chatter, divergence
};

struct Follower {
    Fate fate = Fate::pending;
    int orbit = -1;                    ///< when captured: number among what was known before, then what was found
    std::vector<flow::State> history;  ///< when unsettled: the last strobed states, in the order of time
};

struct BlockResult {
    bool cancelled = false;  ///< by request: nothing else means anything
    std::vector<Follower> followers;
    KnownOrbits found;  ///< in the order of discovery, none of them known before
    double cycles = 0.0;
};

/// Strobe by strobe: advance all starts, take out the captured ones, and now and then, at fixed cycles, try Newton's
/// method on those that nearly recur. `known` are the orbits whose traps are there from the beginning.
BlockResult follow_block(const Systems& systems, const Box& box, std::span<const flow::State> starts,
                         const KnownOrbits& known, const FollowOptions& options);

}  // namespace percuss::attractor
