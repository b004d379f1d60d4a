#pragma once
/// \file
/// Verb `explore`: what the table of verbs holds of it.

#include "verbs/verbs.hpp"

namespace percuss::verbs {

Verb explore_verb();
problem::Section explore_section();

}  // namespace percuss::verbs
