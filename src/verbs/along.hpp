#pragma once
/// \file
/// Keys that are varied and the ends of their ranges, for verbs that follow motions along a key.

#include "problem/row_types.hpp"
#include "problem/sections.hpp"

#include <optional>
#include <string>

namespace percuss::verbs {

/// A key of the actuator that can be varied continuously. Throws problem::ProblemError.
model::Key parse_along(const problem::Setting& setting, const problem::Context& context);

/// An end of the range of a key, within what the key allows. Throws problem::ProblemError.
double parse_end(const problem::Setting& setting, model::Key key);

/// The rows SECTION.from and SECTION.to. `key` tells from the options and the context which key is varied.
template <class Options, class KeyOf>
problem::Row end_row(const std::string& section, const std::string& end, const std::string& fallback,
                     const std::string& meaning, KeyOf key_of) {
    using namespace problem;
    const bool is_from = end == "from";
    return setting<Options>(
        section + "." + end, "", "a value of that key", fallback, meaning,
        [=](Options& options, const Setting& s, const Context& context) {
            const std::optional<model::Key> key = key_of(options, context);
            if (!key) { throw bad_value(s, "give " + section + ".along, the key that it is a value of"); }
            (is_from ? options.from : options.to) = parse_end(s, *key);
            if (options.from && options.from == options.to) {
                throw bad_value(s, "equals " + section + ".from: the range is empty");
            }
        },
        [=](const Options& options, const Context& context) -> std::vector<Echo> {
            const std::optional<model::Key> key = key_of(options, context);
            const std::optional<double>& value = is_from ? options.from : options.to;
            if (!key || !value) { return {}; }
            return {number_echo(*value, model::key_info(*key).unit)};
        });
}

/// The key that is varied, if it was given.
template <class Options>
problem::Row along_row(const std::string& section, const std::string& fallback, const std::string& meaning,
                       bool frequency_allowed) {
    using namespace problem;
    return setting<Options>(
        section + ".along", "", "a key of the actuator", fallback, meaning,
        [=](Options& options, const Setting& s, const Context& context) {
            const model::Key key = parse_along(s, context);
            if (!frequency_allowed && model::is_frequency(key)) {
                throw bad_value(s, "the drive frequency is the other parameter already; give another key");
            }
            options.along = key;
        },
        [](const Options& options, const Context&) -> std::vector<Echo> {
            if (!options.along) { return {}; }
            return {{std::string(model::key_info(*options.along).name)}};
        });
}

}  // namespace percuss::verbs
