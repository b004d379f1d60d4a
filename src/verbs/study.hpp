#pragma once
/// \file
/// What all runs of verbs share: the problem with the optimiser's settings, an observer, how it ended.

#include "design/evaluation.hpp"
#include "design/problem.hpp"
#include "numerics/cancel.hpp"
#include "results/row_sink.hpp"
#include "verbs/optimiser_options.hpp"

#include <cstdint>
#include <functional>
#include <string>
#include <string_view>
#include <vector>

namespace percuss::verbs {

struct StudyProblem {
    design::Problem design;
    OptimiserOptions optimiser;
    std::uint64_t seed = 1;
    int jobs = 1;
};

/// The problem as the engine sees it: with the study's seed and threads for what is sampled.
inline design::Problem design_problem(const StudyProblem& problem) {
    design::Problem design = problem.design;
    design.sampling.seed = problem.seed;
    design.sampling.jobs = problem.jobs;
    return design;
}

/// Progress: called now and then with the share done (0..1, negative if unknown) and a short line. Returning is all
/// that is asked of it.
using Observer = std::function<void(double, std::string_view)>;
using StopRequest = numerics::CancelRequest;
using results::Column;
using results::RowSink;

/// How a run ended; cli maps it onto the exit codes.
enum class Ending : std::uint8_t {
    not_run,
    verified,
    infeasible,
    not_certified,
    budget,
    some_failed,
    interrupted,
    refused,  ///< verb check: the problem has troubles
};

}  // namespace percuss::verbs
