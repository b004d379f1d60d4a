#pragma once
/// \file
/// Verb `merge`: what the table of verbs holds of it.

#include "verbs/verbs.hpp"

namespace percuss::verbs {

Verb merge_verb();

}  // namespace percuss::verbs
