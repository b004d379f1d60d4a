#include "verbs/branch/branch.hpp"

#include "boundary/critical.hpp"
#include "branch/switching.hpp"
#include "branch/trace.hpp"
#include "design/families.hpp"
#include "design/integrators.hpp"
#include "design/operating_point.hpp"
#include "orbit/polish.hpp"
#include "verbs/branch/branch_setup.hpp"
#include "verbs/evaluate/evaluate.hpp"
#include "verbs/limits.hpp"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <deque>
#include <numbers>
#include <stdexcept>

namespace percuss::verbs {
namespace {

using branch::BoundaryPoint;
using branch::Branch;

/// One study under way.
class Map {
public:
    Map(const StudyProblem& problem, const BranchOptions& study, const Observer& observer,
        const numerics::CancelRequest& cancelled)
        : study_(study),
          observer_(observer),
          setup_(problem, study, cancelled) {
        options_.from = setup_.from;
        options_.to = setup_.to;
        options_.size = setup_.size;
        options_.max_points = study.max_points;
        options_.cancelled = cancelled;
    }

    BranchResult run() {
        result_.along_frequency = setup_.along_frequency;
        result_.along = setup_.along;
        result_.from = setup_.user_from;
        result_.to = setup_.user_to;
        if (follow_main_branch() && study_.period > 1) {
            follow_flips();
            follow_attractors();
        }
        if (study_.gradients) { differentiate(); }
        for (const Branch& b : result_.branches) { result_.solves += b.solves; }
        result_.periods = setup_.cost.periods();
        conclude();
        return std::move(result_);
    }

private:
    [[nodiscard]] bool is_cut_short() const { return setup_.cost.allowance() != flow::Status::ok; }

    void report(double share, const std::string& what) const {
        if (observer_) { observer_(share, what); }
    }

    /// From one end of the range; in a design variable both ways from the problem's own value.
    bool follow_main_branch() {
        report(0.0, "main branch");
        const auto departure = setup_.departure();
        if (!departure) {
            result_.reason = "no periodic motion of one drive cycle was reached at the start of the range";
            return false;
        }
        const bool at_an_end = departure->parameter == setup_.from;
        result_.branches.push_back(at_an_end ? branch::trace(setup_.family, *departure, options_)
                                             : branch::trace_both_ways(setup_.family, *departure, options_));
        return true;
    }

    /// Branches of twice the period at every flip, their flips in turn, up to the period asked for.
    void follow_flips() {
        // Branches that are found are appended, so their own flips come up later in this loop.
        for (std::size_t i = 0; i < result_.branches.size() && !is_cut_short(); ++i) {
            // A copy: appending a branch moves the ones before it.
            const auto boundaries = result_.branches[i].boundaries;
            for (const BoundaryPoint& found : boundaries) {
                // A multiplier -1 of the half-cycle map means a motion of the same period without the mirror symmetry.
                const int period = result_.branches[i].period * (found.of_half_cycle ? 1 : 2);
                if (found.kind != boundary::Kind::flip || period > study_.period || is_cut_short()) { continue; }
                const auto departure = branch::departure_at_flip(setup_.family, found, options_.size);
                if (!departure) { continue; }
                report(-1.0, "branch of period " + std::to_string(period));
                Branch next = branch::trace(setup_.family, *departure, options_);
                // Beside its flip it is hard to tell from the branch it leaves: so not by its first point.
                if (next.points.size() < 2 || known(next.points[next.points.size() / 2])) { continue; }
                next.from_branch = static_cast<int>(i);
                result_.branches.push_back(std::move(next));
            }
        }
    }

    void follow_attractors() {
        // Where the main branch has its boundaries, and somewhat around; it strikes nowhere else.
        double low = std::min(setup_.from, setup_.to);
        double high = std::max(setup_.from, setup_.to);
        const auto& boundaries = result_.branches.front().boundaries;
        if (setup_.along_frequency && !boundaries.empty()) {
            const auto [first, last] =
                std::minmax_element(boundaries.begin(), boundaries.end(),
                                    [](const auto& a, const auto& b) { return a.point.parameter < b.point.parameter; });
            low = std::max(low, 0.9 * first->point.parameter);
            high = std::min(high, 1.1 * last->point.parameter);
        }
        const FoundMotions met = find_motions_along(setup_, study_, low, high, observer_);
        starts_complete_ = met.complete;
        for (const auto& found : met.motions) {
            if (is_cut_short()) { return; }
            const branch::Look seen = branch::look(setup_.family, found.motion, found.parameter);
            if (!seen.ok() || known(seen.point)) { continue; }
            report(-1.0, "branch of period " + std::to_string(found.motion.period));
            result_.branches.push_back(
                branch::trace_both_ways(setup_.family, {found.motion, found.parameter, 1.0, {}}, options_));
        }
    }

    [[nodiscard]] bool known(const branch::Point& point) const {
        return std::any_of(result_.branches.begin(), result_.branches.end(), [&](const Branch& b) {
            return b.period == point.motion.period && branch::passes_through(setup_.family, b, point, options_.size);
        });
    }

    void differentiate() {
        result_.gradient_keys = gradient_keys(setup_.problem.design);
        // What is varied is the unknown at a boundary: it has no derivative with respect to itself.
        std::erase_if(result_.gradient_keys, [&](model::Key key) {
            return key == setup_.along || (setup_.along_frequency && model::is_frequency(key));
        });
        for (const Branch& b : result_.branches) {
            auto& gradients = result_.gradients.emplace_back();
            for (const BoundaryPoint& found : b.boundaries) {
                model::Specification spec = setup_.specification;
                if (!setup_.along_frequency) { spec.set(setup_.along, found.point.parameter); }
                std::vector<flow::ParameterVector> directions;
                for (const model::Key key : result_.gradient_keys) {
                    directions.push_back(model::scale_derivative(spec, key).parameters);
                    // The unknown is the nondimensional omega; the part of a key in it through the unit of time is
                    // added where it is told in rad/s.
                    if (setup_.along_frequency) { directions.back()[setup_.omega_index] = 0.0; }
                }
                const auto exact =
                    boundary::solve_critical(setup_.family, found.kind, found.point.motion, found.point.parameter,
                                             found.contact, found.angle, options_.size, directions);
                std::vector<double> d = exact.d_parameter;
                d.resize(directions.size(), design::absent);
                gradients.push_back({std::move(d)});
            }
        }
    }

    void conclude() {
        if (result_.branches.empty()) {
            result_.ending = Ending::some_failed;
            (void)cut_short(setup_.cost, result_);
            return;
        }
        const auto ended = [&](branch::End end) {
            return std::any_of(result_.branches.begin(), result_.branches.end(),
                               [&](const Branch& b) { return b.end == end || b.begin == end; });
        };
        if (is_cut_short()) {
            cut_short(setup_.cost, result_);
            if (result_.ending == Ending::interrupted) { result_.reason = "stopped before the map was complete"; }
        } else if (ended(branch::End::lost)) {
            result_.ending = Ending::some_failed;
            result_.reason = "a branch was lost before it left the range";
        } else if (!starts_complete_) {
            result_.ending = Ending::budget;
            result_.reason = "the starts for subharmonic motions spent their budget of integration steps";
        } else if (ended(branch::End::budget)) {
            result_.ending = Ending::budget;
            result_.reason = "a branch has as many points as branch.max_points allows";
        } else {
            result_.ending = Ending::verified;
        }
    }

    const BranchOptions& study_;
    const Observer& observer_;
    BranchSetup setup_;
    branch::TraceOptions options_;
    bool starts_complete_ = true;
    BranchResult result_;
};

}  // namespace

BranchResult run_branch(const StudyProblem& problem, const BranchOptions& study, const Observer& observer,
                        const numerics::CancelRequest& cancelled) {
    const auto start = std::chrono::steady_clock::now();
    BranchResult result = Map(problem, study, observer, cancelled).run();
    result.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
    return result;
}

model::Scales scales_at(const design::Problem& problem, const BranchResult& result, double parameter) {
    model::Specification spec = problem.actuator;
    if (!result.along_frequency) { spec.set(result.along, parameter); }
    return model::scale(spec).scales;
}

}  // namespace percuss::verbs
