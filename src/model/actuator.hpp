#pragma once
/// \file
/// The descriptor of an actuator: everything that distinguishes one way of describing an actuator in a problem file
/// from another. Readers, printers and verbs ask it; none of them compares kinds.

#include "model/scene.hpp"

#include <array>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace percuss::model {

/// A numeric key of a problem file that describes the physical system or the drive. Only those that several actuators
/// share have names here; the others stand in the folder of their actuator, which numbers them with own_key().
enum class Key : std::uint16_t { stop_gap, stop_stiffness, stop_damping, drive_frequency };

inline constexpr std::size_t shared_keys = 4;
inline constexpr int keys_per_actuator = 32;
/// Values that a Key may have: the shared block and those of up to seven rows.
inline constexpr std::size_t key_capacity = 8 * keys_per_actuator;

/// Key number `index` of the block of one row of the registry; block 0 is that of the shared keys. The registry refuses
/// two keys of one value.
constexpr Key own_key(int block, int index) { return static_cast<Key>(block * keys_per_actuator + index); }

/// What a key means to those who do not care which actuator it belongs to.
enum class Role : std::uint8_t { none, stop_gap, stop_stiffness, stop_damping, drive, frequency, layers };

/// What is known of a key: its name in files ("stop.gap"), the unit its value is kept in ("m"; "1" when
/// dimensionless), what is allowed, and a default where one exists.
struct KeyInfo {
    Key key;
    std::string_view name;
    std::string_view unit;
    double lowest;  ///< allowed range
    double highest;
    bool lowest_allowed;             ///< whether `lowest` itself is allowed
    std::optional<double> fallback;  ///< default; empty: required (frequencies: empty = edge)
    std::string_view meaning;
    Role role = Role::none;
    bool integer = false;  ///< a whole number

    [[nodiscard]] constexpr KeyInfo with(Role r) const {
        KeyInfo copy = *this;
        copy.role = r;
        return copy;
    }
    [[nodiscard]] constexpr KeyInfo whole() const {
        KeyInfo copy = *this;
        copy.integer = true;
        return copy;
    }
};

// Rows of a key table: above zero; at least something; any finite number with a default.
inline constexpr double unbounded_key = std::numeric_limits<double>::infinity();
constexpr KeyInfo positive_key(Key key, std::string_view name, std::string_view unit, std::string_view meaning,
                               double highest = unbounded_key) {
    return {key, name, unit, 0.0, highest, false, std::nullopt, meaning};
}
constexpr KeyInfo key_at_least(double lowest, Key key, std::string_view name, std::string_view unit,
                               std::string_view meaning, double highest = unbounded_key,
                               std::optional<double> fallback = std::nullopt) {
    return {key, name, unit, lowest, highest, true, fallback, meaning};
}
constexpr KeyInfo any_key(Key key, std::string_view name, std::string_view unit, std::string_view meaning,
                          double fallback) {
    return {key, name, unit, -unbounded_key, unbounded_key, false, fallback, meaning};
}

/// Scale factors that an actuator may have besides length, time and force.
inline constexpr std::size_t max_own_scales = 3;

/// What one nondimensional unit is in SI, per quantity: conversion factor from the integrator's observable to the
/// reported quantity. All ones for nondimensional problems.
struct Scales {
    double length = 1.0;                                       ///< [m]
    double time = 1.0;                                         ///< [s]
    double force = 1.0;                                        ///< [N]
    std::array<double, max_own_scales> own{1.0, 1.0, 1.0};     ///< meaning and unit given by the actuator
    std::array<double, max_states> state{1.0, 1.0, 1.0, 1.0};  ///< of each state; not set in derivatives of scales
};

/// A product of powers of the scales.
struct ScalePowers {
    int length = 0;
    int time = 0;
    int force = 0;
    std::array<int, max_own_scales> own{};
};
double scale_of(const ScalePowers& powers, const Scales& scales);
/// Exact derivative of scale_of() when the scales move by `d`: d(log f) is the sum of exponent times d(log factor).
double scale_derivative(const ScalePowers& powers, const Scales& scales, const Scales& d);

struct Scaled {
    Parameters parameters{};  ///< omega entry: 2 pi f Gamma when a frequency is given, else 0
    Scales scales;
};

/// A state as it is printed.
struct StateInfo {
    std::string_view name;
    std::string_view unit;  ///< SI; empty: a pure number
    ScalePowers scale;
    bool positive = false;  ///< only positive values mean anything
};

/// A drive signal as a time series shows it: the amplitude key's value (times the share that a kick leaves of it) times
/// a shape over the phase.
struct DriveSignal {
    std::string_view name;
    std::string_view unit;
    double (*shape)(double phase);
};

/// A quantity that only this actuator has: a peak or a mean signal of its scenes times a scale.
struct OwnQuantity {
    std::string_view name;
    std::string_view unit;
    std::string_view meaning;
    enum class From : std::uint8_t { peak, mean } from = From::peak;
    int signal = 0;  ///< index among the scene's peaks or means
    ScalePowers scale;
};

struct Specification;

/// One row of the registry: a way to describe an actuator in a problem file.
struct Actuator {
    std::string_view type;  ///< value of actuator.type
    std::string_view kind;  ///< in messages: "a spring-mass problem"
    /// Sections that tell it, with their dots, and the words that ask for them.
    std::span<const std::string_view> sections;
    std::string_view sections_in_words;
    bool nondimensional = false;  ///< values are plain numbers without units
    bool follows_type = false;    ///< actuator.type alone chooses it among rows of one type

    std::span<const KeyInfo> own_keys;  ///< table of the keys that belong to this row alone
    std::span<const Key> keys;          ///< all of its keys in file order, shared ones included
    std::span<const Key> frequencies;   ///< its ways to give the drive frequency, the usual one first

    std::string_view drive_word;  ///< what a kick of the drive is called: "voltage"
    std::span<const DriveSignal> drives;
    std::span<const StateInfo> states;  ///< of the scene with the most states; others leave out the last ones
    std::string_view positive_states;   ///< subject of "must be positive", where states must be
    std::span<const std::string_view> parameters;  ///< names of the nondimensional parameters, and their roles
    ParameterRoles roles;
    std::span<const OwnQuantity> quantities;
    std::string_view quantities_only_for;  ///< "exists only for ...": said where they are asked for elsewhere

    Scaled (*scale)(const Specification&);
    Scaled (*scale_derivative)(const Specification&, Key);
    /// The equations that a specification needs.
    const Scene& (*scene)(const Specification&);
    /// Whether a key without default may be left out of this very specification.
    bool (*may_be_absent)(const Specification&, Key);
    /// Appends what is wrong besides values out of range.
    void (*check)(const Specification&, std::vector<std::string>& found);
};

}  // namespace percuss::model
