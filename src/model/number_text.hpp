#pragma once
/// \file
/// Plain numbers to text and back, independent of the locale.

#include <optional>
#include <string>
#include <string_view>

namespace percuss::model {

/// Text without blanks at both ends.
std::string_view trimmed(std::string_view text);

/// A finite decimal number at the start of `text` ("1.5", "-2e-3", "+4"); `rest` becomes what follows it. Nothing for
/// inf, nan, hexadecimal notation and numbers that overflow.
std::optional<double> leading_number(std::string_view text, std::string_view& rest);

/// The whole text as one finite decimal number, blanks at both ends aside.
std::optional<double> whole_number_text(std::string_view text);

/// The number that `digits` (as leading_number takes it) times 10^exponent stands for, rounded once.
std::optional<double> shifted_number(std::string_view digits, int exponent);

/// Usual notation with at most `digits` significant digits.
std::string number_text(double value, int digits = 6);

/// Shortest notation that reads back to the same number.
std::string exact_text(double value);

}  // namespace percuss::model
