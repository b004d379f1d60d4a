#include "problem/reading.hpp"

#include "model/number_text.hpp"
#include "problem/nearest_name.hpp"

#include <algorithm>
#include <fstream>
#include <iterator>
#include <set>

#include <boost/program_options/cmdline.hpp>
#include <boost/program_options/options_description.hpp>
#include <boost/program_options/parsers.hpp>

namespace percuss::problem {

namespace {

namespace po = boost::program_options;

/// Bytes. Problem files have some thousand; a table or a program given by mistake is refused before it is read.
constexpr std::uintmax_t largest_file = 1U << 20U;

/// The keys of problem files; options of the command line are added to the same description.
po::options_description describe_keys(std::span<const Section> sections) {
    po::options_description description;
    for (const Section& section : sections) {
        for (const Row& row : section.rows) {
            description.add_options()(row.name.c_str(), po::value<std::string>(), row.meaning.c_str());
        }
    }
    return description;
}

/// Every name that may be meant by a misspelt one.
std::vector<std::string> known_names(std::span<const Section> sections, std::span<const RunOption> run_options) {
    std::vector<std::string> names;
    for (const Section& section : sections) {
        for (const Row& row : section.rows) { names.push_back(row.name); }
    }
    for (const RunOption& option : run_options) { names.push_back(option.name); }
    return names;
}

/// A key that stands twice has no telling which value was meant; lists are what may repeat.
void refuse_repetitions(std::span<const Setting> settings, std::span<const Section> sections) {
    std::set<std::string> seen;
    for (const Setting& setting : settings) {
        const Row* row = find_row(sections, setting.key);
        const bool repeatable = row != nullptr && row->repeatable();
        if (!seen.insert(setting.key).second && !repeatable) {
            throw ProblemError((setting.from_option ? "option --" : "") + setting.key + " is given twice");
        }
    }
}

/// The file as the parser can read it. Throws ProblemError for what is not a readable file of a sensible size.
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
    // Some editors begin UTF-8 files with it, and the first line would then be no section.
    constexpr std::string_view byte_order_mark = "\xEF\xBB\xBF";
    if (content.starts_with(byte_order_mark)) { content.erase(0, byte_order_mark.size()); }
    // Other readers of INI files take ; for a comment as well, Boost's takes # alone; no value contains either.
    std::replace(content.begin(), content.end(), ';', '#');
    return content;
}

/// The words that the parser split a value into, as one text.
std::string joined(const std::vector<std::string>& values) {
    std::string text;
    for (const std::string& value : values) { text += (text.empty() ? "" : " ") + value; }
    return text;
}

}  // namespace

std::string as_written(const Setting& setting) {
    return setting.from_option ? "--" + setting.key + " '" + setting.value + "'" : setting.key + " = " + setting.value;
}

std::vector<Setting> read_settings(const std::filesystem::path& file, std::span<const Section> sections) {
    return parse_settings(read_text(file), file.string(), sections);
}

std::vector<Setting> parse_settings(const std::string& text, const std::string& source,
                                    std::span<const Section> sections) {
    std::istringstream stream(text);
    const auto description = describe_keys(sections);
    std::vector<Setting> settings;
    try {
        for (const auto& option : po::parse_config_file(stream, description, true).options) {
            if (option.unregistered || find_row(sections, option.string_key) == nullptr) {
                throw ProblemError("unknown key " + option.string_key + "; the nearest known key is " +
                                   nearest_name(option.string_key, known_names(sections, {})));
            }
            settings.push_back({option.string_key, joined(option.value), false});
        }
        refuse_repetitions(settings, sections);
    } catch (const po::error& error) {
        throw ProblemError(source + ": " + error.what());
    } catch (const ProblemError& error) { throw ProblemError(source + ": " + error.what()); }
    return settings;
}

CommandLine parse_command_line(std::span<const std::string> arguments, std::span<const RunOption> run_options,
                               std::span<const Section> sections) {
    auto description = describe_keys(sections);
    for (const RunOption& option : run_options) {
        if (option.takes_value) {
            description.add_options()(option.name.c_str(), po::value<std::string>(), "");
        } else {
            description.add_options()(option.name.c_str(), "");
        }
    }
    namespace style = po::command_line_style;
    // Without short options a negative number is a value, and -x is refused as unknown; abbreviations are left out
    // since a new key could change what they mean.
    constexpr int long_options_only = style::allow_long | style::long_allow_adjacent | style::long_allow_next;

    CommandLine line;
    try {
        po::command_line_parser parser(std::vector<std::string>(arguments.begin(), arguments.end()));
        const auto parsed = parser.options(description).style(long_options_only).allow_unregistered().run();
        for (const auto& option : parsed.options) {
            const bool is_word = option.string_key.empty();
            const std::string word = is_word ? joined(option.value) : option.string_key;
            // Unregistered ones are let through by the parser and refused here, where the nearest name can be told.
            if (option.unregistered || (is_word && word.starts_with('-'))) {
                const auto names = known_names(sections, run_options);
                const std::string name = word.substr(std::min(word.find_first_not_of('-'), word.size()));
                throw ProblemError("unknown option " + (is_word ? word : "--" + word) +
                                   "; the nearest known option is --" + nearest_name(name, names));
            }
            if (is_word) {
                line.positional.push_back(word);
            } else if (find_row(sections, word) != nullptr) {
                line.keys.push_back({word, joined(option.value), true});
            } else {
                line.run_options.push_back({word, joined(option.value), true});
            }
        }
    } catch (const po::error& error) { throw ProblemError(error.what()); }
    refuse_repetitions(line.keys, sections);
    refuse_repetitions(line.run_options, sections);
    return line;
}

bool clears_list(const Setting& setting) { return model::trimmed(setting.value) == "none"; }

std::vector<Setting> merge_settings(std::span<const Setting> file, std::span<const Setting> options,
                                    std::span<const Section> sections) {
    // Two ways to give one number.
    const auto same_number = [](const std::string& key) -> std::string {
        return key == "spring-mass.omega" ? "drive.frequency" : key;
    };
    std::vector<Setting> merged(file.begin(), file.end());
    for (const Setting& option : options) {
        const Row* row = find_row(sections, option.key);
        // An option takes the place of what the file says of the same key.
        if (row == nullptr || !row->repeatable()) {
            std::erase_if(merged, [&](const Setting& s) { return same_number(s.key) == same_number(option.key); });
            merged.push_back(option);
            continue;
        }
        // "none" empties the list of the file; options before it too.
        if (clears_list(option)) {
            std::erase_if(merged, [&](const Setting& s) { return s.key == option.key; });
            continue;
        }
        const auto same = std::find_if(merged.begin(), merged.end(), [&](const Setting& s) {
            const Row* other = find_row(sections, s.key);
            // An option takes the place of the entry of the file about the same thing (variable, objective, side of a
            // limit), so that one limit can be moved and the others stay; two options about one thing both stand.
            return !s.from_option && other != nullptr && other->repeatable() &&
                   other->subject(s.value) == row->subject(option.value);
        });
        if (same != merged.end()) {
            *same = option;
        } else {
            merged.push_back(option);
        }
    }
    return merged;
}

}  // namespace percuss::problem
