#pragma once
/// \file
/// The small tables of a results folder as CSV text; units in the headers.

#include "verbs/optimise/optimise.hpp"
#include "verbs/problem_file.hpp"

#include <string>

namespace percuss::verbs {

/// One row: design, operating point, quantities, their error estimates.
std::string quantities_csv(const ProblemFile& problem, const std::vector<std::pair<model::Key, double>>& design,
                           const design::Evaluation& evaluation);

/// One row per key: the derivative of every quantity with respect to it.
std::string gradients_csv(const ProblemFile& problem, const design::Evaluation& evaluation);

/// One row per value of the enumerated variable.
std::string layers_csv(const ProblemFile& problem, const verbs::OptimiseStudyResult& result);

/// One row per limit, with value and multiplier; SI or nondimensional.
std::string limits_csv(const ProblemFile& problem, const verbs::OptimiseStudyResult& result);

/// The design variables of a problem at its own values; all keys when there are no variables.
std::vector<std::pair<model::Key, double>> design_values(const design::Problem& problem);

}  // namespace percuss::verbs
