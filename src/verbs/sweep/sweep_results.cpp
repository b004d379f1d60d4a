#include "verbs/sweep/sweep_results.hpp"

#include "model/number_text.hpp"
#include "results/csv_table.hpp"
#include "results/json.hpp"
#include "verbs/frequencies.hpp"

#include <algorithm>

namespace percuss::verbs {

using problem::ProblemFile;
using problem::text_of;
using problem::units_of;
using results::Block;
using results::Json;
using results::Presentation;
using results::sentence;

namespace {

using design::Quantity;

const SweepOptions& options_of(const ProblemFile& problem) { return problem.get<SweepOptions>(); }

/// The unit of time [s]: the whole sweep has one.
double time_of(const ProblemFile& problem) { return model::scale(problem.design.actuator).scales.time; }

Json frequency_of(const ProblemFile& problem, double omega, double drive_frequency) {
    Json out;
    add_omega(problem, omega, time_of(problem), out);
    out["drive_frequency"] = drive_frequency;
    return out;
}

bool is_chirp(const ProblemFile& problem) { return options_of(problem).mode == SweepMode::chirp; }

std::string_view mode_of(const ProblemFile& problem) { return is_chirp(problem) ? "chirp" : "steps"; }

std::string_view direction_of(const SweepDirection& direction) { return direction.forward ? "forward" : "backward"; }

/// What differs between two neighbouring points, in the words of the document.
std::vector<std::string> changes_of(const SweepJump& jump) {
    std::vector<std::string> changes;
    if (jump.period) { changes.emplace_back("period"); }
    if (jump.contacts) { changes.emplace_back("contacts"); }
    if (jump.amplitude) { changes.emplace_back("amplitude"); }
    if (jump.peak_force) { changes.emplace_back("peak_force"); }
    return changes;
}

Json point_of(const ProblemFile& problem, const SweepPoint& point) {
    const bool chirp = is_chirp(problem);
    Json out = frequency_of(problem, point.omega, point.drive_frequency);
    if (!chirp) {
        out["cycles"] = point.cycles;
        out["settled"] = point.settled;
        out["period"] = point.period;
        out["strobed_change"] = point.strobed_change;
        out["remaining_error"] = point.remaining_error;
    }
    out["amplitude"] = point.amplitude;
    out["x_max"] = point.x_max;
    out["x_min"] = point.x_min;
    out["peak_force"] = point.peak_force;
    out["contacts"] = point.contacts;
    if (!chirp) { out["state"] = point.state; }
    return out;
}

Json jump_of(const ProblemFile& problem, const SweepDirection& direction, const SweepJump& jump) {
    const SweepPoint& before = direction.points[jump.before];
    const SweepPoint& after = direction.points[jump.after];
    const double time = time_of(problem);
    return {{"between",
             Json::array({in_user_units(problem, before.omega, time), in_user_units(problem, after.omega, time)})},
            {"drive_frequencies", Json::array({before.drive_frequency, after.drive_frequency})},
            {"changes", changes_of(jump)},
            {"discontinuous", jump.discontinuous()}};
}

Json direction_document(const ProblemFile& problem, const SweepDirection& direction) {
    Json out = {{"direction", direction_of(direction)},
                {"trouble", direction.trouble},
                {"points", Json::array()},
                {"jumps", Json::array()},
                {"periods", direction.periods}};
    for (const SweepPoint& point : direction.points) { out["points"].push_back(point_of(problem, point)); }
    for (const SweepJump& jump : direction.jumps) { out["jumps"].push_back(jump_of(problem, direction, jump)); }
    return out;
}

Json comparison_of(const ProblemFile& problem, const SweepComparison& comparison) {
    const double time = time_of(problem);
    Json ranges = Json::array();
    for (const auto& [from, to] : comparison.ranges) {
        ranges.push_back(Json::array({in_user_units(problem, from, time), in_user_units(problem, to, time)}));
    }
    return {{"coincide", comparison.coincide()}, {"compared", comparison.compared},
            {"different", comparison.different}, {"unsettled", comparison.unsettled},
            {"tolerance", comparison.tolerance}, {"largest_difference", comparison.largest},
            {"ranges", std::move(ranges)}};
}

/// "omega = 1.93 (55 Hz)"
std::string frequency_text(const ProblemFile& problem, double omega, double drive_frequency) {
    const std::string text = model::number_text(omega);
    return units_of(problem) == "si" ? text + " (" + text_of(problem, Quantity::drive_frequency, drive_frequency) + ")"
                                     : text;
}

std::string frequency_text(const ProblemFile& problem, const SweepPoint& point) {
    return frequency_text(problem, point.omega, point.drive_frequency);
}

/// "3 contacts in 2 cycles", "irregular".
std::string motion_text(const SweepPoint& point, bool chirp) {
    std::string contacts = std::to_string(point.contacts) + (point.contacts == 1 ? " contact" : " contacts");
    if (chirp) { return contacts; }
    if (!point.settled) { return "not settled"; }
    return "period " + std::to_string(point.period) + ", " + contacts;
}

Block jumps_block(const ProblemFile& problem, const SweepResult& result) {
    Block block{is_chirp(problem) ? "Where the chirp begins or ceases to strike" : "Changes of motion",
                "",
                {"direction", "from omega", "to omega", "motion before", "motion after", "peak force before",
                 "peak force after", "discontinuous"},
                {}};
    for (const SweepDirection& direction : result.directions) {
        for (const SweepJump& jump : direction.jumps) {
            const SweepPoint& before = direction.points[jump.before];
            const SweepPoint& after = direction.points[jump.after];
            std::string in;
            for (const std::string& change : changes_of(jump)) {
                if (change == "amplitude" || change == "peak_force") { in += (in.empty() ? "" : ", ") + change; }
            }
            block.rows.push_back({std::string(direction_of(direction)), frequency_text(problem, before),
                                  frequency_text(problem, after), motion_text(before, is_chirp(problem)),
                                  motion_text(after, is_chirp(problem)),
                                  text_of(problem, Quantity::peak_force, before.peak_force),
                                  text_of(problem, Quantity::peak_force, after.peak_force), in});
        }
    }
    return block;
}

Block directions_block(const ProblemFile& problem, const SweepResult& result) {
    Block block{"Directions",
                "",
                {"direction", "points", "settled", "largest peak force", "at omega", "drive cycles integrated"},
                {}};
    for (const SweepDirection& direction : result.directions) {
        const auto largest =
            std::max_element(direction.points.begin(), direction.points.end(),
                             [](const SweepPoint& a, const SweepPoint& b) { return a.peak_force < b.peak_force; });
        const auto settled = std::count_if(direction.points.begin(), direction.points.end(),
                                           [](const SweepPoint& point) { return point.settled; });
        const bool any = largest != direction.points.end() && largest->peak_force > 0.0;
        block.rows.push_back({std::string(direction_of(direction)), std::to_string(direction.points.size()),
                              is_chirp(problem) ? "-" : std::to_string(settled),
                              any ? text_of(problem, Quantity::peak_force, largest->peak_force) : "-",
                              any ? frequency_text(problem, *largest) : "-", model::number_text(direction.periods)});
    }
    return block;
}

std::string comparison_sentence(const SweepComparison& comparison) {
    std::string text;
    if (comparison.compared == 0) {
        text = "The two directions have no settled motion in common to compare";
    } else if (comparison.coincide()) {
        text = "Forward and backward coincide at all " + std::to_string(comparison.compared) +
               " frequencies compared, to " + model::number_text(comparison.largest, 2) +
               " of the largest amplitude and peak force";
    } else {
        text = "Forward and backward differ at " + std::to_string(comparison.different) + " of " +
               std::to_string(comparison.compared) + " frequencies compared, for omega in";
        for (const auto& [from, to] : comparison.ranges) {
            text += " [" + model::number_text(from) + ", " + model::number_text(to) + "]";
        }
    }
    if (comparison.unsettled > 0) {
        text += "; at " + std::to_string(comparison.unsettled) + " more they did not both settle";
    }
    return text + ".";
}

std::string settled_sentence(const SweepOptions& study) {
    return "Settled means: the strobed state repeats after at most " + std::to_string(study.longest_period) +
           " drive cycles to " + model::number_text(study.tolerance) +
           " relative to 1 + |state|, it is no further than that from a stable orbit (one Newton step, not taken), and "
           "this within " +
           std::to_string(study.max_cycles) + " cycles. A sweep sees one motion at a time and misses others.";
}

}  // namespace

std::string_view status_of(const SweepResult& result) {
    switch (result.ending) {
        case Ending::verified: return "done";
        case Ending::some_failed: return "failed";
        default: return "stopped";
    }
}

std::string sweep_document(const ProblemFile& problem, const SweepResult& result) {
    const SweepOptions& study = options_of(problem);
    Json out = {{"schema", "percuss/sweep/1"}, {"units", units_of(problem)}};
    out["status"] = status_of(result);
    out["reason"] = result.reason;
    out["mode"] = mode_of(problem);
    out["from"] = frequency_of(problem, result.from_omega, result.from);
    out["to"] = frequency_of(problem, result.to_omega, result.to);
    if (is_chirp(problem)) {
        out["chirp_cycles"] = study.chirp_cycles;
    } else {
        out["steps"] = study.steps;
        out["settled"] = {{"rule", "strobed change and remaining error (one Newton step) below the tolerance, stable"},
                          {"tolerance", study.tolerance},
                          {"max_cycles", study.max_cycles},
                          {"longest_period", study.longest_period}};
    }
    out["directions"] = Json::array();
    for (const SweepDirection& direction : result.directions) {
        out["directions"].push_back(direction_document(problem, direction));
    }
    if (!is_chirp(problem)) { out["comparison"] = comparison_of(problem, result.comparison); }
    double periods = 0.0;
    for (const SweepDirection& direction : result.directions) { periods += direction.periods; }
    out["cost"] = {{"seconds", result.seconds}, {"periods", periods}};
    return results::printed(out);
}

Presentation present_sweep(const ProblemFile& problem, const SweepResult& result) {
    Presentation out;
    out.title = problem.name + ": frequency sweep";
    out.blocks.push_back(results::status_sentence(status_of(result), result.reason));
    const std::string way =
        is_chirp(problem) ? "chirp of " + std::to_string(options_of(problem).chirp_cycles) + " drive cycles each way"
                          : std::to_string(options_of(problem).steps) + " steps each way";
    out.blocks.push_back(sentence("omega " + frequency_text(problem, result.from_omega, result.from) + " to " +
                                  frequency_text(problem, result.to_omega, result.to) + ", " + way));
    out.blocks.push_back(directions_block(problem, result));
    Block jumps = jumps_block(problem, result);
    if (jumps.rows.empty()) { jumps = sentence("No change of motion."); }
    out.blocks.push_back(std::move(jumps));
    if (!is_chirp(problem)) {
        out.blocks.push_back(sentence(comparison_sentence(result.comparison)));
        out.blocks.push_back(sentence(settled_sentence(options_of(problem))));
    }
    return out;
}

}  // namespace percuss::verbs
