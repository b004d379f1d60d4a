#include "model/registry.hpp"

#include "model/coil/coil.hpp"
#include "model/membrane/membrane.hpp"
#include "model/number_text.hpp"
#include "model/spring/spring.hpp"

#include <algorithm>
#include <array>
#include <numbers>
#include <stdexcept>
#include <vector>

namespace percuss::model {

namespace {

/// One line per way to describe an actuator.
constexpr std::array<const Actuator*, 4> rows = {&membrane::si, &membrane::nondimensional, &spring::actuator,
                                                 &coil::actuator};

constexpr std::array<KeyInfo, shared_keys> shared = {
    {key_at_least(-unbounded_key, Key::stop_gap, "stop.gap", "m",
                  "position G of the stop, from rest; on a spring suspension it may be negative: pressed at rest")
         .with(Role::stop_gap),
     key_at_least(0.0, Key::stop_stiffness, "stop.stiffness", "N/m", "stiffness K of the stop")
         .with(Role::stop_stiffness),
     key_at_least(0.0, Key::stop_damping, "stop.damping", "N s/m", "damping c of the stop").with(Role::stop_damping),
     positive_key(Key::drive_frequency, "drive.frequency", "Hz",
                  "drive frequency, or edge: operate just below the edge")
         .with(Role::frequency)}};

constexpr std::size_t place(Key key) { return static_cast<std::size_t>(key); }

/// Every row of every key table by the value of its key.
class KeyTable {
public:
    KeyTable() {
        for (const KeyInfo& info : shared) { add(info); }
        for (const Actuator* actuator : rows) {
            for (const KeyInfo& info : actuator->own_keys) { add(info); }
        }
        for (const Actuator* actuator : rows) {
            for (const Key key : actuator->keys) {
                if (std::find(order_.begin(), order_.end(), key) == order_.end()) { order_.push_back(key); }
            }
        }
    }
    [[nodiscard]] const KeyInfo* at(Key key) const { return place(key) < infos_.size() ? infos_[place(key)] : nullptr; }
    [[nodiscard]] std::span<const Key> order() const { return order_; }

private:
    void add(const KeyInfo& info) {
        if (place(info.key) >= infos_.size() || infos_[place(info.key)] != nullptr) {
            throw std::logic_error("model: two keys share the number of " + std::string(info.name));
        }
        infos_[place(info.key)] = &info;
    }
    std::array<const KeyInfo*, key_capacity> infos_{};
    std::vector<Key> order_;
};

const KeyTable& table() {
    static const KeyTable keys;
    return keys;
}

}  // namespace

std::span<const Actuator* const> actuators() { return rows; }

std::span<const Key> all_keys() { return table().order(); }

const KeyInfo& key_info(Key key) {
    const KeyInfo* info = table().at(key);
    if (info == nullptr) { throw std::out_of_range("model: " + std::to_string(place(key)) + " is no key"); }
    return *info;
}

std::optional<Key> find_key(std::string_view name) {
    for (const Key key : all_keys()) {
        if (key_info(key).name == name) { return key; }
    }
    return std::nullopt;
}

bool belongs(Key key, const Actuator& actuator) {
    return std::find(actuator.keys.begin(), actuator.keys.end(), key) != actuator.keys.end();
}

std::optional<Key> counterpart(Key key, const Actuator& actuator) {
    const Role role = key_info(key).role;
    if (role == Role::none) { return std::nullopt; }
    std::optional<Key> found;
    for (const Key own : actuator.keys) {
        // Where an actuator has a key of its own for the role beside the shared one, its own is meant.
        const bool better = !found || (place(*found) < shared_keys && place(own) >= shared_keys);
        if (key_info(own).role == role && better) { found = own; }
    }
    return found == key ? std::nullopt : found;
}

std::optional<Key> key_of(Role role, const Actuator& actuator) {
    for (const Key key : actuator.keys) {
        if (key_info(key).role == role) { return key; }
    }
    return std::nullopt;
}

bool is_of_stop(Key key) {
    const Role role = key_info(key).role;
    return role == Role::stop_gap || role == Role::stop_stiffness || role == Role::stop_damping;
}

double per_radian(Key frequency) { return key_info(frequency).unit == "Hz" ? 1.0 / (2.0 * std::numbers::pi) : 1.0; }

std::string allowed_range(const KeyInfo& info) {
    const bool below_bounded = info.lowest > -unbounded_key;
    const bool above_bounded = info.highest < unbounded_key;
    if (!below_bounded && !above_bounded) { return "any finite number"; }
    std::string text;
    if (below_bounded) { text = (info.lowest_allowed ? "at least " : "above ") + number_text(info.lowest); }
    if (above_bounded) { text += (below_bounded ? ", at most " : "at most ") + number_text(info.highest); }
    return text;
}

double scale_of(const ScalePowers& powers, const Scales& scales) {
    double product = 1.0;
    const auto factor = [&](double scale, int exponent) {
        for (; exponent > 0; --exponent) { product *= scale; }
        for (; exponent < 0; ++exponent) { product /= scale; }
    };
    factor(scales.length, powers.length);
    factor(scales.time, powers.time);
    factor(scales.force, powers.force);
    for (std::size_t i = 0; i < max_own_scales; ++i) { factor(scales.own[i], powers.own[i]); }
    return product;
}

double scale_derivative(const ScalePowers& powers, const Scales& scales, const Scales& d) {
    const double value = scale_of(powers, scales);
    double sum = 0.0;
    const auto factor = [&](double scale, double moved, int exponent) {
        if (moved != 0.0) { sum += static_cast<double>(exponent) * value * moved / scale; }
    };
    factor(scales.length, d.length, powers.length);
    factor(scales.time, d.time, powers.time);
    factor(scales.force, d.force, powers.force);
    for (std::size_t i = 0; i < max_own_scales; ++i) { factor(scales.own[i], d.own[i], powers.own[i]); }
    return sum;
}

}  // namespace percuss::model
