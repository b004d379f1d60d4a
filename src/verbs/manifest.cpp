#include "verbs/manifest.hpp"

#include <array>
#include <cmath>
#include <ctime>
#include <fstream>

#include <nlohmann/json.hpp>

namespace percuss::verbs {

namespace {

using Json = nlohmann::ordered_json;

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

Json settings_of(const ProblemFile& problem) {
    Json out = Json::array();
    for (const ResolvedSetting& setting : problem.settings) {
        const bool is_number = !std::isnan(setting.value);
        out.push_back({{"key", setting.name},
                       {"value", is_number ? Json(setting.value) : Json(setting.text)},
                       {"unit", setting.unit}});
    }
    return out;
}

}  // namespace

std::string manifest_document(const Manifest& manifest, const ProblemFile& problem, const RunRecord& record) {
    const Json out = {{"schema", schema},
                      {"program", "percuss"},
                      {"version", PERCUSS_VERSION},
                      {"compiler", __VERSION__},
                      {"instruction_set", record.instruction_set},
                      {"verb", manifest.verb},
                      {"state", state_text(manifest.state)},
                      {"ending", record.ending},
                      {"started", record.started},
                      {"finished", record.finished},
                      {"seed", problem.study.seed},
                      {"problem",
                       {{"name", manifest.problem},
                        {"units", units_of(problem)},
                        {"hash", problem_hash(problem)},
                        {"settings", settings_of(problem)}}},
                      {"files", manifest.files}};
    return out.dump(2, ' ', false, Json::error_handler_t::replace) + "\n";
}

std::optional<Manifest> read_manifest(const std::filesystem::path& folder) {
    std::ifstream stream(folder / file_name);
    const Json document = Json::parse(stream, nullptr, false);
    if (!document.is_object() || document.value("schema", "") != schema) { return std::nullopt; }
    try {
        Manifest manifest;
        manifest.verb = document.at("verb").get<std::string>();
        manifest.problem = document.at("problem").at("name").get<std::string>();
        manifest.files = document.at("files").get<std::vector<std::string>>();
        const auto state = document.at("state").get<std::string>();
        manifest.state = state == state_text(RunState::finished)    ? RunState::finished
                       : state == state_text(RunState::interrupted) ? RunState::interrupted
                                                                    : RunState::started;
        return manifest;
    } catch (const Json::exception&) { return std::nullopt; }
}

std::string time_stamp() {
    const std::time_t now = std::time(nullptr);
    std::tm parts{};
    gmtime_r(&now, &parts);
    std::array<char, 32> text{};
    const std::size_t length = std::strftime(text.data(), text.size(), "%Y-%m-%dT%H:%M:%SZ", &parts);
    return {text.data(), length};
}

}  // namespace percuss::verbs
