#pragma once
/// \file
/// Adapter to NLopt.

#include "optimise/method.hpp"

namespace percuss::optimise {

/// The methods of NLopt (Johnson, version 2.7) that are offered, local ones first. A failed evaluation is seen by NLopt
/// as `failure_penalty` with zero gradient and every constraint violated by 1. The random numbers are seeded for each
/// run, in its thread. A run throws std::runtime_error when the linked NLopt was built without the method.
[[nodiscard]] std::vector<Method> nlopt_methods();

}  // namespace percuss::optimise
