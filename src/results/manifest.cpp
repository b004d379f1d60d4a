#include "results/manifest.hpp"

#include "results/json.hpp"

#include <array>
#include <cmath>
#include <ctime>
#include <fstream>
#include <iterator>

namespace percuss::results {

namespace {

constexpr std::string_view schema = "percuss/manifest/1";
constexpr std::string_view file_name = "manifest.json";

std::string_view state_text(RunState state) {
    switch (state) {
        case RunState::started: return "started";
        case RunState::finished: return "finished";
        case RunState::interrupted: return "interrupted";
    }
    return "unknown";
}

/// Every setting as it counted, defaults too, in base units: a run can be repeated from the manifest.
Json settings_of(const problem::ProblemFile& problem) {
    Json out = Json::array();
    for (const problem::ResolvedSetting& setting : problem.settings) {
        const bool is_number = !std::isnan(setting.value);
        out.push_back({{"key", setting.name},
                       {"value", is_number ? Json(setting.value) : Json(setting.text)},
                       {"unit", setting.unit}});
    }
    return out;
}

}  // namespace

std::string manifest_document(const Manifest& manifest, const problem::ProblemFile& problem, const RunRecord& record) {
    const Json out = {{"schema", schema},
                      {"program", "percuss"},
                      {"version", PERCUSS_VERSION},
                      {"compiler", __VERSION__},
                      {"instruction_set", record.instruction_set},
                      {"integrator", record.integrator},
                      {"verb", manifest.verb},
                      {"state", state_text(manifest.state)},
                      {"ending", record.ending},
                      {"started", record.started},
                      {"finished", record.finished},
                      {"seed", problem.design.sampling.seed},
                      {"problem",
                       {{"name", manifest.problem},
                        {"units", problem::units_of(problem)},
                        {"hash", problem::problem_hash(problem)},
                        {"settings", settings_of(problem)}}},
                      {"files", manifest.files}};
    return printed(out);
}

std::optional<Manifest> read_manifest(const std::filesystem::path& folder) {
    std::ifstream stream(folder / file_name, std::ios::binary);
    const std::string content((std::istreambuf_iterator<char>(stream)), std::istreambuf_iterator<char>());
    const Json document = parsed(content);
    const Json* kind = document.find("schema");
    const Json* verb = document.find("verb");
    const Json* state = document.find("state");
    const Json* problem = document.find("problem");
    const Json* files = document.find("files");
    // A file that merely has the name is no manifest: its folder is left alone.
    const bool complete = kind != nullptr && verb != nullptr && state != nullptr && problem != nullptr &&
                          files != nullptr && problem->find("name") != nullptr && problem->find("hash") != nullptr;
    if (!complete || kind->text() != schema) { return std::nullopt; }
    Manifest manifest;
    manifest.verb = verb->text();
    manifest.problem = problem->find("name")->text();
    manifest.hash = problem->find("hash")->text();
    for (const Json& file : files->items()) { manifest.files.push_back(file.text()); }
    // Anything else counts as started: unfinished, which is replaced only when that is asked for.
    for (const RunState each : {RunState::finished, RunState::interrupted}) {
        if (state->text() == state_text(each)) { manifest.state = each; }
    }
    return manifest;
}

std::string time_stamp() {
    const std::time_t now = std::time(nullptr);
    std::tm parts{};
    gmtime_r(&now, &parts);
    std::array<char, 32> text{};
    const std::size_t length = std::strftime(text.data(), text.size(), "%Y-%m-%dT%H:%M:%SZ", &parts);
    return {text.data(), length};
}

}  // namespace percuss::results
