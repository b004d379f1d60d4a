#pragma once
/// \file
/// Results as JSON documents. Numbers in SI, or nondimensional for [nondimensional] problems ("units" says which);
/// what is absent is null; every number reads back to the same bits.

#include "verbs/evaluate/evaluate.hpp"
#include "verbs/optimise/optimise.hpp"
#include "verbs/orbit/orbit.hpp"
#include "verbs/problem_file.hpp"

#include <string>

namespace percuss::verbs {

/// percuss/check/1: {"schema","units","problem","hash","settings":{key:{"value","unit","text","origin","trouble"}},
/// "derived":{name:{"value","unit","meaning"}},"troubles":[...]}; repeatable keys hold an array of such objects.
std::string check_document(const ProblemFile& problem);

/// percuss/evaluate/1
std::string evaluate_document(const ProblemFile& problem, const verbs::EvaluateResult& result);

/// percuss/orbit/1: the same without what belongs to an edge.
std::string orbit_document(const ProblemFile& problem, const verbs::OrbitResult& result);

/// percuss/optimise/1
std::string optimise_document(const ProblemFile& problem, const verbs::OptimiseStudyResult& result);

}  // namespace percuss::verbs
