#include "verbs/frequencies.hpp"

#include <numbers>

namespace percuss::verbs {

using problem::ProblemFile;
using results::Json;

double in_user_units(const ProblemFile& problem, double omega_nondimensional, double time) {
    return problem::is_nondimensional(problem.design) ? omega_nondimensional : omega_nondimensional / time;
}

void add_omega(const ProblemFile& problem, double omega_nondimensional, double time, Json& out) {
    out["omega"] = in_user_units(problem, omega_nondimensional, time);
    if (!problem::is_nondimensional(problem.design)) { out["omega_nondimensional"] = omega_nondimensional; }
}

double time_unit(const design::OperatingPoint& point) {
    return point.omega / (2.0 * std::numbers::pi * point.drive_frequency);
}

Json operating_point_of(const ProblemFile& problem, const design::OperatingPoint& point, PointMembers members) {
    const double time = time_unit(point);
    const bool plain = problem::is_nondimensional(problem.design);
    Json out = {{"drive_frequency", point.drive_frequency}};
    add_omega(problem, point.omega, time, out);
    if (members != PointMembers::without_edge) {
        out["edge_kind"] = design::to_string(point.edge_kind);
        out["edge_omega"] = in_user_units(problem, point.edge_omega, time);
        if (!plain) { out["edge_omega_nondimensional"] = point.edge_omega; }
    }
    if (members != PointMembers::without_fold) { out["fold_offset"] = point.fold_offset; }
    out["margin"] = point.margin;
    return out;
}

}  // namespace percuss::verbs
