#include "verbs/branch/branch_results.hpp"

#include "design/integrators.hpp"
#include "model/number_text.hpp"
#include "results/csv_table.hpp"
#include "results/json.hpp"
#include "verbs/frequencies.hpp"

#include <algorithm>
#include <cmath>

namespace percuss::verbs {

using problem::ProblemFile;
using problem::text_of;
using problem::units_of;
using results::Block;
using results::cell;
using results::Column;
using results::csv_text;
using results::Json;
using results::Presentation;

namespace {

using boundary::Kind;
using branch::BoundaryPoint;
using branch::Branch;
using branch::Point;
using design::Quantity;

std::string_view kind_name(const BoundaryPoint& found) { return boundary::to_string(found.kind); }

/// A point in the problem's units.
struct UserPoint {
    double omega = 0.0;  ///< nondimensional
    double time = 1.0;   ///< unit of time there [s]
    double drive_frequency = 0.0;
    double value = 0.0;  ///< of the key along which the branch was followed
    double amplitude = 0.0;
    double x_max = 0.0;
    double x_min = 0.0;
    double peak_force = 0.0;
};

/// Along a key of the design the scales themselves change from point to point.
UserPoint to_user(const ProblemFile& problem, const BranchResult& result, const Point& p) {
    const model::Scales scales = scales_at(problem.design, result, p.parameter);
    UserPoint out;
    out.omega = p.omega;
    out.time = scales.time;
    out.drive_frequency = design::drive_frequency(p.omega, scales);
    out.value = p.parameter;
    out.amplitude = scales.length * p.amplitude();
    out.x_max = scales.length * p.x_max;
    out.x_min = scales.length * p.x_min;
    out.peak_force = scales.force * p.peak_force;
    return out;
}

Json point_of(const ProblemFile& problem, const BranchResult& result, const Point& p) {
    const UserPoint user = to_user(problem, result, p);
    Json out;
    add_omega(problem, user.omega, user.time, out);
    out["drive_frequency"] = user.drive_frequency;
    if (!result.along_frequency) { out["value"] = user.value; }
    out["amplitude"] = user.amplitude;
    out["x_max"] = user.x_max;
    out["x_min"] = user.x_min;
    out["peak_force"] = user.peak_force;
    out["contacts"] = p.contacts.size();
    out["max_multiplier"] = p.max_multiplier();
    out["stable"] = p.stable();
    return out;
}

/// Number of the boundary among those of all branches.
int global_index(const BranchResult& result, std::size_t branch, int local) {
    int index = local;
    for (std::size_t i = 0; i < branch; ++i) { index += static_cast<int>(result.branches[i].boundaries.size()); }
    return index;
}

/// A difference in what is varied: of omega in the unit in which points tell it.
double told(const ProblemFile& problem, const BranchResult& result, double difference, double time) {
    return result.along_frequency ? in_user_units(problem, difference, time) : difference;
}

/// d(omega)/d(key) in rad/s from that of the nondimensional w: omega = w / Gamma, and Gamma depends on the key.
double told_derivative(const ProblemFile& problem, const BranchResult& result, const Point& p, double d,
                       model::Key key) {
    if (!result.along_frequency || problem::is_nondimensional(problem.design)) { return d; }
    const double time = model::scale(problem.design.actuator).scales.time;
    const double d_time = model::scale_derivative(problem.design.actuator, key).scales.time;
    return d / time - p.omega * d_time / (time * time);
}

/// Boundary i of branch b; gradients where they were asked for.
Json boundary_of(const ProblemFile& problem, const BranchResult& result, std::size_t b, std::size_t i) {
    const BoundaryPoint& found = result.branches[b].boundaries[i];
    const UserPoint user = to_user(problem, result, found.point);
    const model::Scales scales = scales_at(problem.design, result, found.point.parameter);
    Json out = {{"kind", kind_name(found)}, {"branch", b}};
    add_omega(problem, user.omega, user.time, out);
    out["drive_frequency"] = user.drive_frequency;
    if (!result.along_frequency) { out["value"] = user.value; }
    out["uncertainty"] = told(problem, result, found.uncertainty, user.time);
    out["peak_force"] = user.peak_force;
    out["amplitude"] = user.amplitude;
    out["contacts"] = found.point.contacts.size();
    out["max_multiplier"] = found.point.max_multiplier();
    out["state"] = design::to_user(found.state_at_zero, scales, problem::problem_states(problem));
    out["jump_with"] = found.partner >= 0 ? Json(global_index(result, b, found.partner)) : Json(nullptr);
    if (found.kind == Kind::flip) { out["symmetry"] = found.of_half_cycle; }
    if (b < result.gradients.size() && i < result.gradients[b].size()) {
        Json gradients = Json::object();
        for (std::size_t k = 0; k < result.gradient_keys.size(); ++k) {
            const model::Key key = result.gradient_keys[k];
            const double d = result.gradients[b][i].d_parameter[k];
            gradients[model::key_info(key).name] = told_derivative(problem, result, found.point, d, key);
        }
        out["gradients"] = {{result.along_frequency ? "omega" : "value", std::move(gradients)}};
    }
    return out;
}

std::string along_name(const BranchResult& result) {
    return result.along_frequency ? "drive frequency" : std::string(model::key_info(result.along).name);
}

std::string place_text(const ProblemFile& problem, const BranchResult& result, const Point& p) {
    const UserPoint user = to_user(problem, result, p);
    if (!result.along_frequency) { return problem::text_of(result.along, user.value); }
    const std::string omega = model::number_text(user.omega, 12);
    return units_of(problem) == "si"
             ? omega + " (" + text_of(problem, Quantity::drive_frequency, user.drive_frequency) + ")"
             : omega;
}

std::string end_text(branch::End end, const std::string& reason) {
    return std::string(branch::to_string(end)) + (reason.empty() ? "" : " (" + reason + ")");
}

Block boundaries_block(const ProblemFile& problem, const BranchResult& result) {
    Block block{"Boundaries",
                "",
                {"branch", "kind", result.along_frequency ? "omega" : along_name(result), "uncertainty", "peak force",
                 "contacts", "remark"},
                {}};
    for (std::size_t b = 0; b < result.branches.size(); ++b) {
        for (const BoundaryPoint& found : result.branches[b].boundaries) {
            std::string remark;
            if (found.partner >= 0) {
                const auto& other = result.branches[b].boundaries[static_cast<std::size_t>(found.partner)];
                const double apart = std::abs(found.point.parameter - other.point.parameter);
                remark =
                    "one jump with the " + std::string(kind_name(other)) + " " + model::number_text(apart, 3) + " away";
            } else if (found.of_half_cycle) {
                remark = "the mirror symmetry is lost";
            }
            block.rows.push_back(
                {std::to_string(b), std::string(kind_name(found)), place_text(problem, result, found.point),
                 model::number_text(found.uncertainty, 2),
                 text_of(problem, Quantity::peak_force, to_user(problem, result, found.point).peak_force),
                 std::to_string(found.point.contacts.size()), remark});
        }
    }
    return block;
}

/// Stretches of a branch that are stable, with their ends.
Block stable_block(const ProblemFile& problem, const BranchResult& result) {
    Block block{"Branches", "", {"branch", "period", "points", "stable points", "from", "to", "begins", "ends"}, {}};
    for (std::size_t b = 0; b < result.branches.size(); ++b) {
        const Branch& branch = result.branches[b];
        if (branch.points.empty()) { continue; }
        const auto stable =
            std::count_if(branch.points.begin(), branch.points.end(), [](const Point& p) { return p.stable(); });
        const auto [low, high] =
            std::minmax_element(branch.points.begin(), branch.points.end(),
                                [](const Point& p, const Point& q) { return p.parameter < q.parameter; });
        std::string begins = branch.from_branch >= 0 ? "at a flip of branch " + std::to_string(branch.from_branch)
                           : branch.begin == branch::End::not_run ? "start of the range"
                                                                  : end_text(branch.begin, branch.begin_reason);
        if (branch.end == branch::End::closed) { begins = "closed"; }
        block.rows.push_back({std::to_string(b), std::to_string(branch.period), std::to_string(branch.points.size()),
                              std::to_string(stable), place_text(problem, result, *low),
                              place_text(problem, result, *high), begins, end_text(branch.end, branch.end_reason)});
    }
    return block;
}

}  // namespace

std::string branch_document(const ProblemFile& problem, const BranchResult& result) {
    Json out = {{"schema", "percuss/branch/1"}, {"units", units_of(problem)}};
    out["reason"] = result.reason;
    out["along"] = std::string(model::key_info(result.along).name);
    out["from"] = result.from;
    out["to"] = result.to;
    out["branches"] = Json::array();
    for (std::size_t b = 0; b < result.branches.size(); ++b) {
        const Branch& branch = result.branches[b];
        Json points = Json::array();
        for (const Point& p : branch.points) { points.push_back(point_of(problem, result, p)); }
        out["branches"].push_back(
            {{"id", b},
             {"period", branch.period},
             {"from_branch", branch.from_branch >= 0 ? Json(branch.from_branch) : Json(nullptr)},
             {"begin", branch.begin == branch::End::not_run ? "start" : branch::to_string(branch.begin)},
             {"end", branch::to_string(branch.end)},
             {"reason", branch.end_reason.empty() ? branch.begin_reason : branch.end_reason},
             {"points", std::move(points)}});
    }
    out["boundaries"] = Json::array();
    out["jumps"] = Json::array();
    for (std::size_t b = 0; b < result.branches.size(); ++b) {
        const auto& boundaries = result.branches[b].boundaries;
        for (std::size_t i = 0; i < boundaries.size(); ++i) {
            out["boundaries"].push_back(boundary_of(problem, result, b, i));
            const int partner = boundaries[i].partner;
            // Partners point at each other; each pair is told once.
            if (partner > static_cast<int>(i)) {
                const auto& other = boundaries[static_cast<std::size_t>(partner)];
                const UserPoint user = to_user(problem, result, boundaries[i].point);
                const double distance = std::abs(boundaries[i].point.parameter - other.point.parameter);
                Json jump = {{"boundaries", Json::array({global_index(result, b, static_cast<int>(i)),
                                                         global_index(result, b, partner)})}};
                add_omega(problem, user.omega, user.time, jump);
                jump["distance"] = told(problem, result, distance, user.time);
                out["jumps"].push_back(std::move(jump));
            }
        }
    }
    out["cost"] = {{"seconds", result.seconds}, {"periods", result.periods}, {"orbit_solves", result.solves}};
    return results::printed(out);
}

Presentation present_branch(const ProblemFile& problem, const BranchResult& result) {
    Presentation out;
    out.title = problem.name + ": motions along the " + along_name(result);
    if (!result.reason.empty()) { out.blocks.push_back({"", "Not complete: " + result.reason + ".", {}, {}}); }
    const bool neutral = std::any_of(result.branches.begin(), result.branches.end(),
                                     [](const branch::Branch& branch) { return branch.neutral(); });
    if (neutral) {
        out.blocks.push_back({"",
                              "Nothing damps these motions: their multipliers stay on the unit circle or come in pairs "
                              "mu, 1/mu. None is called stable, and no torus points are looked for.",
                              {},
                              {}});
    }
    out.blocks.push_back(stable_block(problem, result));
    out.blocks.push_back(boundaries_block(problem, result));
    out.blocks.push_back({"",
                          std::to_string(result.solves) + " orbits and boundaries solved for, " +
                              model::number_text(result.periods, 4) + " drive cycles integrated in " +
                              model::number_text(result.seconds, 3) + " s",
                          {},
                          {}});
    results::drop_empty_blocks(out);
    return out;
}

std::string branch_csv(const ProblemFile& problem, const BranchResult& result) {
    const bool si = units_of(problem) == "si";
    const std::string m = si ? "m" : "";
    std::vector<Column> columns = {
        {"branch", ""}, {"period", "drive cycles"}, {"omega", si ? "rad/s" : ""}, {"drive_frequency", si ? "Hz" : ""}};
    if (!result.along_frequency) {
        const std::string_view unit = model::key_info(result.along).unit;
        columns.push_back({std::string(model::key_info(result.along).name), unit == "1" ? "" : std::string(unit)});
    }
    for (const char* name : {"amplitude", "x_max", "x_min"}) { columns.push_back({name, m}); }
    columns.push_back({"peak_force", si ? "N" : ""});
    for (const char* name : {"contacts", "max_multiplier", "stable"}) { columns.push_back({name, ""}); }
    std::vector<std::vector<std::string>> rows;
    for (std::size_t b = 0; b < result.branches.size(); ++b) {
        for (const Point& p : result.branches[b].points) {
            const UserPoint user = to_user(problem, result, p);
            std::vector<std::string> row = {std::to_string(b), std::to_string(result.branches[b].period),
                                            cell(in_user_units(problem, user.omega, user.time)),
                                            cell(user.drive_frequency)};
            if (!result.along_frequency) { row.push_back(cell(user.value)); }
            for (double v : {user.amplitude, user.x_max, user.x_min, user.peak_force}) { row.push_back(cell(v)); }
            row.push_back(std::to_string(p.contacts.size()));
            row.push_back(cell(p.max_multiplier()));
            row.emplace_back(p.stable() ? "1" : "0");
            rows.push_back(std::move(row));
        }
    }
    return csv_text(columns, rows);
}

std::string boundaries_csv(const ProblemFile& problem, const BranchResult& result) {
    const bool si = units_of(problem) == "si";
    std::vector<Column> columns = {
        {"branch", ""}, {"kind", ""}, {"omega", si ? "rad/s" : ""}, {"drive_frequency", si ? "Hz" : ""}};
    if (!result.along_frequency) {
        const std::string_view unit = model::key_info(result.along).unit;
        columns.push_back({std::string(model::key_info(result.along).name), unit == "1" ? "" : std::string(unit)});
    }
    columns.push_back({"uncertainty", "of what is varied"});
    columns.push_back({"peak_force", si ? "N" : ""});
    columns.push_back({"contacts", ""});
    columns.push_back({"jump with boundary", ""});
    std::vector<std::vector<std::string>> rows;
    for (std::size_t b = 0; b < result.branches.size(); ++b) {
        for (const BoundaryPoint& found : result.branches[b].boundaries) {
            const UserPoint user = to_user(problem, result, found.point);
            std::vector<std::string> row = {std::to_string(b), std::string(kind_name(found)),
                                            cell(in_user_units(problem, user.omega, user.time)),
                                            cell(user.drive_frequency)};
            if (!result.along_frequency) { row.push_back(cell(user.value)); }
            row.push_back(cell(found.uncertainty));
            row.push_back(cell(user.peak_force));
            row.push_back(std::to_string(found.point.contacts.size()));
            row.push_back(found.partner >= 0 ? std::to_string(global_index(result, b, found.partner)) : "");
            rows.push_back(std::move(row));
        }
    }
    return csv_text(columns, rows);
}

}  // namespace percuss::verbs
