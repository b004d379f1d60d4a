#include "verbs/locus/locus_results.hpp"

#include "design/integrators.hpp"
#include "model/number_text.hpp"
#include "results/csv_table.hpp"
#include "results/json.hpp"
#include "verbs/frequencies.hpp"

namespace percuss::verbs {

using problem::ProblemFile;
using problem::text_of;
using problem::units_of;
using results::Block;
using results::Column;
using results::csv_text;
using results::Json;
using results::Presentation;

namespace {

using branch::LocusPoint;
using design::Quantity;

model::Scales scales_of(const ProblemFile& problem, const LocusResult& result, double value) {
    model::Specification spec = problem.design.actuator;
    spec.set(result.along, value);
    return model::scale(spec).scales;
}

std::string frequency_text(const ProblemFile& problem, const LocusResult& result, double omega, double value) {
    std::string text = model::number_text(omega, 12);
    if (units_of(problem) != "si") { return text; }
    const double hertz = design::drive_frequency(omega, scales_of(problem, result, value));
    return text + " (" + text_of(problem, Quantity::drive_frequency, hertz) + ")";
}

}  // namespace

std::string locus_document(const ProblemFile& problem, const LocusResult& result) {
    Json out = {{"schema", "percuss/locus/1"}, {"units", units_of(problem)}};
    out["reason"] = result.reason;
    out["kind"] = boundary::to_string(result.kind);
    out["along"] = std::string(model::key_info(result.along).name);
    out["from"] = result.from;
    out["to"] = result.to;
    out["points"] = Json::array();
    out["cusps"] = Json::array();
    out["turns"] = Json::array();
    out["curves"] = Json::array();
    for (std::size_t c = 0; c < result.curves.size(); ++c) {
        const branch::Locus& curve = result.curves[c];
        for (const LocusPoint& p : curve.points) {
            const model::Scales scales = scales_of(problem, result, p.value);
            Json point = {{"curve", c}};
            add_omega(problem, p.omega, scales.time, point);
            point["drive_frequency"] = design::drive_frequency(p.omega, scales);
            point["value"] = p.value;
            point["peak_force"] = scales.force * p.peak_force;
            out["points"].push_back(std::move(point));
        }
        for (const branch::LocusTurn& turn : curve.turns) {
            Json point = {{"curve", c}};
            add_omega(problem, turn.omega, scales_of(problem, result, turn.value).time, point);
            point["value"] = turn.value;
            out[turn.cusp ? "cusps" : "turns"].push_back(std::move(point));
        }
        out["curves"].push_back({{"curve", c}, {"end", branch::to_string(curve.end)}, {"reason", curve.end_reason}});
    }
    out["cost"] = {{"seconds", result.seconds}, {"periods", result.periods}, {"orbit_solves", result.solves}};
    return results::printed(out);
}

Presentation present_locus(const ProblemFile& problem, const LocusResult& result) {
    Presentation out;
    const std::string key(model::key_info(result.along).name);
    out.title = problem.name + ": " + std::string(boundary::to_string(result.kind)) + " along " + key;
    if (!result.reason.empty()) { out.blocks.push_back({"", "Remark: " + result.reason + ".", {}, {}}); }
    Block points{"Points", "", {"curve", key, "omega", "peak force"}, {}};
    Block turns{"Turning points", "", {"curve", "kind", key, "omega"}, {}};
    Block ends{"Curves", "", {"curve", "points", "ends"}, {}};
    for (std::size_t c = 0; c < result.curves.size(); ++c) {
        const branch::Locus& curve = result.curves[c];
        for (const LocusPoint& p : curve.points) {
            const double force = scales_of(problem, result, p.value).force * p.peak_force;
            points.rows.push_back({std::to_string(c), problem::text_of(result.along, p.value),
                                   frequency_text(problem, result, p.omega, p.value),
                                   text_of(problem, Quantity::peak_force, force)});
        }
        for (const branch::LocusTurn& turn : curve.turns) {
            turns.rows.push_back({std::to_string(c), turn.cusp ? "cusp" : "turn", model::number_text(turn.value, 10),
                                  frequency_text(problem, result, turn.omega, turn.value)});
        }
        ends.rows.push_back({std::to_string(c), std::to_string(curve.points.size()),
                             std::string(branch::to_string(curve.end)) +
                                 (curve.end_reason.empty() ? "" : " (" + curve.end_reason + ")")});
    }
    for (Block* block : {&points, &turns, &ends}) {
        if (!block->rows.empty()) { out.blocks.push_back(*block); }
    }
    return out;
}

std::string locus_csv(const ProblemFile& problem, const LocusResult& result) {
    const bool si = units_of(problem) == "si";
    const model::KeyInfo& info = model::key_info(result.along);
    const std::vector<Column> columns = {{"curve", ""},
                                         {std::string(info.name), info.unit == "1" ? "" : std::string(info.unit)},
                                         {"omega", si ? "rad/s" : ""},
                                         {"drive_frequency", si ? "Hz" : ""},
                                         {"peak_force", si ? "N" : ""}};
    std::vector<std::vector<std::string>> rows;
    for (std::size_t c = 0; c < result.curves.size(); ++c) {
        for (const LocusPoint& p : result.curves[c].points) {
            const model::Scales scales = scales_of(problem, result, p.value);
            rows.push_back({std::to_string(c), model::exact_text(p.value),
                            model::exact_text(in_user_units(problem, p.omega, scales.time)),
                            model::exact_text(design::drive_frequency(p.omega, scales)),
                            model::exact_text(scales.force * p.peak_force)});
        }
    }
    return csv_text(columns, rows);
}

}  // namespace percuss::verbs
