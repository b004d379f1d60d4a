#include "design/sampled_check.hpp"

#include "attractor/ensemble.hpp"
#include "design/integrators.hpp"
#include "model/number_text.hpp"

namespace percuss::design {
namespace {

/// In the units of the problem.
Attractor report(const SampledCase& c, const attractor::Attractor& motion) {
    Attractor out;
    out.period = motion.period;
    out.kind = attractor::to_string(motion.kind);
    out.state = to_user(motion.state, c.scales, c.system.states());
    out.peak_force = c.scales.force * motion.peak_force;
    out.amplitude = c.scales.length * motion.amplitude();
    out.share = motion.share.value;
    out.max_multiplier = motion.multipliers.size() > 0 ? std::abs(motion.multipliers[0]) : absent;
    return out;
}

std::string name_of(const attractor::Attractor& motion) {
    const std::string kind(attractor::to_string(motion.kind));
    return motion.period > 0 ? "motion of period " + std::to_string(motion.period) : kind + " motion";
}

/// Every motion that the starts lead to, the tuned one left out.
std::vector<Attractor> list_others(const SampledCase& c, const attractor::Systems& systems, const attractor::Box& box,
                                   const attractor::EnsembleOptions& options) {
    const auto ensemble = attractor::find_attractors(systems, box, options, {&c.orbit, 1});
    std::vector<Attractor> others;
    for (std::size_t i = 1; i < ensemble.attractors.size(); ++i) {
        others.push_back(report(c, ensemble.attractors[i]));
    }
    return others;
}

}  // namespace

TierTwo check_tier_two(const SampledCase& c) {
    using Status = attractor::Refutation::Status;
    const attractor::Systems systems{c.system, c.scout};
    const attractor::Box box = attractor::ensemble_box(c.system, c.amplitude);
    attractor::EnsembleOptions options;
    options.starts = c.sampling.starts;
    options.seed = c.sampling.seed;
    options.jobs = c.sampling.jobs;
    options.max_cycles = c.sampling.cycles;
    const attractor::Refutation answer = attractor::refute(systems, c.orbit, box, options);

    TierTwo result;
    Uniqueness& u = result.uniqueness;
    u.tier = 2;
    u.starts = answer.starts;
    u.missed_share_bound = answer.missed_share_bound;
    const std::string starts = std::to_string(answer.starts) + " starts";
    switch (answer.status) {
        case Status::not_refuted:
            u.verdict = Verdict::unique;
            u.checked = "tier 2: not refuted by " + starts +
                        " over the box; at 95 % confidence other motions attract " + "less than " +
                        model::number_text(100.0 * u.missed_share_bound, 3) + " % of it";
            break;
        case Status::refuted: {
            // Seen on random designs: chaotic transients longer than the 1000 cycles of a start that all end on the
            // tuned orbit within 12000 (designs 1836 and 1884 of results/stress). Such a motion does not refute.
            if (answer.other->kind == attractor::Kind::undecided) {
                u.checked = "tier 2: among " + starts + " one led to an aperiodic motion that may be a long transient";
                break;
            }
            u.verdict = Verdict::not_unique;
            u.attractors = list_others(c, systems, box, options);
            // Newton's method can meet a stable orbit that none of the starts leads to.
            if (u.attractors.empty()) { u.attractors.push_back(report(c, *answer.other)); }
            result.rejection = "a stable " + name_of(*answer.other) + " (peak force " +
                               model::number_text(c.scales.force * answer.other->peak_force, 6) +
                               ") coexists at the operating frequency";
            u.checked = "tier 2: " + result.rejection + ", found by " + starts;
            break;
        }
        case Status::undecided:
            u.checked = "tier 2: no counterexample among " + starts + ", but " + std::to_string(answer.unclassified) +
                        " of them could not be classified";
            break;
        case Status::budget_spent:
            u.checked = "tier 2: the starts spent their budget of integration steps before it was complete";
            break;
        case Status::cancelled:
        case Status::not_run: u.checked = "tier 2: cancelled before it was complete"; break;
    }
    return result;
}

}  // namespace percuss::design
