#pragma once
/// \file
/// Verb `sweep`: what the table of verbs holds of it.

#include "verbs/verbs.hpp"

namespace percuss::verbs {

Verb sweep_verb();
problem::Section sweep_section();

}  // namespace percuss::verbs
