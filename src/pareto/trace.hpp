#pragma once
/// \file
/// The front of two objectives.

#include "pareto/anchors.hpp"
#include "pareto/corrector.hpp"

#include <string>
#include <vector>

namespace percuss::pareto {

struct FrontOptions {
    double tolerance = 1e-2;              ///< on the error bound of the hypervolume, relative
    int points = 100;                     ///< at most
    int max_evaluations = 20000;          ///< calls of MultiObjective::evaluate
    double certificate_tolerance = 1e-6;  ///< on FrontCertificate
    bool locate_changes = true;           ///< add the points at which limits and bounds begin and cease to bind
    SearchOptions search = {};            ///< of the anchors and of what tracing cannot join
    numerics::CancelRequest cancelled = {};
};

/// The piece between neighbours of the front, where an unknown part of it may lie.
struct Gap {
    std::size_t left = 0;   ///< index of its left point; the right one is the next
    double area = 0.0;      ///< of the rectangle in which the front may still pass, as a part of ideal..nadir
    bool jump = false;      ///< a search found nothing between the two points (but in the remaining area)
    bool given_up = false;  ///< neither tracing nor search could divide it, and not because it is empty
};

/// A limit or bound that begins or ceases to bind along the front, towards larger f_1.
struct ActiveChange {
    bool is_bound = false;
    int index = 0;  ///< of the limit, or of the variable
    bool begins = false;
    std::size_t point = 0;  ///< index of the point of the front at the change
    double width = 0.0;     ///< distance, in ideal..nadir units, within which the change was located
};

struct Front {
    enum class Status : std::uint8_t {
        not_run,
        converged,   ///< the error bound is below the tolerance
        points,      ///< as many points as allowed, and the bound is above the tolerance
        unresolved,  ///< gaps that neither tracing nor search could divide keep the bound above the tolerance
        single,      ///< the objectives do not conflict: one point is best in all
        infeasible,  ///< nothing feasible was found
        budget,      ///< cut short (budget or cancelled): what was known by then
    };
    Status status = Status::not_run;
    std::vector<FrontPoint> points;  ///< by rising f_1; none dominates another
    std::vector<Gap> gaps;           ///< two objectives: one between each two neighbours
    std::vector<ActiveChange> changes;
    Vector ideal;              ///< best value of each objective at the anchors
    Vector nadir;              ///< worst value of each objective at the anchors; reference point of the hypervolume
    double hypervolume = 0.0;  ///< as a part of the box ideal..nadir
    /// How much more the true front may cover, relative to the most it may cover: the sum of the gaps. It relies on the
    /// points being globally optimal.
    double error_bound = 1.0;
    int evaluations = 0;
    int failures = 0;
    int anchor_evaluations = 0;  ///< of those, by the anchors
    int search_evaluations = 0;  ///< of those, by searches where tracing could not go on
    int searches = 0;
    int compared = 0;  ///< feasible points of the archive that no point of the front is beaten by
    std::string message;
};
[[nodiscard]] const char* to_string(Front::Status status);

/// Traces the front of two objectives:
///
///  1. Anchors (anchors.hpp).
///  2. From each anchor, and from each point that a search finds, predictor and corrector along the front
///  (corrector.hpp):
///     the target is a step ahead on the tangent that the weights give, as in pseudo-arclength continuation, with the
///     normal as direction (Hillermeier, Nonlinear Multiobjective Optimization, 2001, chapter 6, without second
///     derivatives), begun where a cubic through the last four points expects it. Limits and bounds begin and cease to
///     bind inside the corrector. A step that fails, turns back or lands on a dominated point is halved three times;
///     then tracing ends there.
///  3. The points at which limits and bounds begin and cease to bind, by Illinois' regula falsi on multiplier or slack.
///  4. The gap of largest area is divided at the middle of its chord by the corrector, from either end; where that
///  fails
///     (a jump of the front, a second piece), by a global search of y_1 subject to y_2 below the gap's upper end, from
///     which tracing goes on. Until the error bound is met.
///  5. A feasible point of the archive that beats a point of the front shows that a piece was optimal only locally: the
///     better piece is sought from it, and traced.
///
/// Fronts are deterministic for a seed. Throws std::invalid_argument for other than two objectives and options out of
/// range, and whatever the problem throws.
[[nodiscard]] Front trace_front(MultiObjective& problem, const FrontOptions& options);

/// Throws std::invalid_argument, naming field, value and what is allowed.
void check(const FrontOptions& options);

}  // namespace percuss::pareto
