#pragma once
/// \file
/// What all studies share: the problem with the optimiser's settings, a deadline, an observer, a row sink.

#include "design/evaluation.hpp"
#include "design/problem.hpp"

#include <cstdint>
#include <functional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace percuss::study {

struct OptimiserOptions {
    std::string method = "ipopt";  ///< names of optimise::methods()
    int starts = 2;                ///< local solves per layer count
    int samples = 32;              ///< space-filling designs looked at before, per layer count
    int max_evaluations = 4000;    ///< per layer count
    double tolerance = 1e-6;       ///< KKT residual at which a point is certified
};

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
/// True when the study must end early (deadline or interrupt).
using StopRequest = std::function<bool()>;

/// A table being written row by row; columns are declared once with their units.
struct Column {
    std::string name;
    std::string unit;
};
class RowSink {
public:
    RowSink() = default;
    RowSink(const RowSink&) = delete;
    RowSink& operator=(const RowSink&) = delete;
    virtual ~RowSink() = default;
    virtual void header(std::span<const Column> columns) = 0;
    virtual void row(std::span<const double> values) = 0;
};

/// How a study ended; maps onto the exit codes 0, 3, 4, 5, 130.
enum class Ending : std::uint8_t { not_run, verified, infeasible, not_certified, budget, some_failed, interrupted };

}  // namespace percuss::study
