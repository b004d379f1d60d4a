#pragma once
/// \file
/// Tier 3: a counterexample made a constraint. The operating frequency stays outside the window in which the intruding
/// motion exists, by the margin, on one side of it.

#include "design/window.hpp"
#include "optimise/nlp.hpp"

#include <memory>
#include <span>
#include <utility>
#include <vector>

namespace percuss::verbs {

struct Exclusion {
    Exclusion(std::shared_ptr<const design::Intruder> met, bool operate_below, double distance_kept)
        : intruder(std::move(met)),
          below(operate_below),
          margin(distance_kept) {}

    std::shared_ptr<const design::Intruder> intruder;
    bool below = true;  ///< operate below the window's lower end, else above its upper end
    double margin = 0.0;
    /// Where the window has been followed to so far: the nearest design is where the next one is reached from.
    std::shared_ptr<std::vector<design::Intruder>> known = std::make_shared<std::vector<design::Intruder>>();
};

/// c <= 0 with c = omega/((1 - margin) w_lower) - 1 below the window or 1 - omega/((1 + margin) w_upper) above it, or
/// the relative width of the window less 1e-4 where that is smaller; with the derivatives with respect to the keys.
/// Where the window has vanished, or could not be followed to, c is the limit -1e-4: the starts that look at the
/// optimum in the end decide.
struct ExclusionValue {
    double value = 0.0;
    std::vector<double> gradient;
};
ExclusionValue evaluate(const Exclusion& exclusion, const flow::System& system, const model::Specification& design,
                        double omega, std::span<const double> d_omega, std::span<const model::Key> keys);

}  // namespace percuss::verbs
