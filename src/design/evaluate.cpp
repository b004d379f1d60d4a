#include "design/evaluate.hpp"

#include "design/band_quantities.hpp"
#include "design/integrators.hpp"
#include "design/judge.hpp"
#include "design/measure.hpp"
#include "design/operating_point.hpp"
#include "orbit/polish.hpp"

#include <cmath>
#include <stdexcept>
#include <utility>

namespace percuss::design {

using model::Key;
using model::Specification;

struct Evaluator::Implementation {
    Problem problem;
    Integrators integrators;

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
        integrators = make_integrators(problem);
    }
};

namespace {

/// One design on its way through the stages of an evaluation.
class DesignEvaluation {
public:
    DesignEvaluation(const Problem& problem, const Integrators& integrators, const Specification& actuator,
                     const Demand& demand)
        : problem_(problem),
          integrators_(integrators),
          actuator_(actuator),
          demand_(demand),
          scaled_(model::scale(actuator)) {
        result_.gradient_keys = demand.gradients;
        cost_.cancelled = demand.cancelled;
        cost_.step_budget = demand.step_budget;
    }

    Evaluation evaluate() {
        const Keys keys = keys_at_fixed_frequency();
        const Operation operation = choose_operating_point(keys);
        if (!operation.found()) { return finish(); }
        const Reached reached = reach_motion(operation);
        const orbit::Orbit orbit = measure(operation, reached, keys);
        require_impact(operation, reached);
        judge(operation, orbit);
        measure_band(operation, orbit, keys);
        return finish();
    }

    /// At the given frequency, from a state of the caller's or from rest.
    Evaluation orbit(const std::optional<std::vector<double>>& start, int period) {
        if (!model::has_frequency(actuator_)) {
            throw std::invalid_argument("drive.frequency = edge: orbit needs a frequency as a number");
        }
        if (period < 1 || period > 64) { throw std::invalid_argument("period: allowed is 1 to 64 drive cycles"); }
        const Keys keys = keys_at_fixed_frequency();
        const Operation operation = choose_operating_point(keys);
        (void)measure(operation, reach(operation.system, start, period), keys);
        return finish();
    }

private:
    using Keys = std::vector<KeyDirection>;

    [[nodiscard]] flow::System with(const std::unique_ptr<flow::Integrator>& integrator) {
        return {integrator.get(), scaled_.parameters, &cost_};
    }

    /// How parameters and scales move with the keys of the demand; the frequency as the specification has it.
    [[nodiscard]] Keys keys_at_fixed_frequency() const {
        Keys keys;
        for (const Key key : demand_.gradients) { keys.push_back(model::scale_derivative(actuator_, key)); }
        return keys;
    }

    /// The same with the frequency moving as the operating point does: below an edge it follows the edge.
    static Keys keys_at(const Operation& operation, Keys keys) {
        const auto omega = static_cast<std::size_t>(operation.system.integrator->info().omega);
        for (std::size_t i = 0; i < keys.size() && operation.edge; ++i) {
            keys[i].parameters[omega] = operation.d_omega[i];
        }
        return keys;
    }

    // ---- where it is driven

    Operation choose_operating_point(const Keys& keys) {
        std::vector<flow::ParameterVector> directions;
        for (const KeyDirection& key : keys) { directions.push_back(key.parameters); }
        OperationOptions options;
        options.margin = problem_.margin;
        options.find_neighbours = must_be_alone();
        options.directions = directions;
        const flow::System system = with(integrators_.own);
        if (system.integrator->info().has_stop && !model::has_frequency(actuator_)) {
            // A search over gap or bias comes upon designs that rest against the stop: no reason to end it.
            if (const auto why = edge_ruled_out(system)) {
                result_.status = EvaluationStatus::failed;
                result_.reason = *why;
                return {};
            }
        }
        Operation operation = operate({actuator_, scaled_, system, with(integrators_.scout)}, options);
        result_.operating_point = operation.point;
        if (operation.edge) { result_.gradients.edge_omega = operation.edge->d_omega; }
        if (!operation.found()) {
            const bool no_impact = operation.status == OperationStatus::no_impact;
            result_.status = no_impact ? EvaluationStatus::no_impact : EvaluationStatus::failed;
            result_.reason = operation.reason;
        }
        return operation;
    }

    // ---- the motion there

    [[nodiscard]] Reached reach(const flow::System& system, const std::optional<std::vector<double>>& start,
                                int period) const {
        if (start) {
            return reach_by_newton(
                system, from_user(*start, "orbit.start", *actuator_.type, scaled_.scales, system.states()), period);
        }
        Reached reached = reach_from_rest(system, period);
        // A motion of n cycles has n strobe points, and which one the transient ends on is chance: the report always
        // gives the same.
        if (reached.orbit.ok()) { reached.orbit = orbit::start_with_longest_flight(system, reached.orbit); }
        return reached;
    }

    /// Quantities of the orbit reached, and the status that it earns; returns it, of its minimal period.
    orbit::Orbit measure(const Operation& operation, const Reached& reached, const Keys& keys_fixed) {
        const double omega_error = demand_.error_estimates && operation.edge ? error_of(operation) : 0.0;
        set_status(reached);
        if (!reached.orbit.ok()) { return {}; }
        const flow::System& system = operation.system;
        const flow::System tighter = with(integrators_.tighter).at_omega(system.omega());
        const Keys keys = keys_at(operation, keys_fixed);
        orbit::Orbit orbit = of_minimal_period(system, reached.orbit);
        const Measurement measurement =
            design::measure(system, &tighter, orbit, scaled_.scales, keys, demand_, omega_error, result_);
        if (!measurement.ok) {
            result_.status = EvaluationStatus::failed;
            result_.reason = "the converged orbit could not be integrated again";
            return orbit;
        }
        report(system, orbit, measurement);
        return orbit;
    }

    /// Uncertainty of the operating frequency: how far the edge moves at a tighter tolerance, and rounding.
    double error_of(const Operation& operation) {
        const boundary::Boundary& edge = *operation.edge;
        const boundary::Boundary again =
            boundary::solve_boundary(with(integrators_.tighter), boundary::FreeBranch::map_of(operation.system),
                                     edge.kind, edge.state, edge.omega, {});
        // Frequencies of both tolerances may agree to the last bit by chance: two roundings of omega are added.
        const double moved = again.ok() ? std::abs(again.omega - edge.omega) : absent;
        return (1.0 - problem_.margin) * (moved + 4e-16 * edge.omega);
    }

    void set_status(const Reached& reached) {
        switch (reached.kind) {
            case Reached::Kind::stable: result_.status = EvaluationStatus::ok; break;
            case Reached::Kind::unstable:
            case Reached::Kind::unsettled: result_.status = EvaluationStatus::unstable; break;
            default: result_.status = EvaluationStatus::failed; break;
        }
        result_.reason = reached.reason;
    }

    /// An orbit that repeats sooner than its map is one of the shorter period.
    static orbit::Orbit of_minimal_period(const flow::System& system, const orbit::Orbit& orbit) {
        const int period = orbit::minimal_period(system, orbit);
        if (period == orbit.map.period) { return orbit; }
        orbit::ReturnMap map = orbit.map;
        map.period = period;
        // Over the longer map the multipliers would be powers, and contacts and integrals counted several times.
        const orbit::Orbit shorter = orbit::find_orbit(system, map, orbit.state);
        return shorter.ok() ? shorter : orbit;
    }

    void report(const flow::System& system, const orbit::Orbit& orbit, const Measurement& measurement) {
        OrbitReport& report = result_.orbit;
        report.period = orbit.map.period;
        report.contacts = static_cast<int>(orbit.contacts.size());
        report.residual = measurement.portrait.residual;
        report.state = to_user(orbit::state_at_zero(system, orbit), scaled_.scales, system.states());
        const auto& observed = measurement.portrait.image.observed;
        if ((observables_for(demand_.quantities) & flow::observe_extrema) != 0U) {
            report.x_max = scaled_.scales.length * observed[orbit::x_max].value;
            report.x_min = scaled_.scales.length * observed[orbit::x_min].value;
        }
        // The matrix that Newton's method left has shorter series; the portrait's has full ones.
        orbit::Orbit exact = orbit;
        exact.monodromy = measurement.portrait.monodromy;
        const auto values = orbit::multipliers(exact);
        report.multipliers.assign(values.begin(), values.end());
    }

    void require_impact(const Operation& operation, const Reached& reached) {
        if (!operation.system.integrator->info().has_stop) { return; }
        if (operation.edge) {
            // Only if nothing else was reached either: an unstable impacting orbit is reported as such.
            if (reached.kind != Reached::Kind::unsettled || reached.orbit.ok() || !reached.settled_clear) { return; }
            result_.reason = "at the operating frequency, the margin below the edge, the motion settles clear of the "
                             "stop again: the impact band is narrower than the margin";
        } else {
            if (result_.status != EvaluationStatus::ok || !reached.orbit.contacts.empty()) { return; }
            result_.reason = "the motion reached from rest does not touch the stop at this frequency";
        }
        result_.status = EvaluationStatus::no_impact;
    }

    // ---- what stands beside it

    [[nodiscard]] bool must_be_alone() const { return problem_.single_stable != SingleStable::off; }
    /// Only an answer that stands is judged: a stable motion, a stop to strike, and limits that are not spent.
    [[nodiscard]] bool goes_on(const Operation& operation) const {
        return result_.status == EvaluationStatus::ok && operation.system.integrator->info().has_stop && !cut_short();
    }

    void judge(const Operation& operation, const orbit::Orbit& orbit) {
        if (!must_be_alone() || !goes_on(operation)) { return; }
        Judgement judgement = design::judge({operation, orbit, scaled_.scales, problem_});
        result_.uniqueness = std::move(judgement.uniqueness);
        if (!judgement.rejection.empty()) {
            result_.status = EvaluationStatus::not_unique;
            result_.reason = std::move(judgement.rejection);
        }
    }

    void measure_band(const Operation& operation, const orbit::Orbit& orbit, const Keys& keys) {
        if (!wants_band(demand_) || !goes_on(operation) || orbit.contacts.empty()) { return; }
        design::measure_band({operation, orbit, actuator_, scaled_.scales, problem_, keys_at(operation, keys), demand_},
                             result_);
    }

    // ---- the end

    [[nodiscard]] bool cut_short() const { return cost_.allowance() != flow::Status::ok; }

    /// A stage that is cut short returns early with whatever it has: nothing of that is an answer.
    Evaluation finish() {
        if (cut_short()) {
            result_.status = EvaluationStatus::failed;
            result_.reason = reason_of_limit(cost_);
        }
        result_.periods = cost_.periods();
        result_.steps = cost_.steps;
        return std::move(result_);
    }

    const Problem& problem_;
    const Integrators& integrators_;
    const Specification& actuator_;
    const Demand& demand_;
    model::Scaled scaled_;
    flow::Cost cost_;
    Evaluation result_;
};

}  // namespace

Evaluator::Evaluator(Problem problem) : implementation_(std::make_unique<Implementation>(std::move(problem))) {}
Evaluator::~Evaluator() = default;
Evaluator::Evaluator(Evaluator&&) noexcept = default;
Evaluator& Evaluator::operator=(Evaluator&&) noexcept = default;

const Problem& Evaluator::problem() const { return implementation_->problem; }

flow::System Evaluator::system(const Specification& actuator, flow::Cost* cost) const {
    return {implementation_->integrators.own.get(), model::scale(actuator).parameters, cost};
}

Evaluation Evaluator::evaluate(const Specification& actuator, const Demand& demand) const {
    model::validate(actuator);
    return DesignEvaluation(implementation_->problem, implementation_->integrators, actuator, demand).evaluate();
}

Evaluation Evaluator::evaluate(const Demand& demand) const {
    return evaluate(implementation_->problem.actuator, demand);
}

Evaluation Evaluator::orbit(const Specification& actuator, const std::optional<std::vector<double>>& start, int period,
                            const Demand& demand) const {
    model::validate(actuator);
    return DesignEvaluation(implementation_->problem, implementation_->integrators, actuator, demand)
        .orbit(start, period);
}

}  // namespace percuss::design
