#pragma once
/// \file
/// The usual kinds of rows. A field is a pointer to a member of the options, or a function from the options to it;
/// defaults come from the member's initialiser.

#include "model/number_text.hpp"
#include "problem/row.hpp"
#include "problem/values.hpp"

#include <functional>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

namespace percuss::problem {

/// A whole number in a range, both ends included.
struct Whole {
    int lowest = 1;
    int highest = largest_count;
};
std::string in_words(Whole range);

template <class Options, class Field>
Row count(std::string name, Field field, Whole range, std::string meaning) {
    const Options fresh;
    return {std::move(name),
            "",
            in_words(range),
            std::to_string(std::invoke(field, fresh)),
            std::move(meaning),
            [=](void* options, const Setting& s, const Context&) {
                std::invoke(field, *static_cast<Options*>(options)) = parse_count(s, range.lowest, range.highest);
            },
            [=](const void* options, const Context&) {
                const auto value = std::invoke(field, *static_cast<const Options*>(options));
                return std::vector<Echo>{number_echo(static_cast<double>(value), "")};
            }};
}

/// A plain number strictly between two bounds.
struct Between {
    double above = 0.0;
    double below = 1.0;
};
std::string in_words(Between range);

template <class Options, class Field>
Row number(std::string name, Field field, Between range, std::string meaning) {
    const Options fresh;
    return {std::move(name),
            "",
            in_words(range),
            model::number_text(std::invoke(field, fresh)),
            std::move(meaning),
            [=](void* options, const Setting& s, const Context&) {
                std::invoke(field, *static_cast<Options*>(options)) = parse_between(s, range.above, range.below);
            },
            [=](const void* options, const Context&) {
                return std::vector<Echo>{number_echo(std::invoke(field, *static_cast<const Options*>(options)), "")};
            }};
}

/// A margin: at least 0, below one half (50 %).
inline constexpr const char* margin_range = "at least 0, below 0.5 (50 %)";

/// One of several words, kept as text.
template <class Options, class Field>
Row word(std::string name, Field field, std::vector<std::string> words, std::string meaning) {
    const Options fresh;
    return {std::move(name),
            "",
            alternatives(words),
            std::invoke(field, fresh),
            std::move(meaning),
            [=](void* options, const Setting& s, const Context&) {
                std::invoke(field, *static_cast<Options*>(options)) = parse_choice(s, words);
            },
            [=](const void* options, const Context&) {
                return std::vector<Echo>{{std::invoke(field, *static_cast<const Options*>(options))}};
            }};
}

/// One of several words that stand for values.
template <class Value>
using Words = std::vector<std::pair<std::string, Value>>;

template <class Value>
std::vector<std::string> names_of(const Words<Value>& words) {
    std::vector<std::string> names;
    for (const auto& entry : words) { names.push_back(entry.first); }
    return names;
}

template <class Value>
std::string word_of(const Words<Value>& words, Value value) {
    for (const auto& [name, each] : words) {
        if (each == value) { return name; }
    }
    return "unknown";
}

template <class Options, class Value, class Field>
Row choice(std::string name, Field field, Words<Value> words, std::string meaning) {
    const Options fresh;
    return {std::move(name),
            "",
            alternatives(names_of(words)),
            word_of(words, std::invoke(field, fresh)),
            std::move(meaning),
            [=](void* options, const Setting& s, const Context&) {
                const std::string chosen = parse_choice(s, names_of(words));
                for (const auto& [each, value] : words) {
                    if (each == chosen) { std::invoke(field, *static_cast<Options*>(options)) = value; }
                }
            },
            [=](const void* options, const Context&) {
                return std::vector<Echo>{{word_of(words, std::invoke(field, *static_cast<const Options*>(options)))}};
            }};
}

/// A state of the actuator, or nothing.
template <class Options, class Field>
Row state(std::string name, Field field, std::string fallback, std::string meaning) {
    return {std::move(name),
            "",
            "numbers separated by commas or blanks",
            std::move(fallback),
            std::move(meaning),
            [=](void* options, const Setting& s, const Context& context) {
                std::invoke(field, *static_cast<Options*>(options)) = parse_state(s, states_of(*context.actuator.type));
            },
            [=](const void* options, const Context&) {
                const auto& value = std::invoke(field, *static_cast<const Options*>(options));
                return value ? std::vector<Echo>{{state_text(*value)}} : std::vector<Echo>{};
            }};
}

/// Anything else: `set` and `get` are functions of the options, the setting and the context.
template <class Options, class Set, class Get>
Row setting(std::string name, std::string unit, std::string allowed, std::string fallback, std::string meaning, Set set,
            Get get) {
    return {std::move(name),
            std::move(unit),
            std::move(allowed),
            std::move(fallback),
            std::move(meaning),
            [=](void* options, const Setting& s, const Context& context) {
                set(*static_cast<Options*>(options), s, context);
            },
            [=](const void* options, const Context& context) -> std::vector<Echo> {
                return get(*static_cast<const Options*>(options), context);
            }};
}

}  // namespace percuss::problem
