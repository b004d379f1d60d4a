#include "model/specification.hpp"

#include "model/number_text.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>

namespace percuss::model {

namespace {

/// Appends a sentence when the value of a key is not finite or not in its range (SI units).
void check_value(const KeyInfo& info, double value, std::vector<std::string>& found) {
    const bool above = info.lowest_allowed ? value >= info.lowest : value > info.lowest;
    if (!(std::isfinite(value) && above && value <= info.highest)) {
        found.push_back(assignment(info.key, value) + " is out of range: must be " + allowed_range(info));
    }
}

}  // namespace

Specification::Specification() : Specification(*actuators().front()) {}

Specification::Specification(const Actuator& actuator) : type(&actuator) {
    values.fill(std::numeric_limits<double>::quiet_NaN());
}

bool Specification::has(Key key) const { return !std::isnan(value(key)); }

double Specification::effective(Key key) const {
    return has(key) ? value(key) : key_info(key).fallback.value_or(std::numeric_limits<double>::quiet_NaN());
}

std::string assignment(Key key, double value) {
    const KeyInfo& info = key_info(key);
    std::string text = std::string(info.name) + " = " + number_text(value, 9);
    if (info.unit != "1") {
        text += ' ';
        text += info.unit;
    }
    return text;
}

bool is_required(const Specification& spec, Key key) {
    if (is_frequency(key) || key_info(key).fallback) { return false; }
    if (is_of_stop(key) && !has_stop(spec.law)) { return false; }
    return !spec.type->may_be_absent(spec, key);
}

bool has_frequency(const Specification& spec) {
    const auto keys = spec.type->frequencies;
    return std::any_of(keys.begin(), keys.end(), [&](Key key) { return spec.has(key); });
}

Key frequency_key(const Specification& spec) {
    const auto keys = spec.type->frequencies;
    const auto given = std::find_if(keys.begin(), keys.end(), [&](Key key) { return spec.has(key); });
    return given == keys.end() ? keys.front() : *given;
}

void apply_defaults(Specification& spec) {
    for (const Key key : spec.type->keys) {
        if (!spec.has(key) && key_info(key).fallback) { spec.set(key, *key_info(key).fallback); }
    }
}

std::vector<std::string> violations(const Specification& spec) {
    std::vector<std::string> found;
    for (const Key key : all_keys()) {
        if (!spec.has(key)) { continue; }
        if (belongs(key, *spec.type)) {
            check_value(key_info(key), spec.value(key), found);
        } else {
            found.push_back(std::string(key_info(key).name) + " does not belong to this kind of problem");
        }
    }
    spec.type->check(spec, found);
    for (const Key key : spec.type->keys) {
        if (!spec.has(key) && is_required(spec, key)) {
            const KeyInfo& info = key_info(key);
            found.push_back(std::string(info.name) + " is missing (" + std::string(info.meaning) + ")");
        }
    }
    return found;
}

void validate(const Specification& spec) {
    const auto found = violations(spec);
    if (!found.empty()) { throw std::invalid_argument(found.front()); }
}

}  // namespace percuss::model
