#include "study/exclusion.hpp"

namespace percuss::study {

ExclusionValue evaluate(const Exclusion& exclusion, const flow::System& system, const model::Specification& design,
                        double omega, std::span<const double> d_omega, std::span<const model::Key> keys) {
    ExclusionValue out;
    const design::WindowAt window = design::window_at(system, *exclusion.intruder, design, keys);
    out.gradient.assign(keys.size(), 0.0);
    if (window.status == design::WindowAt::Status::vanished) {
        out.ok = true;
        out.value = -0.01;  // of the size that a window well out of the way gives
        return out;
    }
    if (window.status != design::WindowAt::Status::found) { return out; }
    out.ok = true;
    const double sign = exclusion.below ? 1.0 : -1.0;
    const double bound =
        exclusion.below ? (1.0 - exclusion.margin) * window.lower : (1.0 + exclusion.margin) * window.upper;
    out.value = sign * (omega / bound - 1.0);
    for (std::size_t k = 0; k < keys.size(); ++k) {
        const double d_bound = exclusion.below ? (1.0 - exclusion.margin) * window.d_lower[k]
                                               : (1.0 + exclusion.margin) * window.d_upper[k];
        out.gradient[k] = sign * (d_omega[k] / bound - omega * d_bound / (bound * bound));
    }
    return out;
}

}  // namespace percuss::study
