#include "verbs/attractors/attractors_results.hpp"

#include "model/number_text.hpp"
#include "model/units.hpp"
#include "results/csv_table.hpp"
#include "results/json.hpp"
#include "verbs/evaluation_results.hpp"

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
using results::missing;
using results::number;
using results::omega_digits;
using results::Presentation;
using results::sentence;

namespace {

using design::Quantity;

Json exponent_of(const attractor::Exponent& exponent) { return {{"value", exponent.value}, {"error", exponent.error}}; }

Json attractor_of(const ProblemFile& problem, const AttractorReport& attractor, double time) {
    const attractor::Exponent per_time{in_user_units(problem, attractor.exponent_per_time.value, time),
                                       in_user_units(problem, attractor.exponent_per_time.error, time)};
    return {{"kind", attractor::to_string(attractor.kind)},
            {"period", attractor.period},
            {"state", attractor.state},
            {"peak_force", attractor.peak_force},
            {"amplitude", attractor.amplitude},
            {"x_max", attractor.x_max},
            {"x_min", attractor.x_min},
            {"contacts", attractor.contacts},
            {"contacts_per_cycle", attractor.contacts_per_cycle},
            {"multipliers", multipliers_of(attractor.multipliers)},
            {"max_multiplier", attractor.max_multiplier},
            {"lyapunov", exponent_of(attractor.exponent)},
            {"lyapunov_per_time", exponent_of(per_time)},
            {"starts", attractor.starts},
            {"share", attractor.share.value},
            {"share_lower", attractor.share.lower},
            {"share_upper", attractor.share.upper}};
}

std::string percent(double share) { return number(100.0 * share, 4) + " %"; }

std::string period_text(const AttractorReport& attractor) {
    return attractor.period > 0 ? std::to_string(attractor.period) : missing;
}

Block motions_block(const ProblemFile& problem, const AttractorsResult& result) {
    Block block{"Stable motions",
                "",
                {"motion", "period", "peak force", "amplitude", "contacts per cycle", "largest multiplier", "starts",
                 "share of the box", "95 % bounds"},
                {}};
    for (const AttractorReport& a : result.attractors) {
        block.rows.push_back({std::string(attractor::to_string(a.kind)), period_text(a),
                              text_of(problem, Quantity::peak_force, a.peak_force),
                              text_of(problem, Quantity::amplitude, a.amplitude), number(a.contacts_per_cycle, 4),
                              number(a.max_multiplier), std::to_string(a.starts), percent(a.share.value),
                              percent(a.share.lower) + " .. " + percent(a.share.upper)});
    }
    return block;
}

Block exponents_block(const ProblemFile& problem, const AttractorsResult& result) {
    const double time = time_unit(result.operating_point);
    Block block{"Aperiodic motions",
                "",
                {"motion", "Lyapunov exponent per drive cycle",
                 results::si_unit(problem, "1/s").empty() ? "per nondimensional time" : "per second"},
                {}};
    for (const AttractorReport& a : result.attractors) {
        if (a.period > 0) { continue; }
        const auto text = [](const attractor::Exponent& e) { return number(e.value, 4) + " +- " + number(e.error, 2); };
        block.rows.push_back({std::string(attractor::to_string(a.kind)), text(a.exponent),
                              text({in_user_units(problem, a.exponent_per_time.value, time),
                                    in_user_units(problem, a.exponent_per_time.error, time)})});
    }
    return block;
}

Block states_block(const ProblemFile& problem, const AttractorsResult& result) {
    const auto entries = results::state_entries(problem);
    Block block{"States at theta = 0, before the longest flight", "", {"motion", "period"}, {}};
    for (std::size_t k = 0; k < std::min(result.lower.size(), entries.size()); ++k) {
        const auto& [name, unit] = entries[k];
        std::string column(name);
        if (!unit.empty()) { column.append(" [").append(unit).append("]"); }
        block.columns.push_back(std::move(column));
    }
    for (const AttractorReport& a : result.attractors) {
        std::vector<std::string> row = {std::string(attractor::to_string(a.kind)), period_text(a)};
        for (const double value : a.state) { row.push_back(number(value, omega_digits)); }
        block.rows.push_back(std::move(row));
    }
    return block;
}

Block box_block(const ProblemFile& problem, const AttractorsResult& result) {
    const auto entries = results::state_entries(problem);
    Block block{"Box of the starts, theta = 0", "", {"state", "from", "to"}, {}};
    for (std::size_t k = 0; k < std::min(result.lower.size(), entries.size()); ++k) {
        const auto& [name, unit] = entries[k];
        block.rows.push_back(
            {name, model::format_quantity(result.lower[k], unit), model::format_quantity(result.upper[k], unit)});
    }
    return block;
}

std::string starts_sentence(const ProblemFile& problem, const AttractorsResult& result) {
    std::string text = std::to_string(result.starts) + " starts (seed " + std::to_string(problem.design.sampling.seed) +
                       "), " + std::to_string(result.unclassified) + " unclassified";
    if (result.failed > 0) { text += " (" + std::to_string(result.failed) + " could not be followed)"; }
    return text + "; at 95 % confidence motions not listed attract at most " + percent(result.missed_share_bound) +
           " of the box; " + number(result.cycles) + " drive cycles in " + number(result.seconds, 3) + " s";
}

}  // namespace

std::string_view status_of(const AttractorsResult& result) {
    switch (result.ending) {
        case Ending::verified: return "done";
        case Ending::not_certified: return "unclassified";
        case Ending::infeasible: return "no-impact";
        case Ending::some_failed: return "failed";
        default: return "stopped";
    }
}

std::string attractors_document(const ProblemFile& problem, const AttractorsResult& result) {
    const design::OperatingPoint& point = result.operating_point;
    Json out = {{"schema", "percuss/attractors/1"},
                {"units", units_of(problem)},
                {"status", status_of(result)},
                {"reason", result.reason}};
    out["operating_point"] = operating_point_of(problem, point, PointMembers::without_fold);
    out["starts"] = result.starts;
    out["seed"] = problem.design.sampling.seed;
    out["unclassified"] = result.unclassified;
    out["failed"] = result.failed;
    out["missed_share_bound"] = result.missed_share_bound;
    out["box"] = {{"lower", result.lower}, {"upper", result.upper}};
    out["attractors"] = Json::array();
    for (const AttractorReport& attractor : result.attractors) {
        out["attractors"].push_back(attractor_of(problem, attractor, time_unit(point)));
    }
    out["cost"] = {{"seconds", result.seconds}, {"periods", result.cycles}};
    return results::printed(out);
}

std::string attractors_csv(const ProblemFile& problem, const AttractorsResult& result) {
    const auto entries = results::state_entries(problem);
    const bool si = units_of(problem) == "si";
    std::vector<Column> columns = {{"kind", ""},
                                   {"period", "drive cycles"},
                                   {"starts", ""},
                                   {"share", ""},
                                   {"share_lower", ""},
                                   {"share_upper", ""},
                                   {"peak_force", si ? "N" : ""},
                                   {"amplitude", si ? "m" : ""},
                                   {"x_max", si ? "m" : ""},
                                   {"x_min", si ? "m" : ""},
                                   {"contacts", ""},
                                   {"contacts_per_cycle", ""},
                                   {"max_multiplier", ""},
                                   {"lyapunov", "per drive cycle"},
                                   {"lyapunov_error", "per drive cycle"}};
    for (std::size_t k = 0; k < std::min(result.lower.size(), entries.size()); ++k) {
        columns.push_back({entries[k].name, entries[k].unit});
    }
    std::vector<std::vector<std::string>> rows;
    for (const AttractorReport& a : result.attractors) {
        std::vector<std::string> row = {std::string(attractor::to_string(a.kind)),
                                        std::to_string(a.period),
                                        std::to_string(a.starts),
                                        cell(a.share.value),
                                        cell(a.share.lower),
                                        cell(a.share.upper),
                                        cell(a.peak_force),
                                        cell(a.amplitude),
                                        cell(a.x_max),
                                        cell(a.x_min),
                                        cell(a.contacts),
                                        cell(a.contacts_per_cycle),
                                        cell(a.max_multiplier),
                                        cell(a.exponent.value),
                                        cell(a.exponent.error)};
        for (const double value : a.state) { row.push_back(cell(value)); }
        rows.push_back(std::move(row));
    }
    return csv_text(columns, rows);
}

Presentation present_attractors(const ProblemFile& problem, const AttractorsResult& result) {
    Presentation out;
    out.title = problem.name + ": stable motions";
    out.blocks.push_back(results::status_sentence(status_of(result), result.reason));
    const design::OperatingPoint& point = result.operating_point;
    if (std::isnan(point.omega)) { return out; }
    out.blocks.push_back(operating_point_block(
        problem, point,
        point.edge_kind == design::EdgeKind::given ? PointMembers::without_edge : PointMembers::without_fold));
    out.blocks.push_back(motions_block(problem, result));
    out.blocks.push_back(exponents_block(problem, result));
    out.blocks.push_back(states_block(problem, result));
    out.blocks.push_back(box_block(problem, result));
    out.blocks.push_back(sentence(starts_sentence(problem, result)));
    results::drop_empty_blocks(out);
    return out;
}

}  // namespace percuss::verbs
