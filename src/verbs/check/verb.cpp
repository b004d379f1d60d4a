#include "verbs/check/verb.hpp"

#include "model/units.hpp"
#include "verbs/check/derived_parameters.hpp"
#include "verbs/evaluation_results.hpp"

#include <cmath>

namespace percuss::verbs {

namespace {

using problem::ProblemFile;
using results::Block;
using results::Json;
using results::Presentation;

Json setting_of(const problem::ResolvedSetting& setting) {
    return {{"value", std::isnan(setting.value) ? Json(setting.text) : Json(setting.value)},
            {"unit", setting.unit},
            {"text", setting.text},
            {"origin", problem::to_string(setting.origin)},
            {"trouble", setting.trouble}};
}

/// Repeatable keys become arrays.
Json settings_of(const ProblemFile& problem) {
    Json out = Json::object();
    for (const problem::ResolvedSetting& setting : problem.settings) {
        if (setting.repeatable) {
            out[setting.name].push_back(setting_of(setting));
        } else {
            out[setting.name] = setting_of(setting);
        }
    }
    return out;
}

/// percuss/check/1: {"schema","units","problem","hash","settings":{key:{"value","unit","text","origin","trouble"}},
/// "derived":{name:{"value","unit","meaning"}},"troubles":[...]}; repeatable keys hold an array of such objects.
std::string document(const ProblemFile& problem) {
    Json out = document_beginning(problem, "percuss/check/1");
    out["problem"] = problem.name;
    out["hash"] = problem::problem_hash(problem);
    out["settings"] = settings_of(problem);
    out["derived"] = Json::object();
    for (const DerivedParameter& parameter : derived_parameters(problem)) {
        out["derived"][parameter.name] = {
            {"value", parameter.value}, {"unit", parameter.unit}, {"meaning", parameter.meaning}};
    }
    out["troubles"] = problem.troubles;
    return results::printed(out);
}

Presentation present(const ProblemFile& problem) {
    Presentation out;
    out.title = problem.name + ": problem as understood";
    out.blocks.push_back(results::settings_block(problem));
    Block derived{"Derived", "", {"parameter", "value", "meaning"}, {}};
    for (const DerivedParameter& parameter : derived_parameters(problem)) {
        derived.rows.push_back(
            {parameter.name, model::format_quantity(parameter.value, parameter.unit), parameter.meaning});
    }
    if (!derived.rows.empty()) { out.blocks.push_back(derived); }
    if (problem.troubles.empty()) {
        out.blocks.push_back(results::sentence("Nothing is missing and every value is in range."));
    }
    return out;
}

Outcome run(Session& session) {
    const ProblemFile& problem = session.problem();
    Outcome outcome;
    outcome.document = document(problem);
    outcome.presentation = present(problem);
    outcome.ending = problem.troubles.empty() ? Ending::verified : Ending::refused;
    if (!problem.troubles.empty()) {
        const std::size_t others = problem.troubles.size() - 1;
        outcome.reason = problem.troubles.front() + (others == 0 ? "" : " (and " + std::to_string(others) + " more)");
    }
    return outcome;
}

}  // namespace

Verb check_verb() {
    Verb verb;
    verb.name = "check";
    verb.summary = "print every value of a problem with units, say what is missing or out of range";
    verb.run = run;
    verb.inspects = true;
    return verb;
}

}  // namespace percuss::verbs
