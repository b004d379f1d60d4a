#pragma once
/// \file
/// Tier 3: a counterexample made a constraint. The operating frequency stays outside the window in which the intruding
/// motion exists, by the margin, on one side of it.

#include "design/window.hpp"
#include "optimise/nlp.hpp"

#include <memory>
#include <span>

namespace percuss::study {

struct Exclusion {
    std::shared_ptr<const design::Intruder> intruder;
    bool below = true;  ///< operate below the window's lower end, else above its upper end
    double margin = 0.0;
};

/// c <= 0 with c = omega/((1 - margin) w_lower) - 1 below the window, 1 - omega/((1 + margin) w_upper) above it, and
/// the derivatives with respect to the keys. Where the window has vanished c is a constant on the good side.
struct ExclusionValue {
    bool ok = false;
    double value = 0.0;
    std::vector<double> gradient;
};
ExclusionValue evaluate(const Exclusion& exclusion, const flow::System& system, const model::Specification& design,
                        double omega, std::span<const double> d_omega, std::span<const model::Key> keys);

}  // namespace percuss::study
