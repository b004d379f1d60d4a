// The Taylor templates in quadruple precision: the reference orbit far beyond double precision, the true error of the
// double kernels, and the order of single steps with room for many halvings.

#include "engine_cases.hpp"
#include "flow/taylor.hpp"
#include "flow/taylor_order.hpp"
#include "model/membrane/jet.hpp"
#include "model/membrane/membrane.hpp"
#include "model/spring/jet.hpp"
#include "orbit/orbit.hpp"
#include "quad.hpp"

#include <doctest/doctest.h>

#include <cmath>
#include <vector>

using namespace percuss;
using flow::ParameterVector;
using flow::State;
using flow::Status;
using test::at;
using test::paper_defaults;
using test::Quad;

namespace {

constexpr int quad_order = 48;
template <class T, int Order>
using ViscousJet = model::MembraneJet<T, true, Order>;
using QuadJet = ViscousJet<Quad, quad_order>;
using QuadState = QuadJet::State;

std::array<Quad, flow::max_parameters> widened(const ParameterVector& p) {
    std::array<Quad, flow::max_parameters> q;
    for (std::size_t k = 0; k < p.size(); ++k) { q[k] = p[k]; }
    return q;
}

struct QuadRun {
    Status status = Status::not_run;
    QuadState state{};
    std::vector<flow::SeriesObserver<QuadJet>::ContactRecord> contacts;
    Quad x_max, peak_force;
};

/// One drive period from theta = 0. Tolerance 1e-32 makes the order 39.
QuadRun quad_period(const ParameterVector& p, const QuadState& start) {
    const auto q = widened(p);
    flow::TaylorRun<QuadJet> run(q.data(), model::ContactLaw::kelvin_voigt, flow::taylor_order(1e-32));
    flow::Request request;
    request.observe = flow::observe_extrema | flow::observe_force;
    QuadRun result;
    result.status = run.run(start, Quad(0.0), Quad(2.0) * Quad(M_PIq), request);
    result.state = run.state();
    result.contacts = run.observer().contacts();
    result.x_max = run.observer().x_max().value;
    result.peak_force = run.observer().peak_force().value;
    return result;
}

double norm(const QuadState& a, const QuadState& b) {
    double largest = 0.0;
    for (std::size_t k = 0; k < a.size(); ++k) {
        largest = std::max(largest, std::abs(static_cast<double>(a[k] - b[k])));
    }
    return largest;
}

/// Newton's iteration with residuals in quadruple precision and the double monodromy matrix: each step gains about
/// fourteen digits.
struct QuadOrbit {
    QuadState state{};
    double residual = 1.0;
    QuadRun last;
};
QuadOrbit quad_orbit(const ParameterVector& p, const State& start) {
    const auto integrator = test::membranes();
    const flow::System system{integrator.get(), p, nullptr};
    const orbit::Orbit seed = orbit::find_orbit(system, {}, start);
    REQUIRE(seed.ok());
    const auto lu = (numerics::SmallMatrix::Identity(4, 4) - seed.monodromy).partialPivLu();
    QuadOrbit result;
    for (std::size_t k = 0; k < 4; ++k) { result.state[k] = start[k]; }
    for (int iteration = 0; iteration < 6; ++iteration) {
        result.last = quad_period(p, result.state);
        REQUIRE(result.last.status == Status::ok);
        result.residual = norm(result.last.state, result.state);
        if (result.residual < 1e-30) { break; }
        // The residual's size is taken out before it is rounded to double.
        numerics::SmallVector defect(4);
        for (int k = 0; k < 4; ++k) {
            defect[k] =
                static_cast<double>((result.last.state[at(k)] - result.state[at(k)]) * Quad(1.0 / result.residual));
        }
        const numerics::SmallVector step = lu.solve(defect);
        for (int k = 0; k < 4; ++k) { result.state[at(k)] += Quad(step[k]) * Quad(result.residual); }
    }
    return result;
}

template <template <class, int> class Jet>
double step_error(const ParameterVector& p, const State& state, double theta, double h, int order) {
    using J = Jet<Quad, quad_order>;
    const auto q = widened(p);
    std::array<typename J::State, 2> ends;
    for (std::size_t i = 0; i < 2; ++i) {
        const int n = i == 0 ? order : quad_order;
        J jet(q.data());
        typename J::State y;
        for (std::size_t k = 0; k < y.size(); ++k) { y[k] = state[k]; }
        jet.load(y);
        jet.expand(Quad(theta), false, n);
        jet.advance(Quad(h), n);
        ends[i] = jet.unload();
    }
    double error = 0.0;
    for (std::size_t k = 0; k < ends[0].size(); ++k) {
        error = std::max(error, std::abs(static_cast<double>(ends[0][k] - ends[1][k])));
    }
    return error;
}

/// Local errors fall like h^(p+1). From 1e-29 upwards by doubling h twice: rounding is 1e-33, and the next term of the
/// series is the smaller the smaller h.
template <template <class, int> class Jet>
void check_order(const ParameterVector& p, const State& state, double theta) {
    for (int order : {4, 9, 14, 17, 20}) {
        CAPTURE(order);
        double h = 1.0;
        while (!(step_error<Jet>(p, state, theta, h, order) < 1e-29)) { h *= 0.9; }
        double fine = step_error<Jet>(p, state, theta, h, order);
        for (const double allowed : {0.3, 0.6}) {
            h *= 2.0;
            const double coarse = step_error<Jet>(p, state, theta, h, order);
            CAPTURE(h);
            CHECK(std::abs(std::log2(coarse / fine) - (order + 1)) < allowed);
            fine = coarse;
        }
    }
}

}  // namespace

TEST_CASE("the orbit at omega = 1.9 in quadruple precision") {
    const State& reference = test::reference_orbits[0].state;
    const QuadOrbit exact = quad_orbit(paper_defaults, reference);
    CHECK(exact.residual < 1e-25);
    MESSAGE("residual in quadruple precision ", exact.residual);
    REQUIRE(exact.last.contacts.size() == 1);
    // The reference is good to 1e-14 and given with 14 decimals.
    for (std::size_t k = 0; k < 4; ++k) {
        CAPTURE(k);
        CHECK(std::abs(static_cast<double>(exact.state[k] - Quad(reference[k]))) < 1e-13);
    }
    CHECK(std::abs(static_cast<double>(exact.last.x_max - Quad(test::at_1_9::x_max))) < 1e-13);
    CHECK(std::abs(static_cast<double>(exact.last.peak_force - Quad(test::reference_orbits[0].peak_force))) < 6e-12);
    const double entry = static_cast<double>(exact.last.contacts[0].theta_in / Quad(1.9));
    const double exit = static_cast<double>(exact.last.contacts[0].theta_out / Quad(1.9));
    CHECK(std::abs(entry - test::at_1_9::entry_tau) < 6e-13);
    CHECK(std::abs(exit - test::at_1_9::exit_tau) < 1e-13);

    // True errors of the double engine against it.
    const auto integrator = test::membranes();
    const flow::System system{integrator.get(), paper_defaults, nullptr};
    const orbit::Orbit rounded = orbit::find_orbit(system, {}, reference);
    REQUIRE(rounded.ok());
    double state_error = 0.0;
    for (std::size_t k = 0; k < 4; ++k) {
        state_error = std::max(state_error, std::abs(static_cast<double>(exact.state[k] - Quad(rounded.state[k]))));
    }
    MESSAGE("error of the double orbit's state ", state_error);
    CHECK(state_error < 2e-14);  // rounding, 2e-16 a step for 20 steps, over 1 - 0.89
    const orbit::Image image = orbit::apply(system, {}, rounded.state, orbit::Differentiate::nothing, {},
                                            flow::observe_force | flow::observe_extrema);
    const double force_error =
        std::abs(static_cast<double>(exact.last.peak_force - Quad(image.observed[orbit::peak_force].value)));
    MESSAGE("error of the double orbit's peak force ", force_error);
    CHECK(force_error < 1e-12);  // 2500 times the position's rounding of 1e-16 and more from the speed
    CHECK(std::abs(static_cast<double>(exact.last.x_max - Quad(image.observed[orbit::x_max].value))) < 5e-15);
}

TEST_CASE("the three orbits at omega = 2.2 in quadruple precision") {
    for (int which : {1, 2, 3}) {
        const test::ReferenceOrbit& known = test::reference_orbits[at(which)];
        CAPTURE(known.name);
        const ParameterVector p = test::with(paper_defaults, model::membrane::omega, known.omega);
        const QuadOrbit exact = quad_orbit(p, known.state);
        CHECK(exact.residual < 1e-25);
        CHECK(exact.last.contacts.size() == at(known.contacts));
        for (std::size_t k = 0; k < 4; ++k) {
            CHECK(std::abs(static_cast<double>(exact.state[k] - Quad(known.state[k]))) < 2e-12);
        }
    }
}

TEST_CASE("the local error of a step of order p falls like h^(p+1), to many digits") {
    check_order<ViscousJet>(paper_defaults, {0.45, 0.13, 1.18, 1.21}, 0.7);
    const ParameterVector other = {1.2, 0.6, 2.6, 2.3, 0.15, 40.0, 0.9, 0.1, 900.0, 1.0, 0.5, 2.0, 2.4};
    check_order<ViscousJet>(other, {0.35, -0.2, 1.3, 1.25}, 2.9);
    check_order<model::SpringJet>({0.1, 1.3, 0.4, 0.7, 0.2, 40.0, 1.5, 0.9}, {0.3, 0.4}, 1.1);
}
