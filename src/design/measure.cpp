#include "design/measure.hpp"

#include <algorithm>
#include <cmath>
#include <complex>
#include <numbers>
#include <optional>
#include <utility>

namespace percuss::design {
namespace {

using orbit::ObservableIndex;
using orbit::Portrait;
using std::numbers::pi;

std::size_t index(int i) { return static_cast<std::size_t>(i); }

/// A quantity that is one observable times one scale (a product of powers of the scales).
struct Proportional {
    ObservableIndex observable;
    model::ScalePowers scale;
    std::uint32_t mask;
    bool per_time = false;  ///< the observable is an integral over time, the quantity its mean over the period
};

/// The rule of a quantity that is one observable times a scale; nothing for the others.
std::optional<Proportional> proportional(Quantity quantity) {
    constexpr model::ScalePowers force = {0, 0, 1, {}};
    static constexpr std::array<std::pair<Quantity, Proportional>, 6> table = {{
        {Quantity::peak_force, {orbit::peak_force, force, flow::observe_force}},
        {Quantity::impact_velocity, {orbit::impact_velocity, {1, -1, 0, {}}, flow::observe_force}},
        {Quantity::contact_time, {orbit::contact_time, {0, 1, 0, {}}, flow::observe_force}},
        {Quantity::impulse, {orbit::impulse, {0, 1, 1, {}}, flow::observe_force}},
        {Quantity::stop_work, {orbit::stop_work, {1, 0, 1, {}}, flow::observe_force}},
        {Quantity::rig_force, {orbit::peak_acceleration, force, flow::observe_acceleration}},
    }};
    const auto match = std::find_if(table.begin(), table.end(), [&](const auto& row) { return row.first == quantity; });
    if (match != table.end()) { return match->second; }
    const model::OwnQuantity* own = own_quantity(quantity);
    if (own == nullptr) { return std::nullopt; }
    if (own->from == model::OwnQuantity::From::mean) {
        return Proportional{static_cast<ObservableIndex>(orbit::first_mean + own->signal), own->scale,
                            flow::observe_mean(own->signal), true};
    }
    return Proportional{static_cast<ObservableIndex>(orbit::first_peak + own->signal), own->scale,
                        flow::observe_peak(own->signal)};
}

/// d|mu|/d(key) for the leading multiplier: w^T (dM) v, with dM the derivative of the monodromy matrix along the orbit
/// as the key moves it, a central difference of two exact monodromy matrices.
class MultiplierGradient {
public:
    MultiplierGradient(const flow::System& system, const orbit::Orbit& orbit, const Portrait& portrait)
        : system_(system),
          orbit_(orbit),
          portrait_(portrait) {
        const Eigen::MatrixXd m = portrait.monodromy;
        const Eigen::EigenSolver<Eigen::MatrixXd> solver(m);
        int leading = 0;
        for (int k = 1; k < m.rows(); ++k) {
            if (std::abs(solver.eigenvalues()[k]) > std::abs(solver.eigenvalues()[leading])) { leading = k; }
        }
        mu_ = solver.eigenvalues()[leading];
        right_ = solver.eigenvectors().col(leading);
        // The row of the inverse is the left eigenvector with w^T v = 1, as the perturbation of a simple eigenvalue
        // wants it. Where two multipliers coincide there is no derivative and any choice is arbitrary.
        left_ = solver.eigenvectors().inverse().row(leading).transpose();
    }
    [[nodiscard]] double value() const { return std::abs(mu_); }

    /// w^T (M' - M) v with M' the tighter integrator's matrix at the same state, and what rounding does to the product.
    [[nodiscard]] double error(const flow::System& tighter) const {
        orbit::ReturnMap map = orbit_.map;
        map.precise = true;
        const orbit::Image image = orbit::apply(tighter, map, orbit_.state, orbit::Differentiate::state);
        if (!image.ok()) { return absent; }
        const Eigen::MatrixXd difference = Eigen::MatrixXd(image.derivative) - Eigen::MatrixXd(portrait_.monodromy);
        const double moved = std::abs((left_.transpose() * difference * right_)(0));
        // An eigenvalue moves by the rounding of the matrix times its condition number |w| |v|.
        const double rounding = 1e-15 * portrait_.monodromy.norm() * left_.norm() * right_.norm();
        return moved + rounding;
    }

    [[nodiscard]] double along(const flow::ParameterVector& direction, int column) const {
        // The largest change that a unit step along the key makes, of the state (of order one) or relative of any
        // parameter; parameters near zero (a voltage off, no damping) count in units of 1e-3.
        double size = portrait_.d_state.col(column).norm();
        for (std::size_t k = 0; k < direction.size(); ++k) {
            const double p = std::abs(system_.parameters[k]);
            size = std::max(size, std::abs(direction[k]) / std::max(p, 1e-3));
        }
        if (!(size > 0.0)) { return 0.0; }
        // Relative changes of 1e-5: the truncation of the central difference, h^2, and rounding over h are then both
        // about 1e-10.
        const double h = 1e-5 / size;
        Eigen::MatrixXd forward;
        Eigen::MatrixXd backward;
        if (!monodromy(direction, column, h, forward) || !monodromy(direction, column, -h, backward)) { return absent; }
        const Eigen::MatrixXd dm = (forward - backward) / (2.0 * h);
        const std::complex<double> dmu = (left_.transpose() * dm * right_)(0);
        // d|mu| = Re(conj(mu) dmu)/|mu|.
        return (std::conj(mu_) * dmu).real() / std::abs(mu_);
    }

private:
    /// The monodromy matrix with the parameters moved by h along the key and the state as the orbit follows them to
    /// first order; false when the flow failed.
    bool monodromy(const flow::ParameterVector& direction, int column, double h, Eigen::MatrixXd& m) const {
        flow::System moved = system_;
        for (std::size_t k = 0; k < direction.size(); ++k) { moved.parameters[k] += h * direction[k]; }
        flow::State y = orbit_.state;
        for (int k = 0; k < system_.states(); ++k) { y[index(k)] += h * portrait_.d_state(k, column); }
        orbit::ReturnMap map = orbit_.map;
        map.precise = true;
        const orbit::Image image = orbit::apply(moved, map, y, orbit::Differentiate::state);
        if (!image.ok()) { return false; }
        m = image.derivative;
        return true;
    }

    const flow::System& system_;
    const orbit::Orbit& orbit_;
    const Portrait& portrait_;
    std::complex<double> mu_;
    Eigen::VectorXcd right_, left_;
};

/// Everything one quantity is made of, filled in by measure().
struct Context {
    const flow::System& system;
    const model::Scales& scales;
    std::span<const KeyDirection> keys;
    const orbit::Orbit& orbit;
    const Portrait& portrait;
    const orbit::ErrorEstimate& errors;
    const flow::System* tighter;
    bool with_errors;
    double omega_error;
    int omega_column;  ///< column of the pure frequency direction
    Evaluation& evaluation;

    void set(Quantity q, double value, double error) const {
        evaluation.quantities[static_cast<std::size_t>(q)] = value;
        if (with_errors) { evaluation.error_estimates[static_cast<std::size_t>(q)] = error; }
    }
    std::vector<double>& gradient(Quantity q) const {
        auto& g = evaluation.gradients.quantity[static_cast<std::size_t>(q)];
        g.assign(keys.size(), 0.0);
        return g;
    }
    [[nodiscard]] double observed_error(ObservableIndex o) const {
        if (!with_errors) { return absent; }
        return errors.observed[o] + std::abs(portrait.total(o, omega_column)) * omega_error;
    }
};

void measure_proportional(const Context& c, Quantity q, const Proportional& rule) {
    const double value = c.portrait.image.observed[rule.observable].value;
    const double scale = model::scale_of(rule.scale, c.scales);
    c.set(q, scale * value, scale * c.observed_error(rule.observable));
    auto& gradient = c.gradient(q);
    for (std::size_t i = 0; i < c.keys.size(); ++i) {
        // d(scale value) = scale d(value) + d(scale) value: a key moves the orbit and the unit that it is measured in.
        gradient[i] = scale * c.portrait.total(rule.observable, static_cast<int>(i)) +
                      model::scale_derivative(rule.scale, c.scales, c.keys[i].scales) * value;
    }
    if (!rule.per_time) { return; }
    // The mean of a signal is its integral over tau divided by the duration theta/omega of the map.
    const double per_tau = c.system.omega() / c.orbit.map.duration();
    const std::size_t omega = index(c.system.integrator->info().omega);
    for (std::size_t i = 0; i < c.keys.size(); ++i) {
        gradient[i] = gradient[i] * per_tau + scale * value * c.keys[i].parameters[omega] / c.orbit.map.duration();
    }
    c.set(q, scale * value * per_tau, scale * c.observed_error(rule.observable) * per_tau);
}

/// (x_max - x_min)/2; both extrema by the envelope theorem.
void measure_amplitude(const Context& c) {
    const auto& observed = c.portrait.image.observed;
    const double value = 0.5 * (observed[orbit::x_max].value - observed[orbit::x_min].value);
    c.set(Quantity::amplitude, c.scales.length * value,
          0.5 * c.scales.length * (c.observed_error(orbit::x_max) + c.observed_error(orbit::x_min)));
    auto& gradient = c.gradient(Quantity::amplitude);
    for (std::size_t i = 0; i < c.keys.size(); ++i) {
        const int column = static_cast<int>(i);
        gradient[i] =
            0.5 * c.scales.length * (c.portrait.total(orbit::x_max, column) - c.portrait.total(orbit::x_min, column)) +
            c.keys[i].scales.length * value;
    }
}

/// Of f = omega/(2 pi T) by key i, T the scale of time.
double frequency_derivative(const Context& c, std::size_t i) {
    const double t = c.scales.time;
    const std::size_t omega = index(c.system.integrator->info().omega);
    return c.keys[i].parameters[omega] / (2.0 * pi * t) - c.system.omega() * c.keys[i].scales.time / (2.0 * pi * t * t);
}

void measure_frequency(const Context& c) {
    c.set(Quantity::drive_frequency, c.system.omega() / (2.0 * pi * c.scales.time),
          c.omega_error / (2.0 * pi * c.scales.time));
    auto& gradient = c.gradient(Quantity::drive_frequency);
    for (std::size_t i = 0; i < c.keys.size(); ++i) { gradient[i] = frequency_derivative(c, i); }
}

void measure_multiplier(const Context& c) {
    const MultiplierGradient multiplier(c.system, c.orbit, c.portrait);
    c.set(Quantity::max_multiplier, multiplier.value(), c.with_errors ? multiplier.error(*c.tighter) : absent);
    auto& gradient = c.gradient(Quantity::max_multiplier);
    for (std::size_t i = 0; i < c.keys.size(); ++i) {
        gradient[i] = multiplier.along(c.keys[i].parameters, static_cast<int>(i));
    }
}

}  // namespace

std::uint32_t observables_for(std::span<const Quantity> quantities) {
    std::uint32_t mask = flow::observe_nothing;
    for (Quantity q : quantities) {
        if (const std::optional<Proportional> rule = proportional(q)) { mask |= rule->mask; }
        if (q == Quantity::amplitude) { mask |= flow::observe_extrema; }
    }
    return mask;
}

Measurement measure(const flow::System& system, const flow::System* tighter, const orbit::Orbit& orbit,
                    const model::Scales& scales, std::span<const KeyDirection> keys, const Demand& demand,
                    double omega_error, Evaluation& evaluation) {
    Measurement measurement;
    const std::uint32_t mask = observables_for(demand.quantities);
    std::vector<flow::ParameterVector> directions;
    for (const KeyDirection& key : keys) { directions.push_back(key.parameters); }
    const bool with_errors = demand.error_estimates && tighter != nullptr;
    // One more direction: what an uncertain operating frequency does to every quantity.
    if (with_errors) { directions.push_back(orbit::unit_direction(system.integrator->info().omega)); }
    measurement.portrait = orbit::portray(system, orbit, directions, mask);
    if (!measurement.portrait.ok()) { return measurement; }
    orbit::ErrorEstimate errors;
    if (with_errors) { errors = orbit::estimate_errors(*tighter, orbit, measurement.portrait, mask); }
    evaluation.orbit.state_error = with_errors ? errors.state : absent;
    const Context context{system,    scales,  keys,        orbit,       measurement.portrait,
                          errors,    tighter, with_errors, omega_error, static_cast<int>(keys.size()),
                          evaluation};
    for (Quantity q : demand.quantities) {
        if (const std::optional<Proportional> rule = proportional(q)) {
            measure_proportional(context, q, *rule);
        } else if (q == Quantity::amplitude) {
            measure_amplitude(context);
        } else if (q == Quantity::drive_frequency) {
            measure_frequency(context);
        } else if (q == Quantity::max_multiplier) {
            measure_multiplier(context);
        } else if (q == Quantity::contacts) {
            context.set(q, static_cast<double>(measurement.portrait.image.contacts.size()), 0.0);
        } else if (q == Quantity::period) {
            context.set(q, orbit.map.period, 0.0);
        }
    }
    evaluation.gradients.omega.clear();
    evaluation.gradients.drive_frequency.clear();
    for (std::size_t i = 0; i < keys.size(); ++i) {
        evaluation.gradients.omega.push_back(keys[i].parameters[index(system.integrator->info().omega)]);
        evaluation.gradients.drive_frequency.push_back(frequency_derivative(context, i));
    }
    measurement.ok = true;
    return measurement;
}

}  // namespace percuss::design
