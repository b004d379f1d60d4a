#pragma once
/// \file
/// The starts that no periodic orbit has captured within the budget: long periods, aperiodic motions, and what remains
/// unclassified.

#include "attractor/block.hpp"
#include "attractor/motion.hpp"

#include <vector>

namespace percuss::attractor {

struct LeftoverOptions {
    int longest_period = 64;  ///< Newton's method is tried up to this period
    int most_aperiodic = 8;   ///< motions told apart; starts beyond stay unclassified
    ExponentOptions exponent{};
};

/// Judges leftovers one by one, in the order in which they are given. `known` may grow.
class LeftoverJudge {
public:
    LeftoverJudge(const Systems& systems, const Box& box, KnownOrbits& known, const LeftoverOptions& options)
        : systems_(systems),
          scale_(half_widths(box, systems.exact.states())),
          known_(known),
          options_(options) {}

    struct Verdict {
        int orbit = -1;      ///< a known periodic orbit,
        int aperiodic = -1;  ///< or an aperiodic motion, or neither: unclassified
    };
    /// First a known orbit that the motion is settling on, or a new one of long period; then an aperiodic motion met
    /// before whose strobed states it mixes with; then a run of its own, in which it may still be captured after all,
    /// and whose exponent decides.
    ///
    /// Two strobed histories of the same length are of one motion when the median distance from a point of one to the
    /// nearest of the other is, both ways, at most twice the median distance to the nearest other point of its own: for
    /// samples of one invariant set both medians estimate the same number.
    Verdict judge(const std::vector<flow::State>& history);

    [[nodiscard]] const std::vector<Motion>& aperiodic() const { return aperiodic_; }

private:
    [[nodiscard]] std::optional<int> settling_on(const std::vector<flow::State>& history) const;
    [[nodiscard]] std::optional<int> long_period(const std::vector<flow::State>& history);
    [[nodiscard]] std::optional<int> met_before(const std::vector<flow::State>& history) const;
    Verdict follow_on(const std::vector<flow::State>& history);

    const Systems& systems_;
    flow::State scale_;
    KnownOrbits& known_;
    const LeftoverOptions& options_;
    std::vector<Motion> aperiodic_;
    std::vector<std::vector<flow::State>> clouds_;  ///< strobed states of each aperiodic motion
};

}  // namespace percuss::attractor
