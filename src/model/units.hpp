#pragma once
/// \file
/// Quantities as text: "0.6 mm", "51.9 N/mm", "14 kPa s". Thread-safe.

#include <string>
#include <string_view>

namespace percuss::model {

/// The number that `text` stands for, in `unit` ("m", "N s/m"; "1" for pure numbers, which may be written in %).
/// A bare number is already in `unit`. Throws std::invalid_argument, saying what was expected, for anything that is
/// not one finite number with at most one unit of the same dimension: infinities, hexadecimal numbers, text after the
/// unit, scales that do not start at zero (degC), logarithmic scales, and every unit of angle. The last are refused
/// because radians and revolutions per second would otherwise pass for hertz; "rad/s" is accepted only where `unit`
/// itself is "rad/s".
double parse_quantity(std::string_view text, std::string_view unit);

/// The number that `text` stands for where no unit is allowed. Throws std::invalid_argument.
double parse_plain_number(std::string_view text);

/// Value with a handy prefix and six digits: 6e-4, "m" gives "0.6 mm". A unit of "1" or "" is not printed.
std::string format_quantity(double value, std::string_view unit);

}  // namespace percuss::model
