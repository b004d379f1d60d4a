#include "verbs/explore/explore_documents.hpp"

#include "verbs/evaluation_results.hpp"

#include <cmath>
#include <utility>

namespace percuss::verbs {

using problem::ProblemFile;
using results::Block;
using results::cell;
using results::Json;
using results::number;
using results::Presentation;
using results::sentence;

namespace {

std::string percent(std::int64_t part, std::int64_t whole) {
    return whole == 0 ? results::missing
                      : number(100.0 * static_cast<double>(part) / static_cast<double>(whole), 3) + " %";
}

double rate(const ExploreFacts& facts) {
    return facts.designs > 0 && facts.seconds > 0.0 ? static_cast<double>(facts.designs) / facts.seconds
                                                    : design::absent;
}

std::string name_of(design::Quantity quantity) { return std::string(design::quantity_info(quantity).name); }

std::string key_name(const ProblemFile& problem, std::size_t i) {
    return std::string(model::key_info(problem.design.variables[i].key).name);
}

DesignValues values_of(const ProblemFile& problem, const TableLayout& layout, const results::Row& row) {
    DesignValues values;
    for (std::size_t i = 0; i < problem.design.variables.size(); ++i) {
        values.emplace_back(problem.design.variables[i].key, layout.variable(row, i));
    }
    return values;
}

double active_entry(const numerics::Sensitivity& figures, std::size_t i) {
    const auto place = static_cast<Eigen::Index>(i);
    // Adding 0 makes 0 of the -0 that an integer variable gets when the direction is turned round.
    return place < figures.active_direction.size() ? figures.active_direction[place] + 0.0 : design::absent;
}

// ---- JSON -----------------------------------------------------------------------------------------------------------

Json counts_of(const std::vector<std::pair<std::string, std::int64_t>>& counts) {
    Json out = Json::object();
    for (const auto& [name, times] : counts) { out[name] = times; }
    return out;
}

Json design_of(const ProblemFile& problem, const TableLayout& layout, const SurveyedDesign& design) {
    if (!design.exists()) { return nullptr; }
    Json quantities = Json::object();
    for (const design::Quantity quantity : layout.quantities()) {
        quantities[name_of(quantity)] = layout.value(design.cells, quantity);
    }
    Json limits = Json::array();
    for (std::size_t i = 0; i < problem.design.limits.size(); ++i) {
        const design::Limit& limit = problem.design.limits[i];
        limits.push_back({{"name", name_of(limit.quantity)},
                          {"text", limit.text},
                          {"value", layout.value(design.cells, limit.quantity)},
                          {"limit", limit.bound},
                          {"distance", design.distances[i]}});
    }
    return {{"row", design.row},
            {"design", verbs::design_of(values_of(problem, layout, design.cells))},
            {"quantities", std::move(quantities)},
            {"status", layout.status(design.cells)},
            {"cause", layout.cause(design.cells)},
            {"limits", std::move(limits)}};
}

Json sensitivities_of(const ProblemFile& problem, const std::vector<OutputSensitivity>& outputs) {
    Json out = Json::array();
    for (const OutputSensitivity& output : outputs) {
        for (std::size_t i = 0; i < output.figures.variables.size(); ++i) {
            const numerics::VariableSensitivity& variable = output.figures.variables[i];
            out.push_back({{"quantity", output.output},
                           {"edge_kind", output.edge_kind},
                           {"variable", key_name(problem, i)},
                           {"first_order", variable.first_order},
                           {"first_order_lower", variable.first_order_lower},
                           {"first_order_upper", variable.first_order_upper},
                           {"dgsm_bound", variable.dgsm_bound},
                           {"dgsm_bound_lower", variable.dgsm_bound_lower},
                           {"dgsm_bound_upper", variable.dgsm_bound_upper},
                           {"active_direction", active_entry(output.figures, i)},
                           {"active_share", output.figures.active_share},
                           {"used", output.figures.used},
                           {"used_gradients", output.figures.used_gradients}});
        }
    }
    return out;
}

// ---- for people -----------------------------------------------------------------------------------------------------

Block counts_block(const Survey& survey) {
    Block block{"Designs", "", {"status", "designs", "share"}, {}};
    for (const auto& [name, times] : survey.statuses()) {
        block.rows.push_back({name, std::to_string(times), percent(times, survey.rows())});
    }
    if (survey.edge_kinds().size() > 1) {
        for (const auto& [name, times] : survey.edge_kinds()) {
            block.rows.push_back({"ok, edge kind " + name, std::to_string(times), percent(times, survey.rows())});
        }
    }
    block.rows.push_back({"feasible", std::to_string(survey.feasible()), percent(survey.feasible(), survey.rows())});
    return block;
}

void add_design(const ProblemFile& problem, const TableLayout& layout, const SurveyedDesign& design,
                const std::string& heading, Presentation& out) {
    if (!design.exists()) { return; }
    Block block = design_block(values_of(problem, layout, design.cells));
    block.heading = heading + " (row " + std::to_string(design.row) + ")";
    for (const design::Quantity quantity : layout.quantities()) {
        block.rows.push_back(
            {name_of(quantity), results::quantity_text(problem, quantity, layout.value(design.cells, quantity))});
    }
    out.blocks.push_back(std::move(block));
}

/// Each limit: how far the design shown is from it, and how often it stood in the way.
Block limits_block(const ProblemFile& problem, const Survey& survey) {
    Block block{"Limits, of designs with status ok",
                "",
                {"limit", "distance of the design above", "violated by", "by these alone"},
                {}};
    const std::int64_t ok = survey.with_status(design::EvaluationStatus::ok);
    const SurveyedDesign& shown = survey.best().exists() ? survey.best() : survey.nearest();
    for (std::size_t i = 0; i < problem.design.limits.size(); ++i) {
        const LimitCount& times = survey.limits()[i];
        const std::string distance = shown.exists() ? number(100.0 * shown.distances[i], 3) + " %" : results::missing;
        block.rows.push_back({problem.design.limits[i].text, distance,
                              std::to_string(times.violated) + " (" + percent(times.violated, ok) + ")",
                              std::to_string(times.alone)});
    }
    return block;
}

/// "0.61 (0.58 .. 0.64)".
std::string with_interval(double value, double lower, double upper) {
    return std::isnan(value) ? results::missing
                             : number(value, 3) + " (" + number(lower, 2) + " .. " + number(upper, 2) + ")";
}

Block sensitivities_block(const ProblemFile& problem, const std::vector<OutputSensitivity>& outputs) {
    Block block{"Which variables matter, with 95 % intervals",
                "",
                {"output", "edge", "variable", "first-order index", "bound on total index", "leading direction"},
                {}};
    for (const OutputSensitivity& output : outputs) {
        if (output.figures.status != numerics::SensitivityStatus::estimated) { continue; }
        for (std::size_t i = 0; i < output.figures.variables.size(); ++i) {
            const numerics::VariableSensitivity& v = output.figures.variables[i];
            block.rows.push_back({i == 0 ? output.output : "", i == 0 ? output.edge_kind : "", key_name(problem, i),
                                  with_interval(v.first_order, v.first_order_lower, v.first_order_upper),
                                  with_interval(v.dgsm_bound, v.dgsm_bound_lower, v.dgsm_bound_upper),
                                  number(active_entry(output.figures, i), 3)});
        }
    }
    return block;
}

/// The most important variable of each output in words.
std::string what_matters(const ProblemFile& problem, const std::vector<OutputSensitivity>& outputs) {
    std::string words;
    for (const OutputSensitivity& output : outputs) {
        if (output.figures.status != numerics::SensitivityStatus::estimated || output.edge_kind != all_edges) {
            continue;
        }
        std::size_t most = 0;
        for (std::size_t i = 0; i < output.figures.variables.size(); ++i) {
            if (output.figures.variables[i].first_order > output.figures.variables[most].first_order) { most = i; }
        }
        words += (words.empty() ? "Most of the variance by itself: " : "; ") + output.output + " by " +
                 key_name(problem, most) + " (" + number(100.0 * output.figures.variables[most].first_order, 3) + " %)";
    }
    return words;
}

std::string reading_help() {
    return "First-order index: share of the output's variance that the variable explains by itself. The bound on the "
           "total index comes from exact gradients (none for integer variables) and holds where the output is smooth "
           "over all designs; with designs missing or jumps it is an indication. Where designs are missing the others' "
           "variables hang together, and indices may add up to more than 1. not_ok: whether a design has another "
           "status than ok.";
}

std::string cost_sentence(const ExploreAccount& account) {
    const ExploreFacts& facts = account.facts;
    std::string words =
        std::to_string(account.survey.rows()) + " of " + std::to_string(account.wanted) + " designs in the table";
    if (account.shard.count > 1) { words += " of shard " + results::text_of(account.shard); }
    if (facts.designs > 0) {
        words += "; " + std::to_string(facts.designs) + " evaluated in " + number(facts.seconds, 3) + " s, " +
                 number(rate(facts), 3) + " a second";
    }
    return words;
}

}  // namespace

std::string status_of(const ExploreAccount& account) {
    switch (account.facts.ending) {
        case Ending::verified: return "done";
        case Ending::not_certified: return "incomplete";
        default: return "stopped";
    }
}

std::string explore_document(const ProblemFile& problem, const TableLayout& layout, const ExploreAccount& account) {
    const Survey& survey = account.survey;
    const auto& options = problem.get<ExploreOptions>();
    Json columns = Json::array({"row"});
    for (const std::size_t place : layout.shown()) { columns.push_back(layout.journal_columns()[place].name); }
    Json limits = Json::array();
    for (std::size_t i = 0; i < problem.design.limits.size(); ++i) {
        const design::Limit& limit = problem.design.limits[i];
        limits.push_back({{"name", name_of(limit.quantity)},
                          {"text", limit.text},
                          {"violated", survey.limits()[i].violated},
                          {"alone", survey.limits()[i].alone}});
    }
    Json out = document_beginning(problem, "percuss/explore/1");
    out["status"] = status_of(account);
    out["reason"] = account.facts.reason;
    out["samples"] = survey.rows();
    out["wanted"] = account.wanted;
    out["seed"] = problem.design.sampling.seed;
    out["sampling"] = options.sampling;
    out["shard"] = results::text_of(account.shard);
    out["statuses"] = counts_of(survey.statuses());
    out["edge_kinds"] = counts_of(survey.edge_kinds());
    out["columns"] = std::move(columns);
    out["feasible"] = survey.feasible();
    out["best"] = design_of(problem, layout, survey.best());
    out["nearest"] = survey.feasible() > 0 ? Json() : design_of(problem, layout, survey.nearest());
    out["limits"] = std::move(limits);
    out["sensitivities"] = sensitivities_of(problem, account.sensitivities);
    out["designs"] = account.facts.designs;
    out["seconds"] = account.facts.seconds;
    out["designs_per_second"] = rate(account.facts);
    return results::printed(out);
}

Presentation present_exploration(const ProblemFile& problem, const TableLayout& layout, const ExploreAccount& account) {
    const Survey& survey = account.survey;
    Presentation out;
    out.title = problem.name + ": exploration";
    out.blocks.push_back(results::status_sentence(status_of(account), account.facts.reason));
    out.blocks.push_back(sentence(cost_sentence(account)));
    out.blocks.push_back(counts_block(survey));
    if (!problem.design.objectives.empty()) {
        const design::Objective& objective = problem.design.objectives.front();
        add_design(problem, layout, survey.best(),
                   std::string("Best feasible design, ") + (objective.maximise ? "largest " : "smallest ") +
                       name_of(objective.quantity),
                   out);
    }
    if (survey.feasible() == 0) {
        add_design(problem, layout, survey.nearest(), "No design is feasible; the one that violates least", out);
    }
    out.blocks.push_back(limits_block(problem, survey));
    out.blocks.push_back(sentence(what_matters(problem, account.sensitivities)));
    Block table = sensitivities_block(problem, account.sensitivities);
    const bool has_any = !table.rows.empty();
    out.blocks.push_back(std::move(table));
    if (has_any) { out.blocks.push_back(sentence(reading_help())); }
    results::drop_empty_blocks(out);
    return out;
}

std::string sensitivities_csv(const ProblemFile& problem, const std::vector<OutputSensitivity>& outputs) {
    const std::vector<Column> columns = {{"quantity", ""},
                                         {"edge_kind", ""},
                                         {"variable", ""},
                                         {"first_order", ""},
                                         {"first_order_lower", ""},
                                         {"first_order_upper", ""},
                                         {"degree", ""},
                                         {"dgsm_bound", ""},
                                         {"dgsm_bound_lower", ""},
                                         {"dgsm_bound_upper", ""},
                                         {"active_direction", ""},
                                         {"active_share", ""},
                                         {"used", "designs"},
                                         {"used_gradients", "designs"}};
    std::vector<std::vector<std::string>> rows;
    for (const OutputSensitivity& output : outputs) {
        for (std::size_t i = 0; i < output.figures.variables.size(); ++i) {
            const numerics::VariableSensitivity& v = output.figures.variables[i];
            rows.push_back({output.output, output.edge_kind, key_name(problem, i), cell(v.first_order),
                            cell(v.first_order_lower), cell(v.first_order_upper), std::to_string(v.degree),
                            cell(v.dgsm_bound), cell(v.dgsm_bound_lower), cell(v.dgsm_bound_upper),
                            cell(active_entry(output.figures, i)), cell(output.figures.active_share),
                            std::to_string(output.figures.used), std::to_string(output.figures.used_gradients)});
        }
    }
    return results::csv_text(columns, rows);
}

}  // namespace percuss::verbs
