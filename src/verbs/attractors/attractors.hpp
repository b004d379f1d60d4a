#pragma once
/// \file
/// Verb `attractors`.

#include "attractor/ensemble.hpp"
#include "verbs/study.hpp"

#include <complex>
#include <optional>
#include <string>
#include <vector>

namespace percuss::verbs {

struct AttractorsOptions {
    int starts = 512;
    int cycles = 1000;  ///< budget of each start
    /// Box of the starts in the problem's units; nothing: after the stroke of the motion (attractor::ensemble_box).
    std::optional<std::vector<double>> lower;
    std::optional<std::vector<double>> upper;
};

/// A motion in the problem's units; attractor::Attractor tells what the entries mean.
struct AttractorReport {
    attractor::Kind kind = attractor::Kind::undecided;
    int period = 0;             ///< drive cycles, 0 for aperiodic motions
    std::vector<double> state;  ///< at theta = 0
    double peak_force = design::absent;
    double amplitude = design::absent;
    double x_max = design::absent;
    double x_min = design::absent;
    double contacts = design::absent;  ///< per period; absent for aperiodic motions
    double contacts_per_cycle = design::absent;
    std::vector<std::complex<double>> multipliers;  ///< largest first
    double max_multiplier = design::absent;
    attractor::Exponent exponent;           ///< per drive cycle
    attractor::Exponent exponent_per_time;  ///< per nondimensional time
    long starts = 0;
    attractor::Share share;
};

struct AttractorsResult {
    Ending ending = Ending::not_run;
    std::string reason;  ///< one sentence unless verified
    design::OperatingPoint operating_point;
    std::vector<AttractorReport> attractors;
    std::vector<double> lower;  ///< the box that was used
    std::vector<double> upper;
    long starts = 0;  ///< looked at
    long unclassified = 0;
    long failed = 0;  ///< of the unclassified
    double missed_share_bound = 1.0;
    double cycles = 0.0;  ///< drive cycles integrated
    double seconds = 0.0;
};

/// At the given drive frequency, or at (1 - margin) times the edge; the orbit reached there is then known beforehand
/// and gives the box its size. The ending is verified when every start was classified, not_certified when some were
/// not, interrupted when stopped, infeasible without an edge. Throws std::invalid_argument for a bad box.
AttractorsResult run_attractors(const StudyProblem& problem, const AttractorsOptions& study, const Observer& observer,
                                const StopRequest& stop);

}  // namespace percuss::verbs
