#pragma once
/// \file
/// One function per verb, from parsed arguments to exit code. They throw problem::ProblemError or std::invalid_argument
/// for bad input.

#include "cli/arguments.hpp"

namespace percuss::cli {

int check(const Arguments& arguments);
int simulate(const Arguments& arguments);
int sweep(const Arguments& arguments);
int attractors(const Arguments& arguments);
int orbit(const Arguments& arguments);
int evaluate(const Arguments& arguments);
int optimise(const Arguments& arguments);
int branch(const Arguments& arguments);
int locus(const Arguments& arguments);

}  // namespace percuss::cli
