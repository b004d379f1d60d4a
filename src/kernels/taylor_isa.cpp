// The Taylor kernels, compiled once per instruction set (PERCUSS_ISA names it). Everything instantiated here lives in
// namespaces of that name.

#include "flow/taylor.hpp"
#include "kernels/scene_table.hpp"
#include "model/scenes.hpp"

namespace percuss::kernels {
namespace {

/// Room for the order of the tightest tolerance that is allowed: 1e-16 asks for order 21.
constexpr int max_order = 24;

/// Derivative along direction i; zero for scalars that carry none.
template <class T>
double lane(const T& a, std::size_t i) {
    if constexpr (numerics::ScalarTraits<T>::lanes > 0) {
        return a.d[i];
    } else {
        return 0.0;
    }
}

/// The value in double precision with its derivatives.
template <class T>
flow::Sensitive sensitive(const T& a) {
    flow::Sensitive result;
    result.value = numerics::base(a);
    for (std::size_t i = 0; i < static_cast<std::size_t>(numerics::ScalarTraits<T>::lanes); ++i) {
        result.d[i] = lane(a, i);
    }
    return result;
}

template <class T>
void seed([[maybe_unused]] T& target, [[maybe_unused]] std::size_t i, [[maybe_unused]] double value) {
    if constexpr (numerics::ScalarTraits<T>::lanes > 0) { target.d.set(i, value); }
}

/// Values of a state, its derivatives left out.
template <class Jet>
flow::State plain(const typename Jet::State& y) {
    flow::State state{};
    for (std::size_t k = 0; k < y.size(); ++k) { state[k] = numerics::base(y[k]); }
    return state;
}

/// Contacts in the order in which they were met, in double precision.
template <class Jet>
void report_contacts(const flow::SeriesObserver<Jet>& observer, flow::Result& result) {
    for (const auto& record : observer.contacts()) {
        flow::Contact contact;
        contact.theta_in = record.theta_in;
        contact.theta_out = record.theta_out;
        contact.state_in = plain<Jet>(record.state_in);
        contact.state_out = plain<Jet>(record.state_out);
        contact.open_in = record.open_in;
        contact.open_out = record.open_out;
        contact.peak_force = record.peak;
        flow::append_contact(result, contact);
    }
}

/// What the mask asked for; the rest stays zero.
template <class Jet>
void report_observables(const flow::SeriesObserver<Jet>& observer, std::uint32_t mask, flow::Observables& out) {
    if ((mask & flow::observe_extrema) != 0U) {
        out.x_max = sensitive(observer.x_max().value);
        out.x_min = sensitive(-observer.negative_x_min().value);
        out.theta_x_max = observer.x_max().theta;
        out.theta_x_min = observer.negative_x_min().theta;
    }
    if ((mask & flow::observe_force) != 0U) {
        out.peak_force = sensitive(observer.peak_force().value);
        out.theta_peak_force = observer.peak_force().theta;
        out.runner_up_force = observer.runner_up();
        out.impact_velocity = sensitive(observer.impact_velocity().value);
        out.contact_time = sensitive(observer.contact_time());
        out.impulse = sensitive(observer.impulse());
        out.stop_work = sensitive(observer.stop_work());
    }
    if ((mask & flow::observe_acceleration) != 0U) {
        out.peak_acceleration = sensitive(observer.peak_acceleration().value);
    }
    for (int k = 0; k < Jet::peaks; ++k) {
        if ((mask & flow::observe_peak(k)) != 0U) {
            out.peak[static_cast<std::size_t>(k)] = sensitive(observer.peak(k));
        }
    }
    for (int k = 0; k < Jet::means; ++k) {
        if ((mask & flow::observe_mean(k)) != 0U) {
            out.mean[static_cast<std::size_t>(k)] = sensitive(observer.mean(k));
        }
    }
    if ((mask & flow::observe_energy) != 0U) {
        out.drive_work = sensitive(observer.drive_work());
        out.dissipation = sensitive(observer.dissipation());
    }
}

/// One run: seeds a lane per direction, follows the flow, and takes what the scalars of the jet carry into the result.
template <class Jet>
void kernel(const flow::ParameterVector& parameters, const TaylorSettings& settings, const flow::Request& request,
            flow::Result& result) {
    using T = typename Jet::Scalar;
    T p[flow::max_parameters];
    typename Jet::State y;
    T theta(request.theta);
    for (std::size_t k = 0; k < flow::max_parameters; ++k) { p[k] = T(parameters[k]); }
    for (std::size_t k = 0; k < y.size(); ++k) { y[k] = T(request.state[k]); }
    for (std::size_t i = 0; i < request.directions.size(); ++i) {
        const flow::Direction& direction = request.directions[i];
        for (std::size_t k = 0; k < flow::max_parameters; ++k) { seed(p[k], i, direction.parameter[k]); }
        for (std::size_t k = 0; k < y.size(); ++k) { seed(y[k], i, direction.state[k]); }
        seed(theta, i, direction.phase);
    }

    flow::TaylorRun<Jet> run(p, settings.law, settings.order);
    flow::reset(result);
    result.status = run.run(y, theta, request.duration, request);
    result.steps = run.steps();
    result.rhs_evaluations = run.steps();
    y = run.state();
    for (std::size_t k = 0; k < y.size(); ++k) {
        const flow::Sensitive s = sensitive(y[k]);
        result.state[k] = s.value;
        result.state_d[k] = s.d;
    }
    if (result.status == flow::Status::ok) {
        Jet& jet = run.jet();
        // Order 1 is all that d(state)/d(theta) at the end needs.
        jet.expand(run.theta_at(), run.touching(), 1);
        const auto rate = jet.rate();
        for (std::size_t k = 0; k < rate.size(); ++k) { result.rate[k] = rate[k]; }
        if (request.stop == flow::StopMode::held) {
            // k (x - x_stop) from the divided gap: the difference itself loses its digits as the contact gets short.
            const double duration = std::abs(request.duration);
            const T force = jet.stop_stiffness() * run.divided_gap() * request.duration + jet.stop_damping() * y[1];
            result.divided_gap = sensitive(run.divided_gap());
            const T scale = jet.stop_stiffness() * duration + jet.stop_damping();
            // Without damping the unit k |duration| is zero at duration zero, and so is the force.
            if (numerics::base(scale) > 0.0) { result.divided_force = sensitive(force / scale); }
        }
    }
    report_contacts<Jet>(run.observer(), result);
    report_observables<Jet>(run.observer(), request.observe, result.observables);
}

using Dual4 = numerics::Dual<4>;
using Dual8 = numerics::Dual<8>;

template <class S>
constexpr std::array<TaylorKernel, lane_classes.size()> kernels_of() {
    return {kernel<typename S::template Jet<double, max_order>>, kernel<typename S::template Jet<Dual4, max_order>>,
            kernel<typename S::template Jet<Dual8, max_order>>};
}
template <class... S>
constexpr TaylorTable table_of(model::SceneList<S...>) {
    return {kernels_of<S>()...};
}
constexpr TaylorTable table = table_of(model::Scenes{});

}  // namespace

#define PERCUSS_JOIN2(a, b) a##b
#define PERCUSS_JOIN(a, b) PERCUSS_JOIN2(a, b)
const TaylorTable& PERCUSS_JOIN(taylor_table_, PERCUSS_ISA)() { return table; }

}  // namespace percuss::kernels
