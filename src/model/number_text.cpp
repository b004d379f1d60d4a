#include "model/number_text.hpp"

#include <array>
#include <charconv>
#include <cmath>

namespace percuss::model {

std::string_view trimmed(std::string_view text) {
    constexpr std::string_view blanks = " \t\r\n\f\v";
    const auto first = text.find_first_not_of(blanks);
    if (first == std::string_view::npos) { return {}; }
    return text.substr(first, text.find_last_not_of(blanks) - first + 1);
}

std::optional<double> leading_number(std::string_view text, std::string_view& rest) {
    text = trimmed(text);
    std::string_view digits = text;
    // std::from_chars takes no plus sign.
    if (digits.starts_with('+')) {
        digits.remove_prefix(1);
        if (digits.starts_with('-')) { return std::nullopt; }
    }
    const std::string_view unsigned_digits = digits.starts_with('-') ? digits.substr(1) : digits;
    if (unsigned_digits.empty() ||
        std::string_view("0123456789.").find(unsigned_digits.front()) == std::string_view::npos) {
        return std::nullopt;  // also inf and nan
    }
    double value = 0.0;
    const auto [end, error] = std::from_chars(digits.data(), digits.data() + digits.size(), value);
    if (error != std::errc() || !std::isfinite(value)) { return std::nullopt; }
    rest = digits.substr(static_cast<std::size_t>(end - digits.data()));
    return value;
}

std::optional<double> whole_number_text(std::string_view text) {
    std::string_view rest;
    const auto value = leading_number(text, rest);
    if (!value || !trimmed(rest).empty()) { return std::nullopt; }
    return value;
}

std::optional<double> shifted_number(std::string_view digits, int exponent) {
    std::string text(trimmed(digits));
    const auto mark = text.find_first_of("eE");
    if (mark != std::string::npos) {
        // The text's own exponent and the shift become one; std::from_chars takes no plus sign.
        const std::string_view own = std::string_view(text).substr(text[mark + 1] == '+' ? mark + 2 : mark + 1);
        int own_exponent = 0;
        if (std::from_chars(own.data(), own.data() + own.size(), own_exponent).ec != std::errc()) {
            return std::nullopt;
        }
        exponent += own_exponent;
        text.erase(mark);
    }
    return whole_number_text(text + "e" + std::to_string(exponent));
}

std::string number_text(double value, int digits) {
    std::array<char, 64> buffer{};
    const auto [end, error] =
        std::to_chars(buffer.data(), buffer.data() + buffer.size(), value, std::chars_format::general, digits);
    return {buffer.data(), error == std::errc() ? end : buffer.data()};
}

std::string exact_text(double value) {
    std::array<char, 64> buffer{};
    // The shortest text that reads back as the same number.
    const auto [end, error] = std::to_chars(buffer.data(), buffer.data() + buffer.size(), value);
    return {buffer.data(), error == std::errc() ? end : buffer.data()};
}

}  // namespace percuss::model
