#include "io/branch_results.hpp"

#include "design/integrators.hpp"
#include "io/csv_table.hpp"
#include "model/number_text.hpp"

#include <nlohmann/json.hpp>

namespace percuss::io {

namespace {

using Json = nlohmann::ordered_json;  // prints NaN as null and numbers so that they read back exactly
using branch::LocusPoint;
using design::Quantity;

model::Scales scales_of(const ProblemFile& problem, const study::LocusStudyResult& result, double value) {
    model::Specification spec = problem.study.design.actuator;
    spec.set(result.along, value);
    return model::scale(spec).scales;
}

std::string frequency_text(const ProblemFile& problem, const study::LocusStudyResult& result, double omega,
                           double value) {
    const std::string text = model::number_text(omega, 12);
    if (units_of(problem) != "si") { return text; }
    const double hertz = design::drive_frequency(omega, scales_of(problem, result, value));
    return text + " (" + text_of(problem, Quantity::drive_frequency, hertz) + ")";
}

}  // namespace

std::string locus_document(const ProblemFile& problem, const study::LocusStudyResult& result) {
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
            out["points"].push_back({{"curve", c},
                                     {"omega", p.omega},
                                     {"drive_frequency", design::drive_frequency(p.omega, scales)},
                                     {"value", p.value},
                                     {"peak_force", scales.force * p.peak_force}});
        }
        for (const branch::LocusTurn& turn : curve.turns) {
            out[turn.cusp ? "cusps" : "turns"].push_back({{"curve", c}, {"omega", turn.omega}, {"value", turn.value}});
        }
        out["curves"].push_back({{"curve", c}, {"end", branch::to_string(curve.end)}, {"reason", curve.end_reason}});
    }
    out["cost"] = {{"seconds", result.seconds}, {"periods", result.periods}, {"orbit_solves", result.solves}};
    return out.dump(2, ' ', false, Json::error_handler_t::replace) + "\n";
}

Presentation present_locus(const ProblemFile& problem, const study::LocusStudyResult& result) {
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
            points.rows.push_back({std::to_string(c), text_of(result.along, p.value),
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

std::string locus_csv(const ProblemFile& problem, const study::LocusStudyResult& result) {
    const bool si = units_of(problem) == "si";
    const model::KeyInfo& info = model::key_info(result.along);
    const std::vector<study::Column> columns = {
        {"curve", ""},
        {std::string(info.name), info.unit == "1" ? "" : std::string(info.unit)},
        {"omega", "rad per Gamma"},
        {"drive_frequency", si ? "Hz" : ""},
        {"peak_force", si ? "N" : ""}};
    std::vector<std::vector<std::string>> rows;
    for (std::size_t c = 0; c < result.curves.size(); ++c) {
        for (const LocusPoint& p : result.curves[c].points) {
            const model::Scales scales = scales_of(problem, result, p.value);
            rows.push_back({std::to_string(c), model::exact_text(p.value), model::exact_text(p.omega),
                            model::exact_text(design::drive_frequency(p.omega, scales)),
                            model::exact_text(scales.force * p.peak_force)});
        }
    }
    return csv_text(columns, rows);
}

}  // namespace percuss::io
