#pragma once
/// \file
/// One optimisation by a method given by name.

#include "optimise/result.hpp"

#include <string>
#include <vector>

namespace percuss::optimise {

/// Names that Options::method may have. All find a local optimum from the start, except where stated:
///
///     ipopt       interior point with a limited-memory quasi-Newton Hessian (Ipopt; Waechter and Biegler 2006)
///     slsqp       sequential quadratic programming (Kraft 1994); NLopt, as all that follow
///     mma ccsaq   moving asymptotes; conservative convex separable approximation (Svanberg 2002)
///     cobyla      linear models, no derivatives (Powell 1994)
///     lbfgs       quasi-Newton (Nocedal 1980)*
///     bobyqa      quadratic models, no derivatives (Powell 2009)*
///     neldermead, subplex, praxis   direct search, no derivatives (Box 1965, Rowan 1990, Brent 1973)*
///     direct-l    dividing rectangles, global (Gablonsky and Kelley 2001)
///     crs2        controlled random search, global (Kaelo and Ali 2006)*
///     isres       evolution strategy, global (Runarsson and Yao 2005)
///     esch        evolutionary, global (Silva Santos 2010)*
///     mlsl        multi-level single-linkage with slsqp, global (Kucherenko and Sytsko 2005)*
///     stogo       branch and bound with gradients, global (Madsen et al. 1998)*
///     ags         space-filling curve, global, at most 10 variables and 10 constraints (Sovrasov 2019)
///
/// * without constraints of its own: where there are any, it minimises NLopt's augmented Lagrangian (Birgin and
/// Martinez 2008). The global methods have `global_share` of the budget, then slsqp polishes their best point with
/// the rest; they need finite bounds.
[[nodiscard]] const std::vector<std::string>& methods();

/// Whether the method searches the whole box; the start is then of little or no importance.
[[nodiscard]] bool is_global(const std::string& method);

/// Throws std::invalid_argument, naming field, value and what is allowed, for an unknown method or a number out of
/// range.
void check(const Options& options);

/// Minimises from `start` (n entries, clipped to the bounds).
///
/// The answer is not the solver's word: the archive of all points seen is what counts, after the solver's last point
/// was moved to feasibility if it was slightly off (see repair.hpp). Of points as good as each other within the
/// feasibility tolerance the solver's is taken, because its gradient is the smaller one.
///
/// Numerical failure is in Outcome::status. Throws std::invalid_argument for an unknown method, empty bounds, a start
/// of the wrong size or not a number, options out of range, and whatever Nlp::evaluate throws.
[[nodiscard]] Outcome minimise(Nlp& nlp, const Vector& start, const Options& options);

}  // namespace percuss::optimise
