#include "io/branch_results.hpp"

#include "design/integrators.hpp"
#include "io/csv_table.hpp"
#include "model/number_text.hpp"

#include <algorithm>
#include <cmath>

#include <nlohmann/json.hpp>

namespace percuss::io {

namespace {

using Json = nlohmann::ordered_json;  // prints NaN as null and numbers so that they read back exactly
using boundary::Kind;
using branch::BoundaryPoint;
using branch::Branch;
using branch::Point;
using design::Quantity;

std::string_view kind_name(const BoundaryPoint& found) { return boundary::to_string(found.kind); }

/// A point in the problem's units.
struct UserPoint {
    double omega = 0.0;
    double drive_frequency = 0.0;
    double value = 0.0;  ///< of the key along which the branch was followed
    double amplitude = 0.0;
    double x_max = 0.0;
    double x_min = 0.0;
    double peak_force = 0.0;
};

UserPoint to_user(const ProblemFile& problem, const study::BranchStudyResult& result, const Point& p) {
    const model::Scales scales = study::scales_at(problem.study, result, p.parameter);
    UserPoint out;
    out.omega = p.omega;
    out.drive_frequency = design::drive_frequency(p.omega, scales);
    out.value = p.parameter;
    out.amplitude = scales.length * p.amplitude();
    out.x_max = scales.length * p.x_max;
    out.x_min = scales.length * p.x_min;
    out.peak_force = scales.force * p.peak_force;
    return out;
}

Json point_of(const ProblemFile& problem, const study::BranchStudyResult& result, const Point& p) {
    const UserPoint user = to_user(problem, result, p);
    Json out = {{"omega", user.omega}, {"drive_frequency", user.drive_frequency}};
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
int global_index(const study::BranchStudyResult& result, std::size_t branch, int local) {
    int index = local;
    for (std::size_t i = 0; i < branch; ++i) { index += static_cast<int>(result.branches[i].boundaries.size()); }
    return index;
}

Json boundary_of(const ProblemFile& problem, const study::BranchStudyResult& result, std::size_t b, std::size_t i) {
    const BoundaryPoint& found = result.branches[b].boundaries[i];
    const UserPoint user = to_user(problem, result, found.point);
    const model::Scales scales = study::scales_at(problem.study, result, found.point.parameter);
    Json out = {
        {"kind", kind_name(found)}, {"branch", b}, {"omega", user.omega}, {"drive_frequency", user.drive_frequency}};
    if (!result.along_frequency) { out["value"] = user.value; }
    out["uncertainty"] = found.uncertainty;
    out["peak_force"] = user.peak_force;
    out["amplitude"] = user.amplitude;
    out["contacts"] = found.point.contacts.size();
    out["max_multiplier"] = found.point.max_multiplier();
    out["state"] = design::to_user(found.state_at_zero, scales, problem_states(problem));
    out["jump_with"] = found.partner >= 0 ? Json(global_index(result, b, found.partner)) : Json(nullptr);
    if (found.kind == Kind::flip) { out["symmetry"] = found.of_half_cycle; }
    if (b < result.gradients.size() && i < result.gradients[b].size()) {
        Json gradients = Json::object();
        for (std::size_t k = 0; k < result.gradient_keys.size(); ++k) {
            gradients[std::string(model::key_info(result.gradient_keys[k]).name)] =
                result.gradients[b][i].d_parameter[k];
        }
        out["gradients"] = {{result.along_frequency ? "omega" : "value", std::move(gradients)}};
    }
    return out;
}

std::string along_name(const study::BranchStudyResult& result) {
    return result.along_frequency ? "drive frequency" : std::string(model::key_info(result.along).name);
}

std::string place_text(const ProblemFile& problem, const study::BranchStudyResult& result, const Point& p) {
    const UserPoint user = to_user(problem, result, p);
    if (!result.along_frequency) { return text_of(result.along, user.value); }
    const std::string omega = model::number_text(user.omega, 12);
    return units_of(problem) == "si"
             ? omega + " (" + text_of(problem, Quantity::drive_frequency, user.drive_frequency) + ")"
             : omega;
}

std::string end_text(branch::End end, const std::string& reason) {
    return std::string(branch::to_string(end)) + (reason.empty() ? "" : " (" + reason + ")");
}

Block boundaries_block(const ProblemFile& problem, const study::BranchStudyResult& result) {
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
Block stable_block(const ProblemFile& problem, const study::BranchStudyResult& result) {
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

std::string cell(double value) { return std::isnan(value) ? "" : model::exact_text(value); }

}  // namespace

std::string branch_document(const ProblemFile& problem, const study::BranchStudyResult& result) {
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
            if (partner > static_cast<int>(i)) {
                const auto& other = boundaries[static_cast<std::size_t>(partner)];
                out["jumps"].push_back(
                    {{"boundaries", {global_index(result, b, static_cast<int>(i)), global_index(result, b, partner)}},
                     {"omega", boundaries[i].point.omega},
                     {"distance", std::abs(boundaries[i].point.parameter - other.point.parameter)}});
            }
        }
    }
    out["cost"] = {{"seconds", result.seconds}, {"periods", result.periods}, {"orbit_solves", result.solves}};
    return out.dump(2, ' ', false, Json::error_handler_t::replace) + "\n";
}

Presentation present_branch(const ProblemFile& problem, const study::BranchStudyResult& result) {
    Presentation out;
    out.title = problem.name + ": motions along the " + along_name(result);
    if (!result.reason.empty()) { out.blocks.push_back({"", "Not complete: " + result.reason + ".", {}, {}}); }
    out.blocks.push_back(stable_block(problem, result));
    out.blocks.push_back(boundaries_block(problem, result));
    out.blocks.push_back({"",
                          std::to_string(result.solves) + " orbits and boundaries solved for, " +
                              model::number_text(result.periods, 4) + " drive cycles integrated in " +
                              model::number_text(result.seconds, 3) + " s",
                          {},
                          {}});
    std::erase_if(out.blocks, [](const Block& block) { return block.sentence.empty() && block.rows.empty(); });
    return out;
}

std::string branch_csv(const ProblemFile& problem, const study::BranchStudyResult& result) {
    const bool si = units_of(problem) == "si";
    const std::string m = si ? "m" : "";
    std::vector<study::Column> columns = {
        {"branch", ""}, {"period", "drive cycles"}, {"omega", "rad per Gamma"}, {"drive_frequency", si ? "Hz" : ""}};
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
                                            cell(user.omega), cell(user.drive_frequency)};
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

std::string boundaries_csv(const ProblemFile& problem, const study::BranchStudyResult& result) {
    const bool si = units_of(problem) == "si";
    std::vector<study::Column> columns = {
        {"branch", ""}, {"kind", ""}, {"omega", "rad per Gamma"}, {"drive_frequency", si ? "Hz" : ""}};
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
            std::vector<std::string> row = {std::to_string(b), std::string(kind_name(found)), cell(user.omega),
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

}  // namespace percuss::io
