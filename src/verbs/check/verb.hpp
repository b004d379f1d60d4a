#pragma once
/// \file
/// Verb `check`: what the table of verbs holds of it.

#include "verbs/verbs.hpp"

namespace percuss::verbs {

Verb check_verb();

}  // namespace percuss::verbs
