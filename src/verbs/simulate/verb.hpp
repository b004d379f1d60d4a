#pragma once
/// \file
/// Verb `simulate`: what the table of verbs holds of it.

#include "verbs/verbs.hpp"

namespace percuss::verbs {

Verb simulate_verb();
problem::Section simulate_section();

}  // namespace percuss::verbs
