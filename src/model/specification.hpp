#pragma once
/// \file
/// An actuator as a user describes it: one number per problem-file key, SI (or nondimensional for [nondimensional]
/// problems), and the way from there to the parameters that are integrated.

#include "model/actuator.hpp"
#include "model/contact_law.hpp"
#include "model/registry.hpp"

#include <array>
#include <string>
#include <vector>

namespace percuss::model {

/// NaN marks a value that is absent.
struct Specification {
    const Actuator* type;  ///< the row of the registry that it follows; never null
    ContactLaw law = ContactLaw::kelvin_voigt;
    std::array<double, key_capacity> values{};  // filled with NaN by the constructor
    Specification();                            ///< of the first row of the registry
    explicit Specification(const Actuator& actuator);
    [[nodiscard]] double value(Key key) const { return values[static_cast<std::size_t>(key)]; }
    void set(Key key, double v) { values[static_cast<std::size_t>(key)] = v; }
    [[nodiscard]] bool has(Key key) const;
    /// The value in force: the given one, else the default, else NaN.
    [[nodiscard]] double effective(Key key) const;
};

/// Whether a specification of this actuator, contact law and material is incomplete without the key.
bool is_required(const Specification& spec, Key key);

/// Whether a drive frequency is given; without one the actuator is operated at its edge.
bool has_frequency(const Specification& spec);
/// The key in which the drive frequency of a specification is told: the one given, else the usual one.
Key frequency_key(const Specification& spec);

/// Gives every absent key of the actuator that has a default its default.
void apply_defaults(Specification& spec);

/// "stop.gap = 0.6 m", for messages about a value.
std::string assignment(Key key, double value);

/// Everything that is wrong with a specification, one sentence each naming key, value and the allowed range: values
/// out of range, missing or NaN, an outer radius not above the inner one, and so on. Empty for a good one.
std::vector<std::string> violations(const Specification& spec);

/// Throws std::invalid_argument with the first of the violations, if any.
void validate(const Specification& spec);

/// Nondimensional parameters and scales of a validated specification (paper, section 2.2; see each formula's comment).
inline Scaled scale(const Specification& spec) { return spec.type->scale(spec); }

/// Exact derivative of `scale` with respect to one key (forward differentiation of the same code).
inline Scaled scale_derivative(const Specification& spec, Key key) { return spec.type->scale_derivative(spec, key); }

}  // namespace percuss::model
