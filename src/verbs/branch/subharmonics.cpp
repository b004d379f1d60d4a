#include "verbs/branch/branch_setup.hpp"

#include "attractor/ensemble.hpp"

#include <cmath>

namespace percuss::verbs {
namespace {

constexpr int places = 32;  ///< over the range: subharmonic windows narrower than this are found by chance only

/// Where to look: the given frequency, else evenly over the range, frequencies in proportion.
std::vector<double> places_of(const BranchSetup& setup, double low, double high) {
    if (setup.along_frequency && model::has_frequency(setup.problem.design.actuator)) {
        const auto omega = design::given_omega(setup.problem.design.actuator,
                                               model::scale(setup.problem.design.actuator), *setup.integrators.own);
        if (omega && *omega >= low && *omega <= high) { return {*omega}; }
    }
    std::vector<double> at;
    for (int i = 0; i < places; ++i) {
        const double share = (i + 0.5) / places;
        at.push_back(setup.along_frequency ? low * std::pow(high / low, share) : low + share * (high - low));
    }
    return at;
}

}  // namespace

FoundMotions find_motions_along(const BranchSetup& setup, const BranchOptions& study, double low, double high,
                                const Observer& observer) {
    FoundMotions found;
    const std::vector<double> at = places_of(setup, low, high);
    for (std::size_t i = 0; i < at.size(); ++i) {
        if (study.starts < 1 || setup.cost.allowance() != flow::Status::ok) { break; }
        if (observer) {
            observer(static_cast<double>(i) / static_cast<double>(at.size()), "starts for subharmonic motions");
        }
        const flow::System exact = setup.family.at(at[i]);
        flow::System scout = exact;
        scout.integrator = setup.integrators.scout.get();
        attractor::EnsembleOptions options;
        options.starts = study.starts;
        options.seed = setup.problem.seed;
        options.jobs = setup.problem.jobs;
        // Motions of longer periods than asked for are recognised as such, not followed to the end as irregular ones.
        options.longest_period = std::max(12, study.period);
        const attractor::Box box = attractor::ensemble_box(exact, 0.0);
        const auto ensemble = attractor::find_attractors({exact, scout}, box, options);
        if (ensemble.status == attractor::Ensemble::Status::budget_spent) {
            found.complete = false;
            break;
        }
        for (const attractor::Attractor& motion : ensemble.attractors) {
            const bool wanted = motion.kind == attractor::Kind::periodic && motion.period <= study.period;
            if (wanted) { found.motions.push_back({orbit::motion_of(exact, motion.orbit), at[i]}); }
        }
    }
    return found;
}

}  // namespace percuss::verbs
