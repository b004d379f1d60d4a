#pragma once
/// \file
/// How an actuator's folder writes its scaling once: a template over the scalar, from which the value and the exact
/// derivative with respect to a key are both made.

#include "model/specification.hpp"
#include "numerics/forward_dual.hpp"

#include <array>
#include <stdexcept>
#include <string>

namespace percuss::model {

/// A specification read as scalars of type T: absent values read as their default, else as zero.
template <class T>
struct Values {
    std::array<T, key_capacity> at{};
    ContactLaw law = ContactLaw::kelvin_voigt;

    explicit Values(const Specification& spec) : law(spec.law) {
        for (const Key key : spec.type->keys) {
            at[static_cast<std::size_t>(key)] = spec.has(key) ? spec.value(key) : key_info(key).fallback.value_or(0.0);
        }
    }
    const T& operator[](Key key) const { return at[static_cast<std::size_t>(key)]; }
};

/// Scaled over the scalar T.
template <class T>
struct ScaledValues {
    std::array<T, max_parameters> parameters{};
    T length = 1.0;
    T time = 1.0;
    T force = 1.0;
    std::array<T, max_own_scales> own{1.0, 1.0, 1.0};
};

inline double number(double x) { return x; }
inline double number(const numerics::ForwardDual& x) { return x.value; }

template <class T, class Part>
Scaled collect(const ScaledValues<T>& values, Part part) {
    Scaled out;
    for (std::size_t i = 0; i < out.parameters.size(); ++i) { out.parameters[i] = part(values.parameters[i]); }
    out.scales = {part(values.length),
                  part(values.time),
                  part(values.force),
                  {part(values.own[0]), part(values.own[1]), part(values.own[2])},
                  {}};
    return out;
}

/// Actuator::scale of a body with `template <class T> static ScaledValues<T> scale(const Values<T>&)`.
template <class Body>
Scaled scale_with(const Specification& spec) {
    Scaled out = collect(Body::scale(Values<double>(spec)), [](double x) { return x; });
    for (std::size_t k = 0; k < spec.type->states.size(); ++k) {
        out.scales.state[k] = scale_of(spec.type->states[k].scale, out.scales);
    }
    return out;
}

/// Actuator::scale_derivative of the same body. Throws std::invalid_argument for a frequency that is not given.
template <class Body>
Scaled scale_derivative_with(const Specification& spec, Key key) {
    if (is_frequency(key) && !has_frequency(spec)) {
        throw std::invalid_argument(std::string(key_info(key).name) + " is not given: nothing to differentiate by");
    }
    Values<numerics::ForwardDual> values(spec);
    values.at[static_cast<std::size_t>(key)].derivative = 1.0;
    return collect(Body::scale(values), [](const numerics::ForwardDual& x) { return x.derivative; });
}

}  // namespace percuss::model
