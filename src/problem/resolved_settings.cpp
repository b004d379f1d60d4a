#include "problem/resolved_settings.hpp"

#include "model/number_text.hpp"
#include "model/units.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <utility>

namespace percuss::problem {

namespace {

/// The rows of a section as they are told: keys of the actuator in the actuator's own order, before the rest.
std::vector<const Row*> in_told_order(const Section& section, const model::Actuator& family) {
    std::vector<const Row*> rows;
    for (const Row& row : section.rows) { rows.push_back(&row); }
    const auto keys = family.keys;
    const auto rank = [&](const Row* row) -> std::ptrdiff_t {
        const auto key = model::find_key(row->name);
        if (!key) { return row->name == "actuator.type" ? -1 : std::ssize(keys); }
        return std::find(keys.begin(), keys.end(), *key) - keys.begin();
    };
    std::stable_sort(rows.begin(), rows.end(), [&](const Row* a, const Row* b) { return rank(a) < rank(b); });
    return rows;
}

class Resolver {
public:
    Resolver(const ProblemFile& problem, const SettingList& given) : problem_(problem), given_(given) {}

    void add(const Section& section) {
        const Context context{problem_.design.actuator};
        for (const Row* row : in_told_order(section, *problem_.design.actuator.type)) {
            const std::vector<Echo> echoes = row->get(options_of(problem_, section), context);
            for (std::size_t i = 0; i < echoes.size(); ++i) { add(*row, echoes[i], i); }
        }
    }

    std::vector<ResolvedSetting> take() { return std::move(resolved_); }

private:
    void add(const Row& row, const Echo& echo, std::size_t entry) {
        ResolvedSetting setting;
        setting.name = row.name;
        setting.value = echo.value;
        setting.unit = echo.unit;
        setting.text = echo.text;
        setting.exact = echo.exact;
        setting.repeatable = row.repeatable();
        setting.of_run = row.of_run;
        const Setting* given = given_.find(row.name, row.repeatable() ? entry : 0);
        setting.origin = given == nullptr ? Origin::fallback : given->from_option ? Origin::option : Origin::file;
        setting.trouble = trouble_of(row);
        resolved_.push_back(std::move(setting));
    }

    /// Only keys that stand once: a trouble with one of several limits is not a trouble with the others.
    [[nodiscard]] std::string trouble_of(const Row& row) const {
        if (row.section() == "design") { return ""; }
        const std::string& name = row.name;
        for (const std::string& trouble : problem_.troubles) {
            // The ways in which messages begin with a key.
            for (const std::string& beginning : {name + " ", name + ":", "--" + name + " ", "option --" + name + ":"}) {
                if (trouble.starts_with(beginning)) { return trouble; }
            }
        }
        return "";
    }

    const ProblemFile& problem_;
    const SettingList& given_;
    std::vector<ResolvedSetting> resolved_;
};

/// The hash of Fowler, Noll and Vo with 64 bits: the same digits on every machine, which std::hash does not promise. It
/// tells problems apart and protects against nothing.
class Fnv1a {
public:
    void add(std::string_view text) {
        for (const char c : text) { hash_ = (hash_ ^ static_cast<unsigned char>(c)) * prime; }
    }
    [[nodiscard]] std::string text() const {
        std::array<char, 17> digits{};
        std::snprintf(digits.data(), digits.size(), "%016llx", static_cast<unsigned long long>(hash_));
        return digits.data();
    }

private:
    static constexpr std::uint64_t offset_basis = 14695981039346656037U;
    static constexpr std::uint64_t prime = 1099511628211U;
    std::uint64_t hash_ = offset_basis;
};

}  // namespace

std::vector<ResolvedSetting> resolve_settings(const ProblemFile& problem, std::span<const Section> sections,
                                              const SettingList& given) {
    Resolver resolver(problem, given);
    for (const Section& section : sections) { resolver.add(section); }
    return resolver.take();
}

std::string problem_hash(const ProblemFile& problem) {
    Fnv1a hash;
    for (const ResolvedSetting& setting : problem.settings) {
        const bool is_number = !std::isnan(setting.value);
        if (setting.exact.empty() && !setting.of_run) {
            // Numbers by their exact text: two problems that print alike may differ in the last digit.
            hash.add(setting.name + "=" + (is_number ? model::exact_text(setting.value) : setting.text) + "\n");
        }
    }
    for (const ResolvedSetting& setting : problem.settings) {
        if (!setting.exact.empty()) { hash.add(setting.exact + "\n"); }
    }
    return hash.text();
}

namespace {

/// As exact_text, but counts stay whole numbers: readers of counts take no "1e+05".
std::string number_in_file(double value) {
    constexpr double exact_integers = 1e15;
    const bool is_count = value == std::floor(value) && std::abs(value) < exact_integers;
    return is_count ? std::to_string(static_cast<long long>(value)) : model::exact_text(value);
}

}  // namespace

std::string problem_text(const ProblemFile& problem, const std::function<bool(const ResolvedSetting&)>& told) {
    std::string text;
    for (const ResolvedSetting& setting : problem.settings) {
        if (!told(setting)) { continue; }
        const std::string value = !setting.exact.empty()    ? setting.exact
                                : std::isnan(setting.value) ? setting.text
                                                            : number_in_file(setting.value);
        text += setting.name + " = " + value + "\n";
    }
    return text;
}

std::string_view to_string(Origin origin) {
    switch (origin) {
        case Origin::file: return "file";
        case Origin::option: return "option";
        case Origin::fallback: return "default";
    }
    return "unknown";
}

bool is_nondimensional(const design::Problem& problem) { return problem.actuator.type->nondimensional; }

std::string_view units_of(const ProblemFile& problem) {
    return is_nondimensional(problem.design) ? "nondimensional" : "si";
}

std::string text_of(const ProblemFile& problem, design::Quantity quantity, double value) {
    return model::format_quantity(value,
                                  is_nondimensional(problem.design) ? "1" : design::quantity_info(quantity).unit);
}

}  // namespace percuss::problem
