#pragma once
/// \file
/// Verb `evaluate`: what the table of verbs holds of it.

#include "verbs/verbs.hpp"

namespace percuss::verbs {

Verb evaluate_verb();

}  // namespace percuss::verbs
