#pragma once
/// \file
/// Verb `orbit`: what the table of verbs holds of it.

#include "verbs/verbs.hpp"

namespace percuss::verbs {

Verb orbit_verb();
problem::Section orbit_section();

}  // namespace percuss::verbs
