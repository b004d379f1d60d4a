#pragma once
/// \file
/// Verb `branch`: what the table of verbs holds of it.

#include "verbs/verbs.hpp"

namespace percuss::verbs {

Verb branch_verb();
problem::Section branch_section();

}  // namespace percuss::verbs
