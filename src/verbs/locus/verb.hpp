#pragma once
/// \file
/// Verb `locus`: what the table of verbs holds of it.

#include "verbs/verbs.hpp"

namespace percuss::verbs {

Verb locus_verb();
problem::Section locus_section();

}  // namespace percuss::verbs
