#pragma once
/// \file
/// The quantities a user can ask for, limit or optimise, under the names used in files, reports and code: those that
/// every actuator has, and those that the rows of the registry bring.

#include "model/specification.hpp"

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string_view>

namespace percuss::design {

/// Names of the general ones. Those of actuators follow behind them in the order of the registry: find_quantity().
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
    contacts,
    period,
    band_lower,
    band_upper,
    first_of_actuators
};
/// Room for all of them.
inline constexpr std::size_t quantity_count = 24;

struct QuantityInfo {
    Quantity quantity;
    std::string_view name;
    std::string_view unit;  ///< SI unit; "1" when a pure number
    std::string_view meaning;
    bool smooth;  ///< has a gradient (contacts and period are integers)
};

const QuantityInfo& quantity_info(Quantity quantity);
std::optional<Quantity> find_quantity(std::string_view name);

/// The actuator's own description of a quantity, or null for a general one.
const model::OwnQuantity* own_quantity(Quantity quantity);

/// Why this quantity cannot be had for a problem of this actuator, or an empty string.
std::string_view unavailable(Quantity quantity, const model::Actuator& actuator);

/// The order in which quantities are reported for an actuator: all those available.
std::span<const Quantity> reported_quantities(const model::Actuator& actuator);

}  // namespace percuss::design
