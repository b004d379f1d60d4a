#pragma once
/// \file
/// Angular frequencies as results tell them: in rad/s for problems in SI, with the nondimensional one beside it.

#include "design/evaluation.hpp"
#include "problem/problem_file.hpp"
#include "results/json.hpp"

#include <string_view>

namespace percuss::verbs {

/// One angular frequency: "omega" [rad/s], "omega_nondimensional"; of a nondimensional problem "omega" alone.
/// `time`: the unit of time Gamma [s], omega = omega_nondimensional / Gamma.
void add_omega(const problem::ProblemFile& problem, double omega_nondimensional, double time, results::Json& out);

/// A nondimensional angular frequency, or a difference or error of one, in the problem's units.
double in_user_units(const problem::ProblemFile& problem, double omega_nondimensional, double time);

/// The unit of time at an operating point [s], from its drive frequency f = omega / (2 pi Gamma); NaN without one.
double time_unit(const design::OperatingPoint& point);

/// Which members of an operating point a document has.
enum class PointMembers : std::uint8_t { all, without_fold, without_edge };
results::Json operating_point_of(const problem::ProblemFile& problem, const design::OperatingPoint& point,
                                 PointMembers members);

}  // namespace percuss::verbs
