#pragma once
/// \file
/// Work of an ensemble, counted apart from that of its caller.

#include "attractor/known.hpp"

namespace percuss::attractor {

/// The systems of a caller with a cost of their own, which begins at zero and has the caller's limits: threads count
/// without meeting, and what one part of an ensemble may cost does not depend on what other parts have cost.
struct CountedSystems {
    flow::Cost cost;
    flow::System exact;
    flow::System scout;
    Systems systems{exact, scout};

    explicit CountedSystems(const Systems& from) : exact(from.exact), scout(from.scout) {
        if (from.exact.cost != nullptr) {
            cost.cancelled = from.exact.cost->cancelled;
            cost.step_budget = from.exact.cost->step_budget;
        }
        exact.cost = &cost;
        scout.cost = &cost;
    }
    /// For what is left to be done once the limits have cut the work short: measuring what was found.
    void lift_limits() {
        cost.cancelled = {};
        cost.step_budget = flow::Cost{}.step_budget;
    }
    CountedSystems(const CountedSystems&) = delete;
    CountedSystems& operator=(const CountedSystems&) = delete;
};

}  // namespace percuss::attractor
