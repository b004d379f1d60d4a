#pragma once
/// \file
/// The quantities a user can ask for, limit or optimise, under the names used in files, reports and code.

#include "model/specification.hpp"

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string_view>

namespace percuss::design {

enum class Quantity : std::uint8_t {
    peak_force,
    amplitude,
    drive_frequency,
    impact_velocity,
    contact_time,
    impulse,
    stop_work,
    rig_force,
    max_multiplier,
    electric_field,
    drive_current,
    apparent_power,
    contacts,
    period,
    band_lower,
    band_upper,
    count
};
inline constexpr std::size_t quantity_count = static_cast<std::size_t>(Quantity::count);

struct QuantityInfo {
    Quantity quantity;
    std::string_view name;
    std::string_view unit;  ///< SI unit; "1" when a pure number
    std::string_view meaning;
    bool smooth;  ///< has a gradient (contacts and period are integers)
};

const QuantityInfo& quantity_info(Quantity quantity);
std::optional<Quantity> find_quantity(std::string_view name);

/// Why this quantity cannot be had for a problem of this family, or an empty string. electric_field, drive_current and
/// apparent_power exist only for SI dielectric elastomer problems; band_lower and band_upper need branch tracing,
/// which this version does not have.
std::string_view unavailable(Quantity quantity, model::Family family);

/// The order in which quantities are reported for a family: all those available.
std::span<const Quantity> reported_quantities(model::Family family);

}  // namespace percuss::design
