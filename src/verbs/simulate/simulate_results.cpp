#include "verbs/simulate/simulate_results.hpp"

#include "model/number_text.hpp"
#include "results/csv_table.hpp"
#include "results/json.hpp"
#include "verbs/frequencies.hpp"
#include "verbs/simulate/kick.hpp"

#include <cmath>

namespace percuss::verbs {

using problem::ProblemFile;
using problem::units_of;
using results::Block;
using results::Json;
using results::number;
using results::omega_digits;
using results::Presentation;
using results::quantity_text;
using results::sentence;

namespace {

using design::Quantity;

std::string_view start_of(SimulationStart start) {
    switch (start) {
        case SimulationStart::rest: return "rest";
        case SimulationStart::orbit: return "orbit";
        case SimulationStart::state: return "state";
    }
    return "unknown";
}

const SimulateOptions& options_of(const ProblemFile& problem) { return problem.get<SimulateOptions>(); }

const model::Actuator& family_of(const ProblemFile& problem) { return *problem.design.actuator.type; }

Json kick_of(const ProblemFile& problem) {
    if (!options_of(problem).kick) { return nullptr; }
    const Kick& kick = *options_of(problem).kick;
    Json out = {{"text", kick_text(kick, family_of(problem))}};
    if (kick.kind == Kick::Kind::velocity) {
        out["kind"] = "velocity";
        out["at"] = kick.at;
        out["velocity"] = kick.velocity;
    } else {
        out["kind"] = "drive";
        out["at"] = kick.at;
        out["share"] = kick.share;
        out["cycles"] = kick.duration;
    }
    return out;
}

Json motion_of(const std::optional<Motion>& motion) {
    if (!motion) { return nullptr; }
    return {{"settled", motion->settled},
            {"period", motion->period},
            {"contacts", motion->contacts},
            {"cycles", motion->cycles},
            {"strobed_change", motion->strobed_change},
            {"remaining_error", motion->remaining_error},
            {"polished", motion->polished},
            {"max_multiplier", motion->max_multiplier},
            {"amplitude", motion->amplitude},
            {"x_max", motion->x_max},
            {"x_min", motion->x_min},
            {"peak_force", motion->peak_force},
            {"state", motion->state}};
}

std::string outcome_sentence(KickOutcome outcome) {
    switch (outcome) {
        case KickOutcome::recovered: return "the device recovered: it settles on the motion it was on";
        case KickOutcome::fell: return "the device fell: it settles on a weaker motion";
        case KickOutcome::rose: return "the device rose: it settles on a stronger motion";
        case KickOutcome::undecided: return "undecided: before or after the kick no motion settles";
        case KickOutcome::none: break;
    }
    return "";
}

Block motions_block(const ProblemFile& problem, const SimulateResult& result) {
    Block block{"Settled motion", "", {"property"}, {}};
    std::vector<const Motion*> motions;
    if (result.before) {
        block.columns.emplace_back("without the kick");
        motions.push_back(&*result.before);
    }
    if (result.after) {
        block.columns.emplace_back(result.before ? "after the kick" : "value");
        motions.push_back(&*result.after);
    }
    const auto add = [&](const std::string& name, const auto& text) {
        std::vector<std::string> row = {name};
        for (const Motion* motion : motions) { row.push_back(text(*motion)); }
        block.rows.push_back(std::move(row));
    };
    add("settled", [](const Motion& m) { return std::string(m.settled ? "yes" : "no"); });
    add("period in drive cycles", [](const Motion& m) { return m.settled ? std::to_string(m.period) : "-"; });
    add("contacts per period (not settled: in 12 cycles)", [](const Motion& m) { return std::to_string(m.contacts); });
    add("peak_force", [&](const Motion& m) { return quantity_text(problem, Quantity::peak_force, m.peak_force); });
    add("amplitude", [&](const Motion& m) { return quantity_text(problem, Quantity::amplitude, m.amplitude); });
    add("max_multiplier", [](const Motion& m) { return number(m.max_multiplier, 9); });
    add("solved for", [](const Motion& m) { return std::string(m.polished ? "by Newton's method" : "no"); });
    add("drive cycles followed to settle", [](const Motion& m) { return std::to_string(m.cycles); });
    return block;
}

Block series_block(const ProblemFile& problem, const SimulateResult& result) {
    const design::OperatingPoint& point = result.operating_point;
    Block block{"Time series", "", {"property", "value"}, {}};
    block.rows.push_back({"drive_frequency", quantity_text(problem, Quantity::drive_frequency, point.drive_frequency)});
    block.rows.push_back({"omega (nondimensional)", number(point.omega, omega_digits)});
    block.rows.push_back({"start", std::string(start_of(options_of(problem).from))});
    block.rows.push_back({"drive cycles", number(result.cycles)});
    block.rows.push_back({"contacts", std::to_string(result.contacts)});
    block.rows.push_back({"peak_force", quantity_text(problem, Quantity::peak_force, result.peak_force)});
    if (options_of(problem).kick) {
        block.rows.push_back({"kick", kick_text(*options_of(problem).kick, family_of(problem))});
    }
    if (!std::isnan(result.change_before)) {
        block.rows.push_back({"strobed change when the kick came, relative", number(result.change_before, 2)});
    }
    return block;
}

}  // namespace

std::string_view status_of(const SimulateResult& result) {
    switch (result.ending) {
        case Ending::verified: return "done";
        case Ending::infeasible: return "no-impact";
        case Ending::some_failed: return "failed";
        default: return "stopped";
    }
}

std::string simulate_document(const ProblemFile& problem, const SimulateResult& result) {
    const design::OperatingPoint& point = result.operating_point;
    Json out = {{"schema", "percuss/simulate/1"}, {"units", units_of(problem)}};
    out["status"] = status_of(result);
    out["reason"] = result.reason;
    out["operating_point"] = operating_point_of(problem, point, PointMembers::without_fold);
    out["start"] = {{"from", start_of(options_of(problem).from)}, {"state", result.start}};
    out["cycles"] = result.cycles;
    out["samples"] = options_of(problem).samples;
    out["end_state"] = result.end_state;
    out["contacts"] = result.contacts;
    out["peak_force"] = result.peak_force;
    out["kick"] = kick_of(problem);
    out["before"] = motion_of(result.before);
    if (result.before) { out["before"]["change_at_kick"] = result.change_before; }
    out["after"] = motion_of(result.after);
    out["outcome"] = to_string(result.outcome);
    out["cost"] = {{"seconds", result.seconds}, {"periods", result.periods}};
    return results::printed(out);
}

Presentation present_simulation(const ProblemFile& problem, const SimulateResult& result) {
    Presentation out;
    out.title = problem.name + ": time series";
    out.blocks.push_back(results::status_sentence(status_of(result), result.reason));
    if (!std::isnan(result.operating_point.omega)) { out.blocks.push_back(series_block(problem, result)); }
    if (result.after) { out.blocks.push_back(motions_block(problem, result)); }
    if (result.outcome != KickOutcome::none) {
        out.blocks.push_back(sentence("outcome: " + outcome_sentence(result.outcome)));
    }
    return out;
}

}  // namespace percuss::verbs
