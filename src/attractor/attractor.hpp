#pragma once
/// \file
/// An attractor that starts were led to, measured. Nondimensional.

#include "attractor/exponent.hpp"
#include "attractor/known.hpp"
#include "attractor/shares.hpp"

#include <string_view>

namespace percuss::attractor {

enum class Kind : std::uint8_t {
    undecided,       ///< aperiodic, the exponent is zero within an error that is too wide to call it quasi-periodic
    periodic,        ///< all multipliers below 1 in modulus
    chaotic,         ///< the largest exponent is positive beyond its error
    quasi_periodic,  ///< zero within its error, and the tangent vector stays bounded
};
std::string_view to_string(Kind kind);

struct Attractor {
    Kind kind = Kind::undecided;
    int period = 0;       ///< drive cycles, 0 for aperiodic motions
    orbit::Orbit orbit;   ///< periodic motions: of the exact integrator, strobed where the longest flight follows
    flow::State state{};  ///< at theta = 0: the strobe point that is followed by the longest flight
    double peak_force = 0.0;
    double x_max = 0.0;
    double x_min = 0.0;
    int contacts = 0;  ///< per period, 0 for aperiodic motions
    double contacts_per_cycle = 0.0;
    numerics::SmallComplexVector multipliers;  ///< largest first; empty for aperiodic motions
    Exponent exponent;  ///< periodic motions: the logarithm of the largest multiplier per cycle, without error
    long starts = 0;    ///< led here; none when Newton's method came upon it from a motion that went elsewhere
    Share share;
    [[nodiscard]] double amplitude() const { return 0.5 * (x_max - x_min); }
};

/// A stable periodic orbit measured.
Attractor measure(const flow::System& exact, const orbit::Orbit& orbit);

/// An aperiodic motion measured, from a run that ended well; nothing when its exponent is negative beyond its error:
/// the motion is still settling.
std::optional<Attractor> measure(const Wander& wander);

}  // namespace percuss::attractor
