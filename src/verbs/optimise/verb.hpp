#pragma once
/// \file
/// Verb `optimise`: what the table of verbs holds of it.

#include "verbs/verbs.hpp"

namespace percuss::verbs {

Verb optimise_verb();

/// Throws problem::ProblemError for a problem without variables or without exactly one objective.
void require_one_objective(const design::Problem& design);

}  // namespace percuss::verbs
