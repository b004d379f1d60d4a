#include "verbs/attractors/attractors_results.hpp"

#include "model/number_text.hpp"
#include "model/units.hpp"
#include "results/csv_table.hpp"

#include <array>
#include <cmath>

#include <nlohmann/json.hpp>

namespace percuss::verbs {

namespace {

using Json = nlohmann::ordered_json;  // prints NaN as null and numbers so that they read back exactly
using design::Quantity;
using verbs::AttractorReport;
using verbs::AttractorsResult;
using verbs::Ending;

constexpr const char* missing = "-";
constexpr int omega_digits = 12;
constexpr std::array<const char*, 4> state_names = {"x", "x'", "xi_I", "xi_II"};
constexpr std::array<const char*, 4> state_units = {"m", "m/s", "", ""};

std::string_view status_of(const AttractorsResult& result) {
    switch (result.ending) {
        case Ending::verified: return "done";
        case Ending::not_certified: return "unclassified";
        case Ending::infeasible: return "no-impact";
        case Ending::some_failed: return "failed";
        default: return "stopped";
    }
}

std::string number(double value, int digits = 6) {
    return std::isnan(value) ? missing : model::number_text(value, digits);
}

std::string state_unit(const ProblemFile& problem, std::size_t entry) {
    return units_of(problem) == "si" ? state_units[entry] : "";
}

Json exponent_of(const attractor::Exponent& exponent) { return {{"value", exponent.value}, {"error", exponent.error}}; }

Json attractor_of(const AttractorReport& attractor) {
    Json multipliers = Json::array();
    for (const auto& multiplier : attractor.multipliers) {
        multipliers.push_back(Json::array({multiplier.real(), multiplier.imag()}));
    }
    return {{"kind", attractor::to_string(attractor.kind)},
            {"period", attractor.period},
            {"state", attractor.state},
            {"peak_force", attractor.peak_force},
            {"amplitude", attractor.amplitude},
            {"x_max", attractor.x_max},
            {"x_min", attractor.x_min},
            {"contacts", attractor.contacts},
            {"contacts_per_cycle", attractor.contacts_per_cycle},
            {"multipliers", std::move(multipliers)},
            {"max_multiplier", attractor.max_multiplier},
            {"lyapunov", exponent_of(attractor.exponent)},
            {"lyapunov_per_time", exponent_of(attractor.exponent_per_time)},
            {"starts", attractor.starts},
            {"share", attractor.share.value},
            {"share_lower", attractor.share.lower},
            {"share_upper", attractor.share.upper}};
}

std::string cell(double value) { return std::isnan(value) ? "" : model::exact_text(value); }

Block sentence(std::string words) {
    Block block;
    block.sentence = std::move(words);
    return block;
}

std::string percent(double share) { return number(100.0 * share, 4) + " %"; }

std::string period_text(const AttractorReport& attractor) {
    return attractor.period > 0 ? std::to_string(attractor.period) : missing;
}

Block operating_point_block(const ProblemFile& problem, const design::OperatingPoint& point) {
    Block block{"Operating point", "", {"property", "value"}, {}};
    block.rows.push_back({"drive_frequency", text_of(problem, Quantity::drive_frequency, point.drive_frequency)});
    block.rows.push_back({"omega (nondimensional)", number(point.omega, omega_digits)});
    if (point.edge_kind != design::EdgeKind::given) {
        block.rows.push_back({"edge kind", std::string(design::to_string(point.edge_kind))});
        block.rows.push_back({"edge omega (nondimensional)", number(point.edge_omega, omega_digits)});
        block.rows.push_back({"margin", number(point.margin)});
    }
    return block;
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

Block exponents_block(const AttractorsResult& result) {
    Block block{
        "Aperiodic motions", "", {"motion", "Lyapunov exponent per drive cycle", "per nondimensional time"}, {}};
    for (const AttractorReport& a : result.attractors) {
        if (a.period > 0) { continue; }
        const auto text = [](const attractor::Exponent& e) { return number(e.value, 4) + " +- " + number(e.error, 2); };
        block.rows.push_back({std::string(attractor::to_string(a.kind)), text(a.exponent), text(a.exponent_per_time)});
    }
    return block;
}

Block states_block(const ProblemFile& problem, const AttractorsResult& result) {
    Block block{"States at theta = 0, before the longest flight", "", {"motion", "period"}, {}};
    for (std::size_t k = 0; k < result.lower.size(); ++k) {
        const std::string unit = state_unit(problem, k);
        block.columns.push_back(state_names[k] + (unit.empty() ? "" : " [" + unit + "]"));
    }
    for (const AttractorReport& a : result.attractors) {
        std::vector<std::string> row = {std::string(attractor::to_string(a.kind)), period_text(a)};
        for (const double value : a.state) { row.push_back(number(value, omega_digits)); }
        block.rows.push_back(std::move(row));
    }
    return block;
}

Block box_block(const ProblemFile& problem, const AttractorsResult& result) {
    Block block{"Box of the starts, theta = 0", "", {"state", "from", "to"}, {}};
    for (std::size_t k = 0; k < result.lower.size(); ++k) {
        const std::string unit = state_unit(problem, k);
        block.rows.push_back({state_names[k], model::format_quantity(result.lower[k], unit),
                              model::format_quantity(result.upper[k], unit)});
    }
    return block;
}

std::string starts_sentence(const ProblemFile& problem, const AttractorsResult& result) {
    std::string text = std::to_string(result.starts) + " starts (seed " + std::to_string(problem.study.seed) + "), " +
                       std::to_string(result.unclassified) + " unclassified";
    if (result.failed > 0) { text += " (" + std::to_string(result.failed) + " could not be followed)"; }
    return text + "; at 95 % confidence motions not listed attract at most " + percent(result.missed_share_bound) +
           " of the box; " + number(result.cycles) + " drive cycles in " + number(result.seconds, 3) + " s";
}

}  // namespace

std::string attractors_document(const ProblemFile& problem, const AttractorsResult& result) {
    const design::OperatingPoint& point = result.operating_point;
    Json out = {{"schema", "percuss/attractors/1"},
                {"units", units_of(problem)},
                {"status", status_of(result)},
                {"reason", result.reason}};
    out["operating_point"] = {{"drive_frequency", point.drive_frequency},
                              {"omega", point.omega},
                              {"edge_kind", design::to_string(point.edge_kind)},
                              {"edge_omega", point.edge_omega},
                              {"margin", point.margin}};
    out["starts"] = result.starts;
    out["seed"] = problem.study.seed;
    out["unclassified"] = result.unclassified;
    out["failed"] = result.failed;
    out["missed_share_bound"] = result.missed_share_bound;
    out["box"] = {{"lower", result.lower}, {"upper", result.upper}};
    out["attractors"] = Json::array();
    for (const AttractorReport& attractor : result.attractors) { out["attractors"].push_back(attractor_of(attractor)); }
    out["cost"] = {{"seconds", result.seconds}, {"periods", result.cycles}};
    constexpr int indentation = 2;
    return out.dump(indentation, ' ', false, Json::error_handler_t::replace) + "\n";
}

std::string attractors_csv(const ProblemFile& problem, const AttractorsResult& result) {
    const bool si = units_of(problem) == "si";
    std::vector<results::Column> columns = {{"kind", ""},
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
    for (std::size_t k = 0; k < result.lower.size(); ++k) {
        columns.push_back({state_names[k], state_unit(problem, k)});
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
    return results::csv_text(columns, rows);
}

Presentation present_attractors(const ProblemFile& problem, const AttractorsResult& result) {
    Presentation out;
    out.title = problem.name + ": stable motions";
    out.blocks.push_back(sentence("status: " + std::string(status_of(result)) +
                                  (result.reason.empty() ? "" : " (" + result.reason + ")")));
    if (std::isnan(result.operating_point.omega)) { return out; }
    out.blocks.push_back(operating_point_block(problem, result.operating_point));
    out.blocks.push_back(motions_block(problem, result));
    out.blocks.push_back(exponents_block(result));
    out.blocks.push_back(states_block(problem, result));
    out.blocks.push_back(box_block(problem, result));
    out.blocks.push_back(sentence(starts_sentence(problem, result)));
    std::erase_if(out.blocks, [](const Block& block) { return block.sentence.empty() && block.rows.empty(); });
    return out;
}

}  // namespace percuss::verbs
