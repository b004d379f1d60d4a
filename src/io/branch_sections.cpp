#include "io/problem_sections.hpp"

#include "io/setting_values.hpp"
#include "model/number_text.hpp"
#include "study/branch_setup.hpp"

#include <array>

namespace percuss::io {

namespace {

using model::Key;

constexpr int longest_branch_period = 64;  // drive cycles
constexpr int most_points = 1'000'000;

Key parse_along(const Setting& setting, const model::Specification& spec) {
    const Key key = parse_key(model::trimmed(setting.value), *spec.type);
    const bool integer = model::key_info(key).integer;
    if (integer) { throw bad_value(setting, "layers are whole numbers, nothing can be followed along them"); }
    return key;
}

/// An end of the range of a key, within what the key allows.
double parse_end(const Setting& setting, Key key) {
    double value = 0.0;
    try {
        value = parse_key_value(key, setting.value);
    } catch (const std::invalid_argument& error) { throw bad_value(setting, error.what()); }
    const model::KeyInfo& info = model::key_info(key);
    const bool above = info.lowest_allowed && !model::is_frequency(key) ? value >= info.lowest : value > info.lowest;
    if (!(above && value <= info.highest)) {
        throw bad_value(setting, std::string(info.name) + " must be " + model::allowed_range(info));
    }
    return value;
}

/// from and to of a section, for a key.
void read_range(const SettingList& settings, const std::string& section, std::optional<Key> key,
                std::optional<double>& from, std::optional<double>& to, Troubles& troubles) {
    for (const char* name : {"from", "to"}) {
        with(settings, section + "." + name, troubles, [&](const Setting& s) {
            if (!key) { throw bad_value(s, "give " + section + ".along, the key that it is a value of"); }
            (name[0] == 'f' ? from : to) = parse_end(s, *key);
            if (from && to && !(*from < *to || *from > *to)) {
                throw bad_value(s, "equals " + section + ".from: the range is empty");
            }
        });
    }
}

}  // namespace

void read_branch(const SettingList& settings, const model::Specification& spec, study::BranchStudy& study,
                 Troubles& troubles) {
    with(settings, "branch.along", troubles, [&](const Setting& s) { study.along = parse_along(s, spec); });
    read_range(settings, "branch", study.along.value_or(model::frequency_key(spec)), study.from, study.to, troubles);
    with(settings, "branch.period", troubles,
         [&](const Setting& s) { study.period = parse_count(s, 1, longest_branch_period); });
    with(settings, "branch.starts", troubles, [&](const Setting& s) { study.starts = parse_count(s, 0, 1'000'000); });
    with(settings, "branch.max_points", troubles,
         [&](const Setting& s) { study.max_points = parse_count(s, 2, most_points); });
}

void read_locus(const SettingList& settings, const model::Specification& spec, study::LocusStudy& study,
                Troubles& troubles) {
    with(settings, "locus.boundary", troubles, [&](const Setting& s) {
        using boundary::Kind;
        const std::array<std::string, 4> names = {"fold", "flip", "torus", "grazing"};
        const std::array<Kind, 4> kinds = {Kind::fold, Kind::flip, Kind::torus, Kind::grazing};
        const std::string name = parse_choice(s, names);
        for (std::size_t i = 0; i < names.size(); ++i) {
            if (names[i] == name) { study.kind = kinds[i]; }
        }
    });
    with(settings, "locus.along", troubles, [&](const Setting& s) {
        study.along = parse_along(s, spec);
        if (model::is_frequency(*study.along)) {
            study.along.reset();
            throw bad_value(s, "the drive frequency is the other parameter already; give another key");
        }
    });
    read_range(settings, "locus", study.along, study.from, study.to, troubles);
    with(settings, "locus.steps", troubles, [&](const Setting& s) { study.steps = parse_count(s, 1, 100'000); });
    with(settings, "locus.max_points", troubles,
         [&](const Setting& s) { study.max_points = parse_count(s, 2, most_points); });
}

}  // namespace percuss::io
