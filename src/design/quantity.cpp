#include "design/quantity.hpp"

#include <algorithm>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

namespace percuss::design {

namespace {

constexpr std::size_t index(Quantity quantity) { return static_cast<std::size_t>(quantity); }

constexpr std::size_t general_count = index(Quantity::first_of_actuators);

constexpr std::array<QuantityInfo, general_count> general = {{
    {Quantity::peak_force, "peak_force", "N", "largest force on the stop over one period", true},
    {Quantity::amplitude, "amplitude", "m", "half the distance between the extrema of the displacement", true},
    {Quantity::drive_frequency, "drive_frequency", "Hz", "frequency of the drive", true},
    {Quantity::impact_velocity, "impact_velocity", "m/s", "largest velocity at entry into the stop", true},
    {Quantity::contact_time, "contact_time", "s", "time in contact with the stop per period", true},
    {Quantity::impulse, "impulse", "N s", "impulse given to the stop per period", true},
    {Quantity::stop_work, "stop_work", "J", "energy dissipated in the stop per period", true},
    {Quantity::rig_force, "rig_force", "N", "largest inertia force of the moving mass, the reaction on the rig", true},
    {Quantity::max_multiplier, "max_multiplier", "1", "largest modulus of the Floquet multipliers", true},
    {Quantity::contacts, "contacts", "1", "impacts per period", false},
    {Quantity::period, "period", "1", "period of the motion in drive cycles", false},
    {Quantity::band_lower, "band_lower", "Hz", "lower end of the single-stable impact band", true},
    {Quantity::band_upper, "band_upper", "Hz", "upper end of the single-stable impact band", true},
}};

constexpr bool table_is_in_order() {
    for (std::size_t i = 0; i < general_count; ++i) {
        if (general[i].quantity != static_cast<Quantity>(i)) { return false; }
    }
    return true;
}
static_assert(table_is_in_order());

/// In reports, what an actuator brings stands before the numbers of contacts and cycles.
constexpr std::size_t before_own = index(Quantity::contacts);

/// The general table and behind it the rows of the actuators.
class QuantityTable {
public:
    QuantityTable()
        : infos_(general.begin(), general.end()),
          own_(general_count, nullptr),
          of_(general_count, nullptr) {
        for (const model::Actuator* actuator : model::actuators()) {
            std::vector<Quantity> reported;
            for (std::size_t i = 0; i < before_own; ++i) { reported.push_back(general[i].quantity); }
            for (const model::OwnQuantity& row : actuator->quantities) {
                const auto quantity = static_cast<Quantity>(infos_.size());
                infos_.push_back({quantity, row.name, row.unit, row.meaning, true});
                own_.push_back(&row);
                of_.push_back(actuator);
                reported.push_back(quantity);
            }
            for (std::size_t i = before_own; i < general_count; ++i) { reported.push_back(general[i].quantity); }
            reported_.emplace_back(actuator, std::move(reported));
        }
        if (infos_.size() > quantity_count) { throw std::logic_error("design: quantity_count is too small"); }
    }
    [[nodiscard]] const std::vector<QuantityInfo>& infos() const { return infos_; }
    [[nodiscard]] const model::OwnQuantity* own(Quantity q) const { return own_.at(index(q)); }
    [[nodiscard]] const model::Actuator* actuator_of(Quantity q) const { return of_.at(index(q)); }
    [[nodiscard]] std::span<const Quantity> reported(const model::Actuator& actuator) const {
        const auto row = std::find_if(reported_.begin(), reported_.end(),
                                      [&](const auto& candidate) { return candidate.first == &actuator; });
        if (row == reported_.end()) { throw std::invalid_argument("design: an actuator that is not in the registry"); }
        return row->second;
    }

private:
    std::vector<QuantityInfo> infos_;
    std::vector<const model::OwnQuantity*> own_;  ///< null: general
    std::vector<const model::Actuator*> of_;
    std::vector<std::pair<const model::Actuator*, std::vector<Quantity>>> reported_;
};

const QuantityTable& table() {
    static const QuantityTable quantities;
    return quantities;
}

}  // namespace

const QuantityInfo& quantity_info(Quantity quantity) { return table().infos().at(index(quantity)); }

std::optional<Quantity> find_quantity(std::string_view name) {
    for (const QuantityInfo& info : table().infos()) {
        if (info.name == name) { return info.quantity; }
    }
    return std::nullopt;
}

const model::OwnQuantity* own_quantity(Quantity quantity) { return table().own(quantity); }

std::string_view unavailable(Quantity quantity, const model::Actuator& actuator) {
    const model::Actuator* owner = table().actuator_of(quantity);
    return owner == nullptr || owner == &actuator ? "" : owner->quantities_only_for;
}

std::span<const Quantity> reported_quantities(const model::Actuator& actuator) { return table().reported(actuator); }

}  // namespace percuss::design
