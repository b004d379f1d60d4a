#pragma once
/// \file
/// The limits on the integrations of a verb, and what becomes of a run that they cut short.

#include "design/evaluation.hpp"
#include "flow/flow.hpp"
#include "verbs/study.hpp"

#include <algorithm>

namespace percuss::verbs {

/// A cost with limits: cancelled on request, and a budget of steps that ends stiff or absurd problems. The budget is
/// that of an evaluation (20 million: some seconds to half a minute), or more where the user asked for more drive
/// cycles than that leaves `steps_per_cycle` for.
inline flow::Cost limited_cost(const numerics::CancelRequest& cancelled, double cycles = 0.0,
                               double steps_per_cycle = 0.0) {
    flow::Cost cost;
    cost.cancelled = cancelled;
    cost.step_budget = std::max(design::default_step_budget, static_cast<long>(cycles * steps_per_cycle));
    return cost;
}

/// True when a limit has ended the run that `cost` was charged for; `result` then says so, not what failed because of
/// it.
template <class Result>
bool cut_short(const flow::Cost& cost, Result& result) {
    const flow::Status limit = cost.allowance();
    if (limit == flow::Status::ok) { return false; }
    const bool cancelled = limit == flow::Status::cancelled;
    result.ending = cancelled ? Ending::interrupted : Ending::budget;
    result.reason = cancelled ? "stopped before the end" : design::reason_of_limit(cost);
    return true;
}

}  // namespace percuss::verbs
