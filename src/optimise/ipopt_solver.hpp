#pragma once
/// \file
/// Adapter to Ipopt.

#include "optimise/method.hpp"

namespace percuss::optimise {

/// Ipopt (Waechter and Biegler, Math. Program. 106, 2006) with a limited-memory Hessian, as the one row "ipopt". A
/// failed evaluation makes Ipopt shorten its step; a halted guard ends the run. A start next to a region that cannot be
/// evaluated is tried again without Ipopt's push away from the bounds. Nothing is thrown but std::bad_alloc.
///
/// May be called from several threads: Debian's Ipopt with MUMPS is not reentrant, so one lock for the whole process
/// is held while Ipopt computes, and released while the evaluator does.
[[nodiscard]] std::vector<Method> ipopt_methods();

}  // namespace percuss::optimise
