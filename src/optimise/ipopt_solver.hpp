#pragma once
/// \file
/// Adapter to Ipopt.

#include "optimise/guard.hpp"
#include "optimise/result.hpp"
#include "optimise/solver_answer.hpp"

namespace percuss::optimise {

/// One run of Ipopt (Waechter and Biegler, Math. Program. 106, 2006) with a limited-memory Hessian, from a start
/// within the bounds. A failed evaluation makes Ipopt shorten its step; a halted guard ends the run. A start next to
/// a region that cannot be evaluated is tried again without Ipopt's push away from the bounds. Nothing is thrown
/// but std::bad_alloc: errors of the evaluator wait in the guard.
///
/// May be called from several threads: Debian's Ipopt with MUMPS is not reentrant, so one lock for the whole process
/// is held while Ipopt computes, and released while the evaluator does.
[[nodiscard]] SolverAnswer run_ipopt(Guard& guard, const Vector& start, const Options& options);

}  // namespace percuss::optimise
