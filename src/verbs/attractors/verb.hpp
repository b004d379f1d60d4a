#pragma once
/// \file
/// Verb `attractors`: what the table of verbs holds of it.

#include "verbs/verbs.hpp"

namespace percuss::verbs {

Verb attractors_verb();
problem::Section attractors_section();

}  // namespace percuss::verbs
