#include "kernels/plain_systems.hpp"

#include "model/plain_powers.hpp"
#include "model/plain_rhs.hpp"
#include "numerics/forward_lanes.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>

namespace percuss::kernels {
namespace {

using flow::Direction;
using flow::ParameterVector;
using flow::Powers;
using flow::State;
using numerics::ForwardLanes;

constexpr std::size_t at(int i) { return static_cast<std::size_t>(i); }

/// Half peak to peak raised to the square and averaged over a cycle: mean of (1 - cos)^2/4 is 3/8.
constexpr double mean_square_of_drive = 3.0 / 8.0;

struct Membranes {
    static constexpr int states = model::membrane::states;
    static constexpr int parameters = model::membrane::count;
    static constexpr int sides = 2;

    static flow::SystemInfo info() {
        flow::SystemInfo info;
        info.states = states;
        info.parameters = parameters;
        info.omega = model::membrane::omega;
        info.gap = model::membrane::gap;
        info.stiffness = model::membrane::stiffness;
        info.damping = model::membrane::damping;
        std::copy(model::membrane::names.begin(), model::membrane::names.end(), info.names.begin());
        info.mirror = {0, 1, 3, 2};
        info.observes_membranes = true;
        return info;
    }
    template <class T>
    static void rate(const T* p, const T& theta, const T* state, bool touching, T* out) {
        model::membrane_rhs(p, theta, state, touching, out);
    }
    template <class T>
    static void powers(const T* p, const T& theta, const T* state, T& drive, T& loss) {
        model::membrane_powers(p, theta, state, drive, loss);
    }
    template <class T>
    static T signal(flow::PeakSignal which, int side, const T* p, const T& theta, const T* state) {
        return which == flow::PeakSignal::field ? model::membrane_field(p, theta, state, side)
                                                : model::membrane_current(p, theta, state, side);
    }
    /// The stretches stay positive while the membranes are whole; a stroke of 1000 frame widths is no motion.
    static bool meaningful(const State& y) {
        return std::abs(y[0]) < 1e3 && std::abs(y[1]) < 1e6 && y[2] > 0.0 && y[2] < 1e3 && y[3] > 0.0 && y[3] < 1e3;
    }
    static double centre(const ParameterVector& p) { return 0.5 * p[model::membrane::length]; }
    static State rest_state(const ParameterVector& p) {
        const double l = p[model::membrane::length];
        const double stretch = p[model::membrane::lambda_p] * std::sqrt(1.0 + 0.25 * l * l);
        return {0.5 * l, 0.0, stretch, stretch};
    }
    /// The stretch xi relaxes towards lambda_1 = lambda_p sqrt(1 + u^2) of its membrane, u = x or x - l.
    static flow::StateRange internal_range(const ParameterVector& p, double reach) {
        const double furthest = 0.5 * p[model::membrane::length] + reach;
        const double lower = p[model::membrane::lambda_p];
        const double upper = lower * std::sqrt(1.0 + furthest * furthest);
        return {{0.0, 0.0, lower, lower}, {0.0, 0.0, upper, upper}};
    }
    /// Stiffness of both membranes about rest for a given phi^2, dashpots of the Maxwell branches locked.
    static double stiffness(const ParameterVector& values, double phi_squared) {
        using T = ForwardLanes<1>;
        std::array<T, parameters> p;
        std::transform(values.begin(), values.begin() + parameters, p.begin(), [](double v) { return T(v); });
        const State rest = rest_state(values);
        const T phi(std::sqrt(phi_squared));
        double sum = 0.0;
        for (const double u : {rest[0], -rest[0]}) {
            T displacement(u);
            displacement.d[0] = 1.0;
            sum += model::membrane_force(p.data(), displacement, T(0.0), T(rest[2]), phi).d[0];
        }
        return sum * values[model::membrane::layers];
    }
    /// Above the voltage that makes the rest position unstable: the undriven frequency.
    static double linear_resonance(const ParameterVector& p) {
        const double voltage = p[model::membrane::voltage];
        const double driven = stiffness(p, mean_square_of_drive * voltage * voltage);
        return std::sqrt(driven > 0.0 ? driven : stiffness(p, 0.0));
    }
};

/// Without the Maxwell branches (mu_ratio = 0, which switches their force off): x and x' are all there is.
struct ElasticMembranes : Membranes {
    static constexpr int states = 2;

    static flow::SystemInfo info() {
        flow::SystemInfo info = Membranes::info();
        info.states = states;
        info.mirror = {0, 1, 0, 0};
        return info;
    }
    /// The idle stretches are given the value one, which keeps every power finite.
    template <class T>
    static std::array<T, Membranes::states> filled(const T* state) {
        return {state[0], state[1], T(1.0), T(1.0)};
    }
    template <class T>
    static void rate(const T* p, const T& theta, const T* state, bool touching, T* out) {
        std::array<T, Membranes::states> full;
        Membranes::rate(p, theta, filled(state).data(), touching, full.data());
        std::copy_n(full.begin(), states, out);
    }
    template <class T>
    static void powers(const T* p, const T& theta, const T* state, T& drive, T& loss) {
        Membranes::powers(p, theta, filled(state).data(), drive, loss);
    }
    static bool meaningful(const State& y) { return Membranes::meaningful(filled(y.data())); }
    static State rest_state(const ParameterVector& p) { return {Membranes::centre(p), 0.0, 0.0, 0.0}; }
    static flow::StateRange internal_range(const ParameterVector&, double) { return {}; }
};

struct Spring {
    static constexpr int states = model::spring::states;
    static constexpr int parameters = model::spring::count;
    static constexpr int sides = 0;

    static flow::SystemInfo info() {
        flow::SystemInfo info;
        info.states = states;
        info.parameters = parameters;
        info.omega = model::spring::omega;
        info.gap = model::spring::gap;
        info.stiffness = model::spring::stop_stiffness;
        info.damping = model::spring::stop_damping;
        std::copy(model::spring::names.begin(), model::spring::names.end(), info.names.begin());
        info.mirror = {0, 1, 0, 0};
        return info;
    }
    template <class T>
    static void rate(const T* p, const T& theta, const T* state, bool touching, T* out) {
        model::spring_rhs(p, theta, state, touching, out);
    }
    template <class T>
    static void powers(const T* p, const T& theta, const T* state, T& drive, T& loss) {
        model::spring_powers(p, theta, state, drive, loss);
    }
    template <class T>
    static T signal(flow::PeakSignal, int, const T*, const T&, const T*) {
        return T(0.0);
    }
    static bool meaningful(const State& y) { return std::abs(y[0]) < 1e12 && std::abs(y[1]) < 1e12; }
    static double centre(const ParameterVector&) { return 0.0; }
    static State rest_state(const ParameterVector&) { return {}; }
    static flow::StateRange internal_range(const ParameterVector&, double) { return {}; }
    /// sqrt(k1); for a double well the frequency in a well, for a purely cubic spring the one (describing function,
    /// 3/4 k3 A^2) at the static amplitude A = (F/k3)^(1/3); 1 when nothing restores the mass.
    static double linear_resonance(const ParameterVector& p) {
        const double k1 = p[model::spring::stiffness];
        const double k3 = p[model::spring::cubic];
        if (k1 > 0.0) { return std::sqrt(k1); }
        if (!(k3 > 0.0)) { return 1.0; }
        const double amplitude = std::cbrt(std::abs(p[model::spring::force]) / k3);
        const double squared = k1 < 0.0 ? -2.0 * k1 : 0.75 * k3 * amplitude * amplitude;
        return squared > 0.0 ? std::sqrt(squared) : 1.0;
    }
};

/// A point of the motion whose every number carries N derivatives, one per direction.
template <class Model, int N>
struct Lifted {
    using T = ForwardLanes<N>;
    std::array<T, Model::parameters> p;
    std::array<T, Model::states> state;
    T theta;

    Lifted(const ParameterVector& parameters, double phase, const State& y, std::span<const Direction> directions) {
        for (int i = 0; i < Model::parameters; ++i) {
            p[at(i)] = T(parameters[at(i)]);
            for (std::size_t j = 0; j < directions.size(); ++j) { p[at(i)].d[j] = directions[j].parameter[at(i)]; }
        }
        for (int i = 0; i < Model::states; ++i) {
            state[at(i)] = T(y[at(i)]);
            for (std::size_t j = 0; j < directions.size(); ++j) { state[at(i)].d[j] = directions[j].state[at(i)]; }
        }
        theta = T(phase);
        for (std::size_t j = 0; j < directions.size(); ++j) { theta.d[j] = directions[j].phase; }
    }
};

template <class Model>
class PlainSystem final : public flow::RightHandSide {
public:
    explicit PlainSystem(flow::ContactLaw law) : info_(Model::info()), law_(law) {
        info_.releases_on_force = law == flow::ContactLaw::no_tension;
        info_.has_stop = law != flow::ContactLaw::none;
    }

    [[nodiscard]] const flow::SystemInfo& info() const override { return info_; }
    [[nodiscard]] flow::ContactLaw contact_law() const override { return law_; }
    [[nodiscard]] int sides() const override { return Model::sides; }
    [[nodiscard]] bool meaningful(const State& state) const override { return Model::meaningful(state); }
    [[nodiscard]] State rest_state(const ParameterVector& p) const override { return Model::rest_state(p); }
    [[nodiscard]] flow::StateRange internal_range(const ParameterVector& p, double reach) const override {
        return Model::internal_range(p, reach);
    }
    [[nodiscard]] double linear_resonance(const ParameterVector& p) const override {
        return Model::linear_resonance(p);
    }
    [[nodiscard]] double centre(const ParameterVector& p) const override { return Model::centre(p); }
    /// The centre is linear in the parameters.
    [[nodiscard]] double centre_derivative(const ParameterVector&, const ParameterVector& dp) const override {
        return Model::centre(dp);
    }

    void rates(const ParameterVector& p, double theta, const State& state, bool touching,
               std::span<const Direction> directions, State& rate, State* rate_d) const override {
        if (directions.empty()) {
            Model::rate(p.data(), theta, state.data(), touching, rate.data());
            return;
        }
        with_lanes(directions.size(), [&]<int N>() {
            const Lifted<Model, N> point(p, theta, state, directions);
            std::array<ForwardLanes<N>, Model::states> out;
            Model::rate(point.p.data(), point.theta, point.state.data(), touching, out.data());
            for (int i = 0; i < Model::states; ++i) {
                rate[at(i)] = out[at(i)].value;
                for (std::size_t j = 0; j < directions.size(); ++j) { rate_d[j][at(i)] = out[at(i)].d[j]; }
            }
        });
    }

    void powers(const ParameterVector& p, double theta, const State& state, std::span<const Direction> directions,
                Powers& value, Powers* value_d) const override {
        if (directions.empty()) {
            Model::powers(p.data(), theta, state.data(), value.drive, value.loss);
            return;
        }
        with_lanes(directions.size(), [&]<int N>() {
            const Lifted<Model, N> point(p, theta, state, directions);
            ForwardLanes<N> drive;
            ForwardLanes<N> loss;
            Model::powers(point.p.data(), point.theta, point.state.data(), drive, loss);
            value = {drive.value, loss.value};
            for (std::size_t j = 0; j < directions.size(); ++j) { value_d[j] = {drive.d[j], loss.d[j]}; }
        });
    }

    [[nodiscard]] double signal(flow::PeakSignal which, int side, const ParameterVector& p, double theta,
                                const State& state, std::span<const Direction> directions,
                                double* value_d) const override {
        if (directions.empty()) { return Model::template signal<double>(which, side, p.data(), theta, state.data()); }
        double value = 0.0;
        with_lanes(directions.size(), [&]<int N>() {
            const Lifted<Model, N> point(p, theta, state, directions);
            const ForwardLanes<N> out =
                Model::template signal<ForwardLanes<N>>(which, side, point.p.data(), point.theta, point.state.data());
            value = out.value;
            for (std::size_t j = 0; j < directions.size(); ++j) { value_d[j] = out.d[j]; }
        });
        return value;
    }

private:
    /// Calls the function with the smallest compiled number of lanes that holds `count` directions.
    template <class Function>
    static void with_lanes(std::size_t count, Function&& function) {
        if (count <= 1) {
            function.template operator()<1>();
        } else if (count <= 4) {
            function.template operator()<4>();
        } else {
            function.template operator()<flow::max_lanes>();
        }
    }

    flow::SystemInfo info_;
    flow::ContactLaw law_;
};

flow::ContactLaw contact_law(model::StopLaw law) {
    switch (law) {
        case model::StopLaw::kelvin_voigt: return flow::ContactLaw::kelvin_voigt;
        case model::StopLaw::no_tension: return flow::ContactLaw::no_tension;
        case model::StopLaw::none: break;
    }
    return flow::ContactLaw::none;
}

}  // namespace

std::shared_ptr<const flow::RightHandSide> make_plain_system(model::ActuatorKind kind, model::StopLaw law,
                                                             bool viscous) {
    if (kind == model::ActuatorKind::spring_mass) { return std::make_shared<PlainSystem<Spring>>(contact_law(law)); }
    if (viscous) { return std::make_shared<PlainSystem<Membranes>>(contact_law(law)); }
    return std::make_shared<PlainSystem<ElasticMembranes>>(contact_law(law));
}

}  // namespace percuss::kernels
