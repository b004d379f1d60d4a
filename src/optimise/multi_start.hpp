#pragma once
/// \file
/// The best of several local optima, with its certificate; or the reason why there is none.

#include "optimise/certificate.hpp"
#include "optimise/result.hpp"

#include <vector>

namespace percuss::optimise {

struct MultiStartOptions {
    Options solver = {};                   ///< method of the local solves; max_evaluations is for everything together
    int candidates = 32;                   ///< points of a Halton sequence looked at first, values only
    int starts = 2;                        ///< local solves from the best of them
    double separation = 0.15;              ///< least distance between starts, as a part of the box (infinity norm)
    std::vector<Vector> warm_starts = {};  ///< solved from too, first, as given
    double certificate_tolerance = 1e-6;
    int polish_rounds = 4;         ///< most solves that try to bring the certificate below its tolerance
    double elastic_floor = -1e-3;  ///< how far inside the constraints the elastic phase goes, when it gets there
    CertificateOptions certificate = {};
};

struct MultiStartResult {
    /// converged: feasible and certified. infeasible: nothing feasible was found; x violates its worst constraint as
    /// little as any point seen, and the largest entry of `constraints` there is the limit that cannot be met.
    /// budget: the search was cut short, whatever was known by then. failed: feasible but not certified, or nothing
    /// could be evaluated. x and its values are those of the best point seen; x is empty if there is none.
    Outcome best;
    /// At best.x. Where that is not feasible, of the elastic problem: the residual tells whether no small change
    /// reduces the largest violation, and multipliers (which add up to 1) name the constraints in conflict.
    Certificate certificate;
    std::vector<Outcome> locals;  ///< of the local solves, in the order they were made, without elastic and polish
    int candidates_evaluated = 0;
    int candidates_failed = 0;  ///< of those evaluated
};

/// Searches the box:
///
///  1. Space-filling candidates are evaluated, and ranked: feasible ones by objective, then the others by
///     infeasibility. If all `candidates` fail, the sequence goes on, up to eight times as far.
///  2. solver.method from the warm starts and from the `starts` best candidates that keep `separation`. (A global
///     method is run once, from the best.)
///  3. Nothing feasible: an elastic phase (elastic_nlp.hpp) from the least infeasible points, and a local solve if
///     it finds a way in. Else the problem is reported infeasible.
///  4. Polish of the best point by slsqp and ipopt in turn, until the certificate holds or neither improves it (an
///     optimum on a kink, or at the edge of what can be evaluated, has no certificate).
///
/// Budget: of the evaluations left, each solve may use an equal share, at least 50, one share being kept for the
/// polish. One memory serves all phases: a point is never evaluated twice. Deterministic for a given seed. Throws as
/// minimise; and std::invalid_argument when there are neither candidates nor warm starts, for infinite bounds with
/// candidates, and for options out of range.
[[nodiscard]] MultiStartResult multi_start(Nlp& nlp, const MultiStartOptions& options);

}  // namespace percuss::optimise
