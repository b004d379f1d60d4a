#include "verbs/optimise/exclusion.hpp"

#include <algorithm>

namespace percuss::verbs {
namespace {

/// A window narrower than this, relative, counts as vanished; its width goes to zero like a square root, too steep for
/// an optimiser.
constexpr double vanishing_width = 1e-4;

/// The window known at the design nearest to this one: a short way to carry it is a safe one.
const design::Intruder& nearest(const Exclusion& exclusion, const model::Specification& design) {
    const design::Intruder* best = exclusion.intruder.get();
    for (const design::Intruder& known : *exclusion.known) {
        if (design::distance(known.design, design) < design::distance(best->design, design)) { best = &known; }
    }
    return *best;
}

}  // namespace

ExclusionValue evaluate(const Exclusion& exclusion, const flow::System& system, const model::Specification& design,
                        double omega, std::span<const double> d_omega, std::span<const model::Key> keys) {
    ExclusionValue out;
    const design::WindowAt window = design::window_at(system, nearest(exclusion, design), design, keys);
    out.gradient.assign(keys.size(), 0.0);
    // A window that is not found has vanished: satisfied, by the width at which it would count as vanished.
    out.value = -vanishing_width;
    if (window.status != design::WindowAt::Status::found) { return out; }
    exclusion.known->push_back(window.carried);
    const double sign = exclusion.below ? 1.0 : -1.0;
    const double bound =
        exclusion.below ? (1.0 - exclusion.margin) * window.lower : (1.0 + exclusion.margin) * window.upper;
    const double side = sign * (omega / bound - 1.0);
    const double width = (window.upper - window.lower) / window.upper - vanishing_width;
    // Satisfied on the right side of the window or where it has no width: the smaller value of the two, with its
    // gradient.
    out.value = std::min(side, width);
    for (std::size_t k = 0; k < keys.size(); ++k) {
        const double d_bound = exclusion.below ? (1.0 - exclusion.margin) * window.d_lower[k]
                                               : (1.0 + exclusion.margin) * window.d_upper[k];
        out.gradient[k] = side <= width
                            ? sign * (d_omega[k] / bound - omega * d_bound / (bound * bound))
                            : (window.lower * window.d_upper[k] / window.upper - window.d_lower[k]) / window.upper;
    }
    return out;
}

}  // namespace percuss::verbs
