#include "model/units.hpp"

#include "model/number_text.hpp"

#include <algorithm>
#include <array>
#include <cctype>
#include <cmath>
#include <cstdint>
#include <memory>
#include <mutex>
#include <optional>
#include <span>
#include <stdexcept>
#include <utility>
#include <vector>

#include <udunits2.h>

namespace percuss::model {

namespace {

struct FreeUnit {
    void operator()(ut_unit* unit) const { ut_free(unit); }
};
struct FreeConverter {
    void operator()(cv_converter* converter) const { cv_free(converter); }
};
using Unit = std::unique_ptr<ut_unit, FreeUnit>;
using Converter = std::unique_ptr<cv_converter, FreeConverter>;

enum class Outcome : std::uint8_t { ok, unknown, angle, wrong_dimension, not_proportional };

struct Factor {
    Outcome outcome = Outcome::unknown;
    double value = 0.0;
};

/// The units database. UDUNITS parses with global state, so one caller at a time.
class Database {
public:
    static Database& instance() {
        static Database database;
        return database;
    }

    /// Factor from one unit to another.
    Factor factor(const std::string& from_text, const std::string& to_text) {
        const std::lock_guard lock(mutex_);
        const Unit from(ut_parse(system_.get(), from_text.c_str(), UT_UTF8));
        if (!from) { return {Outcome::unknown, 0.0}; }
        // UDUNITS converts rad/s to Hz with factor 1 and takes 3600 rpm for 377 Hz: frequencies would be read wrongly
        // without a word.
        if (mentions_angle(from.get())) { return {Outcome::angle, 0.0}; }
        const Unit to(ut_parse(system_.get(), to_text.c_str(), UT_ASCII));
        if (!to) { throw std::logic_error("units: the database does not know " + to_text); }
        if (ut_are_convertible(from.get(), to.get()) == 0) { return {Outcome::wrong_dimension, 0.0}; }
        const Converter converter(ut_get_converter(from.get(), to.get()));
        if (!converter) { return {Outcome::wrong_dimension, 0.0}; }
        const double one = cv_convert_double(converter.get(), 1.0);
        // A shifted (degree Celsius) or logarithmic scale is no factor: two points tell.
        const double thousand = cv_convert_double(converter.get(), 1000.0);
        const bool proportional =
            std::isfinite(one) && one > 0.0 && std::abs(thousand - 1000.0 * one) <= 1e-9 * thousand;
        return {proportional ? Outcome::ok : Outcome::not_proportional, one};
    }

private:
    struct FreeSystem {
        void operator()(ut_system* system) const { ut_free_system(system); }
    };

    Database() {
        ut_set_error_message_handler(ut_ignore);
        system_.reset(ut_read_xml(nullptr));
        if (!system_) { throw std::runtime_error("units: the UDUNITS-2 database cannot be read"); }
    }

    /// Written out in base units, every plane and solid angle shows its radian.
    static bool mentions_angle(const ut_unit* unit) {
        std::array<char, 512> buffer{};
        const int length = ut_format(unit, buffer.data(), buffer.size(), UT_ASCII | UT_DEFINITION);
        return length < 0 || std::string_view(buffer.data()).find("rad") != std::string_view::npos;
    }

    std::mutex mutex_;
    std::unique_ptr<ut_system, FreeSystem> system_;
};

bool is_letter(char c) {
    const auto byte = static_cast<unsigned char>(c);
    return std::isalpha(byte) != 0 || byte >= 0x80U || c == '%' || c == '_';
}
bool is_digit(char c) { return std::isdigit(static_cast<unsigned char>(c)) != 0; }

/// Units are products and quotients of names with integer powers: "kPa s", "N/m^3", "kg.m.s-2", "1/s". Other things
/// that the database would read (numbers inside, origins, dates, logarithms) are refused here.
bool is_product_of_powers(std::string_view unit) {
    std::size_t i = 0;
    const auto skip_blanks = [&] {
        while (i < unit.size() && unit[i] == ' ') { ++i; }
    };
    if (unit.starts_with("1/")) { i = 2; }
    while (true) {
        skip_blanks();
        if (i >= unit.size() || !is_letter(unit[i])) { return false; }
        while (i < unit.size() && is_letter(unit[i])) { ++i; }
        if (i < unit.size() && unit[i] == '^') { ++i; }
        if (i < unit.size() && unit[i] == '-') {
            ++i;
            if (i >= unit.size() || !is_digit(unit[i])) { return false; }
        }
        if (i < unit.size() && is_digit(unit[i])) {
            ++i;
        } else if (unit[i - 1] == '^') {
            return false;
        }
        const std::size_t factor_end = i;
        skip_blanks();
        if (i >= unit.size()) { return true; }
        if (unit[i] == '/' || unit[i] == '.' || unit[i] == '*') {
            ++i;
        } else if (i == factor_end) {
            return false;
        }
    }
}

std::string quoted(std::string_view text) { return "'" + std::string(text) + "'"; }

/// What a reader may write instead, for messages.
std::string expectation(std::string_view unit) {
    if (unit == "1") { return "expected a pure number"; }
    return "expected a number with a unit of the dimension of " + std::string(unit) + ", or a bare number in " +
           std::string(unit);
}

[[noreturn]] void refuse(std::string_view text, std::string_view why, std::string_view unit) {
    throw std::invalid_argument(quoted(text) + " " + std::string(why) + ": " + expectation(unit));
}

/// `value`, the number at the beginning of `text`, from the unit `suffix` to `unit`. Throws std::invalid_argument with
/// the reason.
double convert(std::string_view text, double value, std::string_view suffix, std::string_view unit) {
    // Nothing to convert. A pure number has no unit that could be written.
    if (suffix == unit && unit != "1") { return value; }
    // Of angular frequencies only rad/s itself is taken: the database would take Hz for the same.
    if (unit == "rad/s") { refuse(text, "is not an angular frequency in rad/s", unit); }
    if (!is_product_of_powers(suffix)) { refuse(text, "is not one number with one unit", unit); }
    const Factor factor = Database::instance().factor(std::string(suffix), std::string(unit));
    switch (factor.outcome) {
        case Outcome::ok: break;
        case Outcome::unknown: refuse(text, "has an unknown unit", unit);
        case Outcome::angle: refuse(text, "has a unit of angle", unit);
        case Outcome::wrong_dimension: refuse(text, "has the wrong dimension", unit);
        case Outcome::not_proportional: refuse(text, "has a unit with a shifted or logarithmic scale", unit);
    }
    // Powers of ten are applied to the digits, so that "2.672 g" is the same number as "0.002672".
    const double exponent = std::nearbyint(std::log10(factor.value));
    const bool is_power_of_ten = std::abs(factor.value / std::pow(10.0, exponent) - 1.0) < 1e-14;
    const std::string_view digits = text.substr(0, text.size() - suffix.size());
    const auto converted =
        is_power_of_ten ? shifted_number(digits, static_cast<int>(exponent)) : std::optional(value * factor.value);
    if (!converted || !std::isfinite(*converted)) { refuse(text, "is too large", unit); }
    return *converted;
}

struct Prefixed {
    std::string_view unit;
    double factor;  ///< one of it in the base unit
};

/// Units offered for printing, largest first.
std::span<const Prefixed> printable(std::string_view unit) {
    static constexpr std::array length = {Prefixed{"m", 1.0}, Prefixed{"mm", 1e-3}, Prefixed{"um", 1e-6},
                                          Prefixed{"nm", 1e-9}};
    static constexpr std::array mass = {Prefixed{"kg", 1.0}, Prefixed{"g", 1e-3}, Prefixed{"mg", 1e-6}};
    static constexpr std::array time = {Prefixed{"s", 1.0}, Prefixed{"ms", 1e-3}, Prefixed{"us", 1e-6}};
    static constexpr std::array pressure = {Prefixed{"MPa", 1e6}, Prefixed{"kPa", 1e3}, Prefixed{"Pa", 1.0}};
    static constexpr std::array viscosity = {Prefixed{"kPa s", 1e3}, Prefixed{"Pa s", 1.0}};
    static constexpr std::array stiffness = {Prefixed{"N/mm", 1e3}, Prefixed{"N/m", 1.0}};
    static constexpr std::array voltage = {Prefixed{"kV", 1e3}, Prefixed{"V", 1.0}, Prefixed{"mV", 1e-3}};
    static constexpr std::array frequency = {Prefixed{"kHz", 1e3}, Prefixed{"Hz", 1.0}};
    static constexpr std::array force = {Prefixed{"kN", 1e3}, Prefixed{"N", 1.0}, Prefixed{"mN", 1e-3},
                                         Prefixed{"uN", 1e-6}};
    static constexpr std::array speed = {Prefixed{"m/s", 1.0}, Prefixed{"mm/s", 1e-3}};
    static constexpr std::array energy = {Prefixed{"J", 1.0}, Prefixed{"mJ", 1e-3}, Prefixed{"uJ", 1e-6}};
    static constexpr std::array impulse = {Prefixed{"N s", 1.0}, Prefixed{"mN s", 1e-3}, Prefixed{"uN s", 1e-6}};
    static constexpr std::array field = {Prefixed{"V/um", 1e6}, Prefixed{"V/mm", 1e3}, Prefixed{"V/m", 1.0}};
    static constexpr std::array current = {Prefixed{"A", 1.0}, Prefixed{"mA", 1e-3}, Prefixed{"uA", 1e-6}};
    static constexpr std::array power = {Prefixed{"VA", 1.0}, Prefixed{"mVA", 1e-3}};
    static constexpr std::array heat = {Prefixed{"W", 1.0}, Prefixed{"mW", 1e-3}};
    static constexpr std::array inductance = {Prefixed{"H", 1.0}, Prefixed{"mH", 1e-3}, Prefixed{"uH", 1e-6}};
    static constexpr std::array<std::pair<std::string_view, std::span<const Prefixed>>, 17> all = {{{"m", length},
                                                                                                    {"kg", mass},
                                                                                                    {"s", time},
                                                                                                    {"Pa", pressure},
                                                                                                    {"Pa s", viscosity},
                                                                                                    {"N/m", stiffness},
                                                                                                    {"V", voltage},
                                                                                                    {"Hz", frequency},
                                                                                                    {"N", force},
                                                                                                    {"m/s", speed},
                                                                                                    {"J", energy},
                                                                                                    {"N s", impulse},
                                                                                                    {"V/m", field},
                                                                                                    {"A", current},
                                                                                                    {"VA", power},
                                                                                                    {"W", heat},
                                                                                                    {"H", inductance}}};
    for (const auto& [base, choices] : all) {
        if (base == unit) { return choices; }
    }
    return {};
}

/// 0.6 mm rather than 600 um, but 220 Pa s rather than 0.22 kPa s.
double smallest_mantissa(const Prefixed& choice) { return choice.factor > 1.0 ? 1.0 : 0.1; }

}  // namespace

double parse_plain_number(std::string_view text) {
    const auto value = whole_number_text(text);
    if (!value) {
        throw std::invalid_argument(quoted(trimmed(text)) +
                                    " is not a finite number: expected a plain number without unit");
    }
    return *value;
}

double parse_quantity(std::string_view text, std::string_view unit) {
    text = trimmed(text);
    std::string_view rest;
    const auto value = leading_number(text, rest);
    if (!value) { refuse(text, "does not begin with a finite number", unit); }
    const std::string_view suffix = trimmed(rest);
    return suffix.empty() ? *value : convert(text, *value, suffix, unit);
}

std::string format_quantity(double value, std::string_view unit) {
    if (unit.empty() || unit == "1") { return number_text(value); }
    const auto choices = printable(unit);
    if (choices.empty() || value == 0.0 || !std::isfinite(value)) {
        return number_text(value) + " " + std::string(unit);
    }
    const auto fits = [&](const Prefixed& choice) {
        return std::abs(value) >= smallest_mantissa(choice) * choice.factor;
    };
    const auto found = std::find_if(choices.begin(), choices.end(), fits);
    const Prefixed& choice = found == choices.end() ? choices.back() : *found;
    return number_text(value / choice.factor) + " " + std::string(choice.unit);
}

}  // namespace percuss::model
