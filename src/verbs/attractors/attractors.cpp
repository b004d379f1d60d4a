#include "verbs/attractors/attractors.hpp"

#include "design/integrators.hpp"
#include "design/operating_point.hpp"
#include "verbs/limits.hpp"

#include <chrono>
#include <cmath>
#include <numbers>
#include <stdexcept>

namespace percuss::verbs {
namespace {

using attractor::Box;
using attractor::Ensemble;
using std::numbers::pi;

/// Followed starts take 10 to 20 steps of the Taylor integrator a drive cycle, some 20 times as many of ARKODE.
constexpr double steps_per_cycle = 200.0;

/// From the operating point to the report.
class AttractorSearch {
public:
    AttractorSearch(const StudyProblem& problem, const AttractorsOptions& study,
                    const numerics::CancelRequest& cancelled)
        : problem_(problem),
          study_(study),
          integrators_(design::make_integrators(problem.design)),
          scaled_(model::scale(problem.design.actuator)),
          cost_(limited_cost(cancelled, static_cast<double>(study.starts) * study.cycles, steps_per_cycle)),
          exact_{integrators_.own.get(), scaled_.parameters, &cost_},
          scout_{integrators_.scout.get(), scaled_.parameters, &cost_} {}

    AttractorsResult run(const Observer& observer) {
        if (!operate()) { return std::move(result_); }
        const Box box = choose_box();
        result_.lower = design::to_user(box.lower, scaled_.scales, exact_.states());
        result_.upper = design::to_user(box.upper, scaled_.scales, exact_.states());

        attractor::EnsembleOptions options;
        options.starts = study_.starts;
        options.seed = problem_.seed;
        options.jobs = problem_.jobs;
        options.max_cycles = study_.cycles;
        if (observer) {
            options.on_progress = [&](double share) { observer(share, "starts followed"); };
        }
        report(attractor::find_attractors({exact_, scout_}, box, options, tuned_));
        return std::move(result_);
    }

private:
    /// Sets the drive frequency; false when there is none to operate at.
    bool operate() {
        design::OperationOptions options;
        options.margin = problem_.design.margin;
        const design::Operation operation =
            design::operate({problem_.design.actuator, scaled_, exact_, scout_}, options);
        result_.operating_point = operation.point;
        if (!operation.found()) {
            const bool no_impact = operation.status == design::OperationStatus::no_impact;
            result_.ending = no_impact ? Ending::infeasible : Ending::some_failed;
            result_.reason = operation.reason;
            (void)cut_short(cost_, result_);
            return false;
        }
        exact_ = operation.system;
        scout_ = operation.scout;
        if (operation.edge) {
            design::Reached tuned = design::reach_motion(operation);
            if (tuned.kind == design::Reached::Kind::stable) { tuned_.push_back(std::move(tuned.orbit)); }
        }
        return true;
    }

    [[nodiscard]] Box choose_box() const {
        if (study_.lower.has_value() != study_.upper.has_value()) {
            throw std::invalid_argument(study_.lower ? "attractors.upper is missing: attractors.lower is given"
                                                     : "attractors.lower is missing: attractors.upper is given");
        }
        if (study_.lower) {
            const Box box{corner(*study_.lower, "attractors.lower"), corner(*study_.upper, "attractors.upper")};
            for (int k = 0; k < exact_.states(); ++k) {
                const auto i = static_cast<std::size_t>(k);
                if (!(box.lower[i] <= box.upper[i])) {
                    throw std::invalid_argument("attractors.lower: entry " + std::to_string(k + 1) +
                                                " is above that of attractors.upper");
                }
            }
            attractor::validate(box, exact_.states());
            return box;
        }
        // The box is made for the motion that the design is driven for; without one, for what the device reaches from
        // rest.
        const double amplitude = tuned_.empty() ? attractor::amplitude_to_expect(scout_)
                                                : attractor::measure(exact_, tuned_.front()).amplitude();
        return attractor::ensemble_box(exact_, amplitude);
    }

    /// A membrane without Maxwell branches moves in x and x' alone; stretches given are then of no use.
    [[nodiscard]] flow::State corner(std::vector<double> given, std::string_view key) const {
        given.resize(std::min(given.size(), static_cast<std::size_t>(exact_.states())));
        return design::from_user(given, key, *problem_.design.actuator.type, scaled_.scales, exact_.states());
    }

    void report(const Ensemble& ensemble) {
        for (const attractor::Attractor& motion : ensemble.attractors) { result_.attractors.push_back(report(motion)); }
        result_.starts = ensemble.starts;
        result_.unclassified = ensemble.unclassified;
        result_.failed = ensemble.failed;
        result_.missed_share_bound = ensemble.missed_share_bound;
        result_.cycles = ensemble.cycles + cost_.periods();
        if (ensemble.status == Ensemble::Status::cancelled) {
            result_.ending = Ending::interrupted;
            result_.reason = "stopped early: of " + std::to_string(study_.starts) + " starts " +
                             std::to_string(ensemble.starts) + " were looked at";
        } else if (ensemble.status == Ensemble::Status::budget_spent) {
            result_.ending = Ending::budget;
            result_.reason = "the budget of " + std::to_string(cost_.step_budget) + " integration steps is spent: of " +
                             std::to_string(study_.starts) + " starts " + std::to_string(ensemble.starts) +
                             " were looked at";
        } else if (ensemble.unclassified > 0) {
            result_.ending = Ending::not_certified;
            result_.reason = std::to_string(ensemble.unclassified) + " starts could not be classified";
        } else {
            result_.ending = Ending::verified;
        }
    }

    [[nodiscard]] AttractorReport report(const attractor::Attractor& motion) const {
        const model::Scales& scales = scaled_.scales;
        AttractorReport out;
        out.kind = motion.kind;
        out.period = motion.period;
        out.state = design::to_user(motion.state, scales, exact_.states());
        out.peak_force = scales.force * motion.peak_force;
        out.amplitude = scales.length * motion.amplitude();
        out.x_max = scales.length * motion.x_max;
        out.x_min = scales.length * motion.x_min;
        if (motion.kind == attractor::Kind::periodic) {
            out.contacts = motion.contacts;
            out.max_multiplier = std::abs(motion.multipliers[0]);
        }
        out.contacts_per_cycle = motion.contacts_per_cycle;
        out.multipliers.assign(motion.multipliers.begin(), motion.multipliers.end());
        const double per_time = exact_.omega() / (2.0 * pi);
        out.exponent = motion.exponent;
        out.exponent_per_time = {per_time * motion.exponent.value, per_time * motion.exponent.error};
        out.starts = motion.starts;
        out.share = motion.share;
        return out;
    }

    const StudyProblem& problem_;
    const AttractorsOptions& study_;
    design::Integrators integrators_;
    model::Scaled scaled_;
    flow::Cost cost_;
    flow::System exact_, scout_;
    std::vector<orbit::Orbit> tuned_;  ///< the orbit that the edge rule leads to, if it is stable
    AttractorsResult result_;
};

}  // namespace

AttractorsResult run_attractors(const StudyProblem& problem, const AttractorsOptions& study, const Observer& observer,
                                const numerics::CancelRequest& cancelled) {
    const auto start = std::chrono::steady_clock::now();
    AttractorsResult result = AttractorSearch(problem, study, cancelled).run(observer);
    result.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
    return result;
}

}  // namespace percuss::verbs
