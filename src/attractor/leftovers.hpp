#pragma once
/// \file
/// The starts that no periodic orbit has captured within the budget: long periods, aperiodic motions, and what remains
/// unclassified.

#include "attractor/attractor.hpp"
#include "attractor/block.hpp"
#include "attractor/cloud.hpp"

#include <vector>

namespace percuss::attractor {

struct LeftoverOptions {
    int longest_period = 64;  ///< Newton's method is tried up to this period
    int most_runs = 16;       ///< motions followed on for their exponent; what needs more stays unclassified
    ExponentOptions exponent{};
};

/// Judges leftovers one by one, in the order in which they are given. `known` may grow.
class LeftoverJudge {
public:
    LeftoverJudge(const Systems& systems, const Box& box, KnownOrbits& known, const LeftoverOptions& options)
        : systems_(systems),
          scale_(distance_scale(systems.exact, box)),
          known_(known),
          options_(options) {}

    struct Verdict {
        int orbit = -1;      ///< a known periodic orbit,
        int aperiodic = -1;  ///< or an aperiodic motion, or neither: unclassified
    };
    /// First a known orbit that the motion is settling on, or a new one of long period; a motion that only creeps
    /// towards a known orbit stays unclassified; then a motion followed before on whose strobed states it lies; then a
    /// run of its own, in which it may still be captured after all, and whose exponent decides. A run that lies on the
    /// strobed states of an aperiodic motion met before is that motion.
    Verdict judge(const std::vector<flow::State>& history);

    [[nodiscard]] const std::vector<Attractor>& aperiodic() const { return aperiodic_; }

private:
    /// Where a motion that was followed on has been, and what it was.
    struct Path {
        Cloud cloud;
        Verdict verdict;
    };
    [[nodiscard]] std::optional<int> settling_on(const std::vector<flow::State>& history) const;
    [[nodiscard]] std::optional<int> long_period(const std::vector<flow::State>& history);
    [[nodiscard]] std::optional<Verdict> on_a_path(const std::vector<flow::State>& strobes) const;
    Verdict follow_on(const std::vector<flow::State>& history);
    Verdict recognise(const Wander& seen);

    const Systems& systems_;
    flow::State scale_;
    KnownOrbits& known_;
    const LeftoverOptions& options_;
    std::vector<Attractor> aperiodic_;
    std::vector<Path> paths_;
    int runs_ = 0;
};

}  // namespace percuss::attractor
