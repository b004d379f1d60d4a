#pragma once
/// \file
/// Results of verb `explore`, read from its journal alone; verb `merge` tells them in the same way.

#include "results/csv_table.hpp"
#include "verbs/explore/explore.hpp"
#include "verbs/explore/sensitivities.hpp"
#include "verbs/explore/survey.hpp"
#include "verbs/session.hpp"

#include <functional>
#include <string>
#include <vector>

namespace percuss::verbs {

inline constexpr const char* designs_file = "designs.csv";
inline constexpr const char* sensitivities_file = "sensitivities.csv";

/// What the documents tell besides the rows.
struct ExploreFacts {
    Ending ending = Ending::not_run;
    std::string reason;          ///< one sentence unless verified
    std::int64_t designs = 0;    ///< evaluated by this run
    double seconds = 0.0;        ///< it took
    bool is_in_a_hurry = false;  ///< interrupted: no sensitivities, and the table only if it takes no time
};

/// Files of a results folder besides result.json and report.html, those that SQLite may leave beside a journal
/// included.
std::vector<std::string> exploration_files(const ExploreOptions& options);

/// One pass over the journal: writes designs.csv (the row's number, the variables, the columns asked for; a row per
/// design that is there) and sensitivities.csv, and arranges the rest:
///
/// percuss/explore/1: {"schema","units","status":"done|stopped|incomplete","reason","samples" (rows in the table),
/// "wanted","seed","sampling","shard","statuses":{STATUS:count},"edge_kinds":{KIND:count},"columns":[],"feasible",
/// "best" and, without a feasible design, "nearest":{"row","design":{},"quantities":{},"status","cause",
/// "limits":[{"name","text","value","limit","distance"}]} (null: none),"limits":[{"name","text","violated","alone"}],
/// "sensitivities":[{"quantity","edge_kind","variable","first_order","first_order_lower","first_order_upper",
/// "dgsm_bound","dgsm_bound_lower","dgsm_bound_upper","active_direction","active_share","used","used_gradients"}],
/// "designs" (evaluated by this run),"seconds","designs_per_second"}
Outcome conclude_exploration(Session& session, const Exploration& exploration, const results::Journal& journal,
                             const ExploreFacts& facts);

}  // namespace percuss::verbs
