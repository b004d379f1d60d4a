#pragma once
/// \file
/// The list of actuators and what is looked up in it.

#include "model/actuator.hpp"

#include <optional>
#include <span>
#include <string>
#include <string_view>

namespace percuss::model {

/// Every row, in the order in which they are shown.
std::span<const Actuator* const> actuators();

/// Every key of every actuator, those shared told once, in file order.
std::span<const Key> all_keys();

/// Throws std::out_of_range for a value that is no key.
const KeyInfo& key_info(Key key);
/// The key with this file name, or nothing.
std::optional<Key> find_key(std::string_view name);
bool belongs(Key key, const Actuator& actuator);
/// The key of the actuator that plays the role which `key` plays in another one; its own before a shared one.
std::optional<Key> counterpart(Key key, const Actuator& actuator);
/// The key of this role, or nothing: the first in file order.
std::optional<Key> key_of(Role role, const Actuator& actuator);

inline bool is_frequency(Key key) { return key_info(key).role == Role::frequency; }
/// Whether the key means something only where there is a stop.
bool is_of_stop(Key key);
/// Angular frequency in rad/s (or nondimensional) to the unit of a frequency key: 1, or 1/(2 pi) for those in Hz.
double per_radian(Key frequency);

/// The range of a key in words: "above 0", "at least 1, at most 64".
std::string allowed_range(const KeyInfo& info);

}  // namespace percuss::model
