#include "design/evaluate.hpp"

#include "design/band.hpp"
#include "design/integrators.hpp"
#include "design/measure.hpp"
#include "design/operating_point.hpp"
#include "design/sampled_check.hpp"
#include "design/uniqueness.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <random>
#include <stdexcept>

namespace percuss::design {
namespace {

using model::Key;
using model::Specification;
using std::numbers::pi;

std::size_t index(int i) { return static_cast<std::size_t>(i); }

}  // namespace

struct Evaluator::Implementation {
    Problem problem;
    Integrators scene;

    explicit Implementation(Problem p) : problem(std::move(p)) {
        model::validate(problem.actuator);
        const auto check = [&](Quantity q) {
            const std::string_view why = unavailable(q, *problem.actuator.type);
            if (!why.empty()) {
                throw std::invalid_argument(std::string(quantity_info(q).name) + " " + std::string(why));
            }
        };
        for (const Objective& o : problem.objectives) { check(o.quantity); }
        for (const Limit& l : problem.limits) { check(l.quantity); }
        if (!(problem.margin >= 0.0 && problem.margin < 0.5)) {
            throw std::invalid_argument("drive.margin: allowed is 0 % to 50 %");
        }
        scene = make_integrators(problem);
    }
};

namespace {

/// One evaluation under way.
class Run {
public:
    Run(const Problem& problem, const Integrators& scene, const Specification& actuator, const Demand& demand)
        : problem_(problem),
          actuator_(actuator),
          demand_(demand),
          scaled_(model::scale(actuator)) {
        system_ = {scene.own.get(), scaled_.parameters, &cost_};
        tighter_ = {scene.tighter.get(), scaled_.parameters, &cost_};
        scout_ = {scene.scout.get(), scaled_.parameters, &cost_};
        result_.gradient_keys = demand.gradients;
        for (Key key : demand.gradients) { keys_.push_back(model::scale_derivative(actuator, key)); }
    }

    Evaluation evaluate() {
        const auto given = given_omega(actuator_, scaled_, *system_.integrator);
        if (given) {
            operate_at(*given);
        } else {
            operate_below_edge();
        }
        return finish();
    }

    Evaluation orbit(const std::optional<std::vector<double>>& start, int period) {
        const auto given = given_omega(actuator_, scaled_, *system_.integrator);
        if (!given) { throw std::invalid_argument("drive.frequency = edge: orbit needs a frequency as a number"); }
        if (period < 1 || period > 64) { throw std::invalid_argument("period: allowed is 1 to 64 drive cycles"); }
        set_given(*given);
        Reached reached;
        if (start) {
            reached =
                from_start(from_user(*start, "orbit.start", *actuator_.type, scaled_.scales, system_.states()), period);
        } else {
            reached = from_rest(period);
            if (reached.orbit.ok()) { reached.orbit = orbit::start_with_longest_flight(system_, reached.orbit); }
        }
        accept(reached);
        return finish();
    }

private:
    void set_given(double omega) {
        system_ = system_.at_omega(omega);
        tighter_ = tighter_.at_omega(omega);
        result_.operating_point.omega = omega;
        result_.operating_point.edge_kind = EdgeKind::given;
        result_.operating_point.drive_frequency = drive_frequency(omega, scaled_.scales);
    }

    Reached from_start(const flow::State& y, int period) const {
        Reached reached;
        reached.orbit = orbit::polish_orbit(system_, y, period);
        if (!reached.orbit.ok()) {
            reached.kind = Reached::Kind::unsettled;
            reached.reason = "Newton's method from orbit.start did not converge";
            return reached;
        }
        reached.kind = orbit::max_multiplier(reached.orbit) < 1.0 ? Reached::Kind::stable : Reached::Kind::unstable;
        if (reached.kind == Reached::Kind::unstable) { reached.reason = "the orbit is unstable"; }
        return reached;
    }

    /// The motion reached from rest; when that is not of the period asked for, the first of a fixed sequence of random
    /// starts that leads to one.
    Reached from_rest(int period) const {
        const flow::State rest = system_.integrator->rest_state(system_.parameters);
        Reached reached = reach_orbit(system_, rest, period, false);
        const auto fits = [&](const Reached& r) {
            return r.kind == Reached::Kind::stable && orbit::minimal_period(system_, r.orbit) == period;
        };
        if (period == 1 || fits(reached)) { return reached; }
        std::mt19937_64 generator(1);
        const double centre = system_.integrator->centre(system_.parameters);
        const double gap = std::abs(system_.stop_position() - centre);
        const double size = std::max(gap, 0.05);
        for (int attempt = 0; attempt < 200; ++attempt) {
            const auto uniform = [&](double low, double high) {
                return low + (high - low) * static_cast<double>(generator() >> 11U) * 0x1.0p-53;
            };
            flow::State y = rest;
            y[0] = centre + uniform(-2.0 * size, gap);
            y[1] = uniform(-2.0, 2.0) * system_.omega() * size;
            for (int k = 2; k < system_.states(); ++k) { y[index(k)] *= uniform(0.97, 1.03); }
            const auto settled = orbit::settle(system_, y, 150);
            if (!settled) { continue; }
            Reached candidate = from_start(*settled, period);
            if (fits(candidate)) { return candidate; }
        }
        reached = Reached{};  // what was reached instead is not an answer
        reached.kind = Reached::Kind::unsettled;
        reached.reason = "no stable orbit of period " + std::to_string(period) + " was found from 200 starts";
        return reached;
    }

    /// A frequency the user gave: the motion reached from rest.
    void operate_at(double omega) {
        set_given(omega);
        const Reached reached = from_rest(1);
        accept(reached);
        const bool has_stop = model::has_stop(actuator_.law);
        if (has_stop && result_.status == EvaluationStatus::ok && reached.orbit.contacts.empty()) {
            result_.status = EvaluationStatus::no_impact;
            result_.reason = "the motion reached from rest does not touch the stop at this frequency";
        }
        if (problem_.single_stable != SingleStable::off && has_stop && result_.status == EvaluationStatus::ok) {
            judge(free_orbits_from_above(system_, scout_, omega), nullptr);
        }
        if (has_stop && wants_band() && result_.status == EvaluationStatus::ok) { measure_band_around(omega); }
    }

    void operate_below_edge() {
        if (!model::has_stop(actuator_.law)) {
            throw std::invalid_argument("drive.frequency = edge needs a stop: stop.law is none");
        }
        OperationOptions options;
        options.margin = problem_.margin;
        options.scout = &scout_;
        options.check_neighbours = problem_.single_stable != SingleStable::off;
        std::vector<flow::ParameterVector> directions;
        for (const auto& key : keys_) { directions.push_back(key.parameters); }
        options.directions = directions;
        const EdgeOperation operation = operate_at_edge(system_, options);
        const boundary::Edge& edge = operation.edge;
        result_.operating_point.margin = problem_.margin;
        if (edge.status != boundary::EdgeStatus::found) {
            result_.status =
                edge.status == boundary::EdgeStatus::no_impact ? EvaluationStatus::no_impact : EvaluationStatus::failed;
            result_.reason = edge.reason;
            return;
        }
        OperatingPoint& point = result_.operating_point;
        point.edge_kind = to_edge_kind(edge.boundary.kind);
        point.edge_omega = edge.boundary.omega;
        point.omega = operation.omega;
        point.drive_frequency = drive_frequency(operation.omega, scaled_.scales);
        result_.gradients.edge_omega = edge.boundary.d_omega;
        const std::size_t omega = index(system_.integrator->info().omega);
        for (std::size_t i = 0; i < keys_.size(); ++i) {
            keys_[i].parameters[omega] = (1.0 - problem_.margin) * edge.boundary.d_omega[i];
        }
        if (operation.fold) { set_fold_offset(*operation.fold); }
        if (demand_.error_estimates) { estimate_edge_error(edge.boundary); }
        system_ = system_.at_omega(operation.omega);
        tighter_ = tighter_.at_omega(operation.omega);
        accept(operation.reached);
        const Reached& reached = operation.reached;
        if (reached.kind == Reached::Kind::unsettled && !reached.orbit.ok() && reached.settled_clear) {
            result_.status = EvaluationStatus::no_impact;
            result_.reason = "at the operating frequency, the margin below the edge, the motion settles clear of the "
                             "stop again: the "
                             "impact band is narrower than the margin";
        }
        if (options.check_neighbours && result_.status == EvaluationStatus::ok) {
            judge(operation.free_orbits, operation.fold ? &*operation.fold : nullptr);
        }
        measure_band(edge.boundary.omega);
    }

    void set_fold_offset(const boundary::GrazingFold& fold) {
        using Status = boundary::GrazingFold::Status;
        if (fold.status == Status::found) { result_.operating_point.fold_offset = fold.offset; }
        if (fold.status == Status::at_once) { result_.operating_point.fold_offset = 0.0; }
    }

    void estimate_edge_error(const boundary::Boundary& edge) {
        const boundary::Boundary again = boundary::solve_boundary(tighter_, boundary::FreeBranch::half_cycle(),
                                                                  edge.kind, edge.state, edge.omega, {});
        const double moved = again.ok() ? std::abs(again.omega - edge.omega) : absent;
        omega_error_ = (1.0 - problem_.margin) * (moved + 4e-16 * edge.omega);
    }

    /// An orbit that repeats sooner than its map is one of the shorter period.
    void reduce_period(orbit::Orbit& orbit) const {
        const int period = orbit::minimal_period(system_, orbit);
        if (period == orbit.map.period) { return; }
        orbit::ReturnMap map = orbit.map;
        map.period = period;
        const orbit::Orbit shorter = orbit::find_orbit(system_, map, orbit.state);
        if (shorter.ok()) { orbit = shorter; }
    }

    void accept(Reached reached) {
        switch (reached.kind) {
            case Reached::Kind::stable: result_.status = EvaluationStatus::ok; break;
            case Reached::Kind::unstable:
            case Reached::Kind::unsettled: result_.status = EvaluationStatus::unstable; break;
            default: result_.status = EvaluationStatus::failed; break;
        }
        result_.reason = reached.reason;
        if (!reached.orbit.ok()) { return; }
        reduce_period(reached.orbit);
        orbit_ = reached.orbit;
        const model::Scales& scales = scaled_.scales;
        const Measurement measurement =
            measure(system_, &tighter_, reached.orbit, scales, keys_, demand_, omega_error_, result_);
        if (!measurement.ok) {
            result_.status = EvaluationStatus::failed;
            result_.reason = "the converged orbit could not be integrated again";
            return;
        }
        OrbitReport& report = result_.orbit;
        report.period = reached.orbit.map.period;
        report.contacts = static_cast<int>(reached.orbit.contacts.size());
        report.residual = measurement.portrait.residual;
        report.state = to_user(orbit::state_at_zero(system_, reached.orbit), scales, system_.states());
        const auto& observed = measurement.portrait.image.observed;
        if ((observables_for(demand_.quantities) & flow::observe_extrema) != 0U) {
            report.x_max = scales.length * observed[orbit::x_max].value;
            report.x_min = scales.length * observed[orbit::x_min].value;
        }
        orbit::Orbit exact = reached.orbit;
        exact.monodromy = measurement.portrait.monodromy;
        const auto values = orbit::multipliers(exact);
        report.multipliers.assign(values.begin(), values.end());
    }

    void judge(const boundary::FreeOrbitsAt& free, const boundary::GrazingFold* fold) {
        TierOne tier_one = check_tier_one(
            {system_, scaled_.scales, orbit_, free, fold, result_.operating_point.fold_offset, problem_.margin});
        result_.uniqueness = std::move(tier_one.uniqueness);
        if (!tier_one.rejection.empty()) {
            result_.status = EvaluationStatus::not_unique;
            result_.reason = std::move(tier_one.rejection);
        }
        if (problem_.single_stable > SingleStable::orbit && result_.uniqueness.verdict != Verdict::not_unique) {
            judge_by_starts();
        }
    }

    void judge_by_starts() {
        const orbit::Image image =
            orbit::apply(system_, orbit_.map, orbit_.state, orbit::Differentiate::nothing, {}, flow::observe_extrema);
        const double amplitude = 0.5 * (image.observed[orbit::x_max].value - image.observed[orbit::x_min].value);
        const flow::System scout = scout_.at_omega(system_.omega());
        TierTwo tier_two = check_tier_two({system_, scout, scaled_.scales, orbit_, amplitude, problem_.sampling});
        tier_two.uniqueness.checked += "; " + result_.uniqueness.checked;
        result_.uniqueness = std::move(tier_two.uniqueness);
        if (!tier_two.rejection.empty()) {
            result_.status = EvaluationStatus::not_unique;
            result_.reason = std::move(tier_two.rejection);
        }
    }

    /// With a given frequency the edge is not known yet.
    void measure_band_around(double omega) {
        boundary::FreeBranch branch(scout_);
        std::vector<flow::ParameterVector> directions;
        for (const KeyDirection& key : keys_) { directions.push_back(key.parameters); }
        const boundary::Edge edge = boundary::find_edge(branch, system_.at_omega(omega), {}, directions);
        const bool found = edge.status == boundary::EdgeStatus::found;
        result_.gradients.edge_omega = edge.boundary.d_omega;
        measure_band(found ? edge.boundary.omega : absent);
        result_.gradients.edge_omega.clear();
    }

    [[nodiscard]] bool wants_band() const {
        return std::any_of(demand_.quantities.begin(), demand_.quantities.end(),
                           [](Quantity q) { return q == Quantity::band_lower || q == Quantity::band_upper; });
    }

    void measure_band(double edge_omega) {
        if (result_.status != EvaluationStatus::ok || orbit_.contacts.empty() || !wants_band()) { return; }
        std::vector<flow::ParameterVector> directions;
        for (const KeyDirection& key : keys_) {
            directions.push_back(key.parameters);
            directions.back()[index(system_.integrator->info().omega)] = 0.0;
        }
        const flow::System scout = scout_.at_omega(system_.omega());
        const bool sample = problem_.single_stable > SingleStable::orbit;
        const Band band = single_stable_band({system_, scout, orbit_, edge_omega, result_.gradients.edge_omega,
                                              directions, sample ? &problem_.sampling : nullptr},
                                             actuator_);
        report_end(Quantity::band_lower, band.lower);
        report_end(Quantity::band_upper, band.upper);
        result_.band_reasons = {band.lower.reason, band.upper.reason};
    }

    void report_end(Quantity q, const BandEnd& end) {
        if (!end.found) { return; }
        const auto at = static_cast<std::size_t>(q);
        const double per_omega = 1.0 / (2.0 * pi * scaled_.scales.time);
        result_.quantities[at] = end.omega * per_omega;
        if (demand_.error_estimates) { result_.error_estimates[at] = end.error * per_omega; }
        auto& gradient = result_.gradients.quantity[at];
        gradient.clear();
        for (std::size_t i = 0; i < keys_.size(); ++i) {
            const double d = i < end.d_omega.size() ? end.d_omega[i] : absent;
            gradient.push_back(per_omega * (d - end.omega * keys_[i].scales.time / scaled_.scales.time));
        }
    }

    Evaluation finish() {
        result_.periods = cost_.periods();
        return std::move(result_);
    }

    const Problem& problem_;
    const Specification& actuator_;
    const Demand& demand_;
    model::Scaled scaled_;
    flow::Cost cost_;
    flow::System system_, tighter_, scout_;
    std::vector<KeyDirection> keys_;
    orbit::Orbit orbit_;  ///< the accepted one
    double omega_error_ = 0.0;
    Evaluation result_;
};

}  // namespace

Evaluator::Evaluator(Problem problem) : implementation_(std::make_unique<Implementation>(std::move(problem))) {}
Evaluator::~Evaluator() = default;
Evaluator::Evaluator(Evaluator&&) noexcept = default;
Evaluator& Evaluator::operator=(Evaluator&&) noexcept = default;

const Problem& Evaluator::problem() const { return implementation_->problem; }

flow::System Evaluator::system(const Specification& actuator) const {
    return {implementation_->scene.own.get(), model::scale(actuator).parameters, nullptr};
}

Evaluation Evaluator::evaluate(const Specification& actuator, const Demand& demand) const {
    model::validate(actuator);
    return Run(implementation_->problem, implementation_->scene, actuator, demand).evaluate();
}

Evaluation Evaluator::evaluate(const Demand& demand) const {
    return evaluate(implementation_->problem.actuator, demand);
}

Evaluation Evaluator::orbit(const Specification& actuator, const std::optional<std::vector<double>>& start, int period,
                            const Demand& demand) const {
    model::validate(actuator);
    return Run(implementation_->problem, implementation_->scene, actuator, demand).orbit(start, period);
}

}  // namespace percuss::design
