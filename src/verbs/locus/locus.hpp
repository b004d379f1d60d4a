#pragma once
/// \file
/// Verb `locus`: a boundary followed in two parameters, the drive frequency and a key.
#include "boundary/boundary.hpp"
#include "branch/locus.hpp"
#include "verbs/study.hpp"

#include <optional>

namespace percuss::verbs {

struct LocusOptions {
    boundary::Kind kind = boundary::Kind::fold;
    std::optional<model::Key> along;
    std::optional<double> from;  ///< in the key's unit
    std::optional<double> to;
    int steps = 25;  ///< about so many round values of the key are among the points
    int max_points = 2000;
};

struct LocusResult {
    Ending ending = Ending::not_run;
    std::string reason;  ///< one sentence unless verified
    boundary::Kind kind = boundary::Kind::none;
    model::Key along{};
    double from = 0.0;
    double to = 0.0;
    std::vector<branch::Locus> curves;  ///< nondimensional but for the key's value
    long solves = 0;
    double periods = 0.0;
    double seconds = 0.0;
};

/// The boundaries of the main branch at `from`, each followed until the key leaves its range or the boundary ends; one
/// that lies on the curve of another is not followed again. Throws std::invalid_argument for a missing key or range.
LocusResult run_locus(const StudyProblem& problem, const LocusOptions& study, const Observer& observer,
                      const StopRequest& stop);

}  // namespace percuss::verbs
