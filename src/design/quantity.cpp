#include "design/quantity.hpp"

#include <stdexcept>

namespace percuss::design {

namespace {

using model::Family;

constexpr std::array<QuantityInfo, quantity_count> table = {{
    {Quantity::peak_force, "peak_force", "N", "largest force on the stop over one period", true},
    {Quantity::amplitude, "amplitude", "m", "half the distance between the extrema of the displacement", true},
    {Quantity::drive_frequency, "drive_frequency", "Hz", "frequency of the drive", true},
    {Quantity::impact_velocity, "impact_velocity", "m/s", "largest velocity at entry into the stop", true},
    {Quantity::contact_time, "contact_time", "s", "time in contact with the stop per period", true},
    {Quantity::impulse, "impulse", "N s", "impulse given to the stop per period", true},
    {Quantity::stop_work, "stop_work", "J", "energy dissipated in the stop per period", true},
    {Quantity::rig_force, "rig_force", "N", "largest inertia force of the moving mass, the reaction on the rig", true},
    {Quantity::max_multiplier, "max_multiplier", "1", "largest modulus of the Floquet multipliers", true},
    {Quantity::electric_field, "electric_field", "V/m", "largest true electric field in a membrane", true},
    {Quantity::drive_current, "drive_current", "A", "largest current per side, all layers", true},
    {Quantity::apparent_power, "apparent_power", "VA", "drive voltage times drive_current", true},
    {Quantity::contacts, "contacts", "1", "impacts per period", false},
    {Quantity::period, "period", "1", "period of the motion in drive cycles", false},
    {Quantity::band_lower, "band_lower", "Hz", "lower end of the single-stable impact band", true},
    {Quantity::band_upper, "band_upper", "Hz", "upper end of the single-stable impact band", true},
}};

constexpr bool table_is_in_order() {
    for (std::size_t i = 0; i < quantity_count; ++i) {
        if (table[i].quantity != static_cast<Quantity>(i)) { return false; }
    }
    return true;
}
static_assert(table_is_in_order());

constexpr std::array mechanical = {Quantity::peak_force,      Quantity::amplitude,    Quantity::drive_frequency,
                                   Quantity::impact_velocity, Quantity::contact_time, Quantity::impulse,
                                   Quantity::stop_work,       Quantity::rig_force,    Quantity::max_multiplier,
                                   Quantity::contacts,        Quantity::period,       Quantity::band_lower,
                                   Quantity::band_upper};

constexpr std::array electromechanical = {
    Quantity::peak_force,     Quantity::amplitude,      Quantity::drive_frequency, Quantity::impact_velocity,
    Quantity::contact_time,   Quantity::impulse,        Quantity::stop_work,       Quantity::rig_force,
    Quantity::max_multiplier, Quantity::electric_field, Quantity::drive_current,   Quantity::apparent_power,
    Quantity::contacts,       Quantity::period,         Quantity::band_lower,      Quantity::band_upper};

}  // namespace

const QuantityInfo& quantity_info(Quantity quantity) { return table.at(static_cast<std::size_t>(quantity)); }

std::optional<Quantity> find_quantity(std::string_view name) {
    for (const QuantityInfo& info : table) {
        if (info.name == name) { return info.quantity; }
    }
    return std::nullopt;
}

std::string_view unavailable(Quantity quantity, Family family) {
    switch (quantity) {
        case Quantity::electric_field:
        case Quantity::drive_current:
        case Quantity::apparent_power:
            return family == Family::dielectric_elastomer_si
                     ? ""
                     : "exists only for dielectric elastomer problems given in SI units";
        default: return "";
    }
}

std::span<const Quantity> reported_quantities(Family family) {
    switch (family) {
        case Family::dielectric_elastomer_si: return electromechanical;
        case Family::dielectric_elastomer_nondimensional:
        case Family::spring_mass: return mechanical;
    }
    throw std::invalid_argument("design: unknown family");
}

}  // namespace percuss::design
