#include "verbs/settings.hpp"

#include "problem/nearest_name.hpp"
#include "problem/problem_error.hpp"
#include "verbs/setting_table.hpp"

#include <algorithm>
#include <fstream>
#include <iterator>
#include <set>

#include <boost/program_options/cmdline.hpp>
#include <boost/program_options/options_description.hpp>
#include <boost/program_options/parsers.hpp>

namespace percuss::verbs {

namespace {

namespace po = boost::program_options;

constexpr std::uintmax_t largest_file = 1U << 20U;

/// The keys of problem files; options of the command line are added to the same description.
po::options_description describe_keys() {
    po::options_description description;
    for (const SettingInfo& info : setting_table()) {
        description.add_options()(info.name.c_str(), po::value<std::string>(), info.meaning.c_str());
    }
    return description;
}

std::vector<std::string> known_names(std::span<const RunOption> run_options) {
    std::vector<std::string> names;
    for (const SettingInfo& info : setting_table()) { names.push_back(info.name); }
    for (const RunOption& option : run_options) { names.push_back(option.name); }
    return names;
}

bool is_repeatable(const std::string& key) {
    const SettingInfo* info = find_setting(key);
    return info != nullptr && info->repeatable;
}

void refuse_repetitions(std::span<const Setting> settings) {
    std::set<std::string> seen;
    for (const Setting& setting : settings) {
        if (!seen.insert(setting.key).second && !is_repeatable(setting.key)) {
            throw ProblemError((setting.from_option ? "option --" : "") + setting.key + " is given twice");
        }
    }
}

std::string read_text(const std::filesystem::path& file) {
    std::error_code error;
    const auto status = std::filesystem::status(file, error);
    if (!std::filesystem::exists(status)) { throw ProblemError(file.string() + ": no such file"); }
    if (!std::filesystem::is_regular_file(status)) { throw ProblemError(file.string() + ": is not a file"); }
    if (std::filesystem::file_size(file, error) > largest_file || error) {
        throw ProblemError(file.string() + ": is too large for a problem file");
    }
    std::ifstream stream(file, std::ios::binary);
    std::string content((std::istreambuf_iterator<char>(stream)), std::istreambuf_iterator<char>());
    if (!stream.is_open() || stream.bad()) { throw ProblemError(file.string() + ": cannot be read"); }
    constexpr std::string_view byte_order_mark = "\xEF\xBB\xBF";
    if (content.starts_with(byte_order_mark)) { content.erase(0, byte_order_mark.size()); }
    return content;
}

std::string joined(const std::vector<std::string>& values) {
    std::string text;
    for (const std::string& value : values) { text += (text.empty() ? "" : " ") + value; }
    return text;
}

}  // namespace

std::string as_written(const Setting& setting) {
    return setting.from_option ? "--" + setting.key + " '" + setting.value + "'" : setting.key + " = " + setting.value;
}

std::vector<Setting> read_settings(const std::filesystem::path& file) {
    std::istringstream stream(read_text(file));
    const auto description = describe_keys();
    std::vector<Setting> settings;
    try {
        for (const auto& option : po::parse_config_file(stream, description, true).options) {
            if (option.unregistered || find_setting(option.string_key) == nullptr) {
                throw ProblemError("unknown key " + option.string_key + "; the nearest known key is " +
                                   problem::nearest_name(option.string_key, known_names({})));
            }
            settings.push_back({option.string_key, joined(option.value), false});
        }
        refuse_repetitions(settings);
    } catch (const po::error& error) {
        throw ProblemError(file.string() + ": " + error.what());
    } catch (const ProblemError& error) { throw ProblemError(file.string() + ": " + error.what()); }
    return settings;
}

CommandLine parse_command_line(std::span<const std::string> arguments, std::span<const RunOption> run_options) {
    auto description = describe_keys();
    for (const RunOption& option : run_options) {
        if (option.takes_value) {
            description.add_options()(option.name.c_str(), po::value<std::string>(), "");
        } else {
            description.add_options()(option.name.c_str(), "");
        }
    }
    namespace style = po::command_line_style;
    constexpr int long_options_only = style::allow_long | style::long_allow_adjacent | style::long_allow_next;

    CommandLine line;
    try {
        po::command_line_parser parser(std::vector<std::string>(arguments.begin(), arguments.end()));
        const auto parsed = parser.options(description).style(long_options_only).allow_unregistered().run();
        for (const auto& option : parsed.options) {
            const bool is_word = option.string_key.empty();
            const std::string word = is_word ? joined(option.value) : option.string_key;
            if (option.unregistered || (is_word && word.starts_with('-'))) {
                const auto names = known_names(run_options);
                const std::string name = word.substr(std::min(word.find_first_not_of('-'), word.size()));
                throw ProblemError("unknown option " + (is_word ? word : "--" + word) +
                                   "; the nearest known option is --" + problem::nearest_name(name, names));
            }
            if (is_word) {
                line.positional.push_back(word);
            } else if (find_setting(word) != nullptr) {
                line.keys.push_back({word, joined(option.value), true});
            } else {
                line.run_options.push_back({word, joined(option.value), true});
            }
        }
    } catch (const po::error& error) { throw ProblemError(error.what()); }
    refuse_repetitions(line.keys);
    refuse_repetitions(line.run_options);
    return line;
}

std::vector<Setting> merge_settings(std::span<const Setting> file, std::span<const Setting> options) {
    const auto family_of = [](const std::string& key) -> std::string {
        return key == "spring-mass.omega" ? "drive.frequency" : key;
    };
    std::vector<Setting> merged;
    for (const Setting& setting : file) {
        const bool replaced = std::any_of(options.begin(), options.end(), [&](const Setting& option) {
            return family_of(option.key) == family_of(setting.key);
        });
        if (!replaced) { merged.push_back(setting); }
    }
    merged.insert(merged.end(), options.begin(), options.end());
    return merged;
}

}  // namespace percuss::verbs
