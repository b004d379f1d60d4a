#include "verbs/along.hpp"

#include "model/number_text.hpp"
#include "problem/sections.hpp"

namespace percuss::verbs {

using model::Key;
using problem::bad_value;
using problem::Setting;

Key parse_along(const Setting& setting, const problem::Context& context) {
    const Key key = problem::parse_key(model::trimmed(setting.value), *context.actuator.type);
    const bool integer = model::key_info(key).integer;
    if (integer) { throw bad_value(setting, "layers are whole numbers, nothing can be followed along them"); }
    return key;
}

double parse_end(const Setting& setting, Key key) {
    double value = 0.0;
    try {
        value = problem::parse_key_value(key, setting.value);
    } catch (const std::invalid_argument& error) { throw bad_value(setting, error.what()); }
    const model::KeyInfo& info = model::key_info(key);
    // Frequency zero has no drive cycle to integrate over, whatever the key itself allows.
    const bool above = info.lowest_allowed && !model::is_frequency(key) ? value >= info.lowest : value > info.lowest;
    if (!(above && value <= info.highest)) {
        throw bad_value(setting, std::string(info.name) + " must be " + model::allowed_range(info));
    }
    return value;
}

}  // namespace percuss::verbs
