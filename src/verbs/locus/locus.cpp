#include "verbs/locus/locus.hpp"

#include "branch/trace.hpp"
#include "design/families.hpp"
#include "verbs/branch/branch_setup.hpp"
#include "verbs/limits.hpp"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <stdexcept>

namespace percuss::verbs {
namespace {

/// About `count` values between two ends at a step of 1, 2 or 5 times a power of ten.
std::vector<double> round_values(double from, double to, int count) {
    const double low = std::min(from, to);
    const double high = std::max(from, to);
    const double rough = (high - low) / std::max(1, count);
    const double power = std::pow(10.0, std::floor(std::log10(rough)));
    // rough/power lies in [1, 10); above 5 the next power is the step. The 1.0001 keeps a rough step of exactly 1, 2 or
    // 5 from being pushed to the next one by rounding.
    double step = 10.0 * power;
    for (double factor : {1.0, 2.0, 5.0}) {
        if (rough <= 1.0001 * factor * power) {
            step = factor * power;
            break;
        }
    }
    std::vector<double> values;
    // The ends are points of the curve anyway; a round value on one of them would come twice.
    const double inside = 1e-9 * (high - low);
    for (double k = std::ceil((low + inside) / step); k * step < high - inside; k += 1.0) {
        values.push_back(k * step);
    }
    return values;
}

/// Whether a known curve, turned back at a cusp, ends at this boundary, which then has no curve of its own.
bool ends_at(const branch::Locus& curve, const branch::BoundaryPoint& start, double value) {
    if (curve.points.empty()) { return false; }
    const branch::LocusPoint& last = curve.points.back();
    return std::abs(last.value - value) <= 1e-9 * std::max(1.0, std::abs(value)) &&
           std::abs(last.omega - start.point.omega) <= 1e-8 * start.point.omega;
}

}  // namespace

LocusResult run_locus(const StudyProblem& problem, const LocusOptions& study, const Observer& observer,
                      const numerics::CancelRequest& cancelled) {
    const auto begun = std::chrono::steady_clock::now();
    if (!study.along) {
        throw std::invalid_argument("locus.along is missing: give the key to vary besides the drive "
                                    "frequency, as in --along nondimensional.phi_pp");
    }
    if (!study.from || !study.to) { throw std::invalid_argument("locus.from and locus.to: give the range of the key"); }
    if (model::is_frequency(*study.along)) {
        throw std::invalid_argument("locus.along = " + std::string(model::key_info(*study.along).name) +
                                    ": the drive frequency is the other parameter already; give another key");
    }
    LocusResult result;
    result.kind = study.kind;
    result.along = *study.along;
    result.from = *study.from;
    result.to = *study.to;
    if (!(std::abs(result.to - result.from) > 0.0)) {
        throw std::invalid_argument("locus.from and locus.to are equal: the range is empty");
    }

    StudyProblem at_start = problem;
    model::Specification& spec = at_start.design.actuator;
    if (!spec.has(*study.along)) {
        throw std::invalid_argument("locus.along = " + std::string(model::key_info(*study.along).name) +
                                    " is not a key of this problem");
    }
    spec.set(*study.along, *study.to);
    model::validate(spec);
    spec.set(*study.along, *study.from);
    const BranchSetup setup(at_start, BranchOptions{}, cancelled);
    branch::TraceOptions trace_options;
    trace_options.from = setup.from;
    trace_options.to = setup.to;
    trace_options.size = setup.size;
    trace_options.cancelled = cancelled;
    if (observer) { observer(0.0, "branch at the start of the range"); }
    const auto departure = setup.departure();
    if (!departure) {
        result.ending = Ending::some_failed;
        result.reason = "no periodic motion of one drive cycle was reached at the start of the range";
        (void)cut_short(setup.cost, result);
        return result;
    }
    const branch::Branch main = branch::trace(setup.family, *departure, trace_options);
    result.solves += main.solves;

    const flow::ParameterFamily family = design::frequency_and_key_family(
        setup.system, setup.specification, *study.along, std::abs(result.to - result.from));
    branch::LocusOptions options;
    options.from = result.from;
    options.to = result.to;
    // Boundaries move with the key: the range of frequencies of the branch, widened five times, so that a curve is not
    // cut where the key moves the resonance.
    options.lowest_omega = std::min(setup.from, setup.to) * 0.2;
    options.highest_omega = std::max(setup.from, setup.to) * 5.0;
    options.size = setup.size;
    options.exact = round_values(result.from, result.to, study.steps);
    options.max_points = study.max_points;
    options.cancelled = cancelled;
    for (const branch::BoundaryPoint& found : main.boundaries) {
        if (found.kind != study.kind || setup.cost.allowance() != flow::Status::ok) { continue; }
        const auto on_known = [&](const branch::Locus& curve) { return ends_at(curve, found, result.from); };
        if (std::any_of(result.curves.begin(), result.curves.end(), on_known)) { continue; }
        if (observer) { observer(-1.0, "curve " + std::to_string(result.curves.size() + 1)); }
        result.curves.push_back(branch::follow_boundary(family, found, options));
        result.solves += result.curves.back().solves;
    }

    result.ending = Ending::verified;
    for (const branch::Locus& curve : result.curves) {
        if (curve.end == branch::End::budget) { result.ending = Ending::budget; }
    }
    if (cut_short(setup.cost, result)) {
        if (result.ending == Ending::interrupted) { result.reason = "stopped before every curve was complete"; }
    } else if (result.curves.empty()) {
        result.ending = Ending::infeasible;
        result.reason = "the main branch has no such boundary at the start of the range";
    }
    result.periods = setup.cost.periods();
    result.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - begun).count();
    return result;
}

}  // namespace percuss::verbs
