// ARKODE and CVODES on motions that are known: the reference orbit of the actuator, published multipliers, closed
// forms.

#include "model/membrane/membrane.hpp"
#include "numerics/linear.hpp"
#include "sundials_cases.hpp"

#include <doctest/doctest.h>

#include <algorithm>
#include <array>
#include <complex>
#include <functional>

using namespace percuss;
using flow::Status;
using test::at;
using test::Case;
using test::two_pi;

namespace {

struct Backend {
    const char* name;
    std::unique_ptr<flow::Integrator> (*make)(std::shared_ptr<const flow::RightHandSide>, double);
    double tolerance;
    double orbit_error;  ///< of the state after a period, measured, times ten or more
};
// Error of a period at tolerance 1e-12: 3e-14 (order 8, error estimated at order 7) and 8e-11 (order at most 5).
constexpr std::array<Backend, 2> backends = {
    {{"erk", flow::make_erk, 1e-12, 1e-12}, {"cvode", flow::make_cvode, 1e-12, 1e-9}}};

Case paper_case(std::uint32_t observe) {
    Case c{test::paper_defaults, {}};
    c.request.state = test::paper_orbit;
    c.request.duration = two_pi;
    c.request.observe = observe;
    return c;
}

std::vector<flow::Direction> state_directions(int states) {
    std::vector<flow::Direction> directions(at(states));
    for (int i = 0; i < states; ++i) { directions[at(i)].state[at(i)] = 1.0; }
    return directions;
}

numerics::SmallMatrix monodromy(const flow::Result& result, int states) {
    numerics::SmallMatrix m(states, states);
    for (int i = 0; i < states; ++i) {
        for (int j = 0; j < states; ++j) { m(i, j) = result.state_d[at(i)][at(j)]; }
    }
    return m;
}

/// Eigenvalues by falling modulus, upper half plane first.
std::vector<std::complex<double>> multipliers(const flow::Result& result, int states) {
    const numerics::SmallComplexVector values = monodromy(result, states).eigenvalues();
    std::vector<std::complex<double>> sorted(values.begin(), values.end());
    std::sort(sorted.begin(), sorted.end(), [](const auto& a, const auto& b) {
        const double gap = std::abs(a) - std::abs(b);
        return std::abs(gap) > 1e-9 ? gap > 0.0 : a.imag() > b.imag();
    });
    return sorted;
}

/// Newton's method for a periodic orbit of one drive cycle.
Case closed(const flow::Integrator& integrator, Case c) {
    const int n = integrator.info().states;
    const auto directions = state_directions(n);
    c.request.directions = directions;
    c.request.duration = two_pi;
    for (int i = 0; i < 12; ++i) {
        const flow::Result result = test::run(integrator, c);
        REQUIRE(result.status == Status::ok);
        numerics::SmallVector residual(n);
        for (int k = 0; k < n; ++k) { residual[k] = result.state[at(k)] - c.request.state[at(k)]; }
        const numerics::SmallMatrix map = numerics::SmallMatrix::Identity(n, n) - monodromy(result, n);
        const numerics::SmallVector step = map.partialPivLu().solve(residual);
        for (int k = 0; k < n; ++k) { c.request.state[at(k)] += step[k]; }
        if (step.norm() < 1e-13) { break; }
    }
    c.request.directions = {};
    return c;
}

}  // namespace

TEST_CASE("the reference orbit at omega = 1.9 closes and shows its extrema and contact") {
    for (const Backend& backend : backends) {
        CAPTURE(backend.name);
        const auto integrator = backend.make(test::membranes(), backend.tolerance);
        const flow::Result result = test::run(*integrator, paper_case(flow::observe_all));
        REQUIRE(result.status == Status::ok);
        for (std::size_t i = 0; i < 4; ++i) {
            CHECK(std::abs(result.state[i] - test::paper_orbit[i]) < backend.orbit_error);
        }
        const flow::Observables& seen = result.observables;
        CHECK(std::abs(seen.x_max.value - 0.50189332198089) < backend.orbit_error);
        CHECK(std::abs(seen.x_min.value - 0.280381223035752) < backend.orbit_error);
        // Twelve digits given; the stop multiplies errors of x by k = 2500.
        CHECK(std::abs(seen.peak_force.value - 4.73731309181) < 1e-11 + 10.0 * backend.orbit_error);
        REQUIRE(result.contacts.size() == 1);
        const flow::Contact& contact = result.contacts.front();
        CHECK(std::abs(contact.theta_in / 1.9 - 1.769365946172) < 1e-12 + backend.orbit_error);
        CHECK(std::abs(contact.state_in[1] - 0.102971965449496) < 1e-12 + backend.orbit_error);
        CHECK(std::abs(contact.theta_out / 1.9 - 1.83003348997329) < 1e-12 + backend.orbit_error);
        CHECK(std::abs(contact.state_out[1] + 0.0969072098012401) < 1e-12 + backend.orbit_error);
        CHECK(contact.state_in[0] == integrator->stop_position(test::paper_defaults));
        CHECK(contact.state_out[0] == integrator->stop_position(test::paper_defaults));
        CHECK_FALSE(contact.open_in);
        CHECK_FALSE(contact.open_out);
        CHECK(contact.peak_force == seen.peak_force.value);
        CHECK(seen.impact_velocity.value == contact.state_in[1]);
        CHECK(seen.contact_time.value == doctest::Approx(1.83003348997329 - 1.769365946172).epsilon(1e-9));
        CHECK(seen.runner_up_force == 0.0);
    }
}

TEST_CASE("energy over the periodic orbit: drive work = dissipation + stop work") {
    for (const Backend& backend : backends) {
        CAPTURE(backend.name);
        const auto integrator = backend.make(test::membranes(), backend.tolerance);
        const flow::Observables seen = test::run(*integrator, paper_case(flow::observe_all)).observables;
        CHECK(seen.drive_work.value > 1e-3);
        CHECK(seen.stop_work.value > 1e-4);
        const double defect = seen.drive_work.value - seen.dissipation.value - seen.stop_work.value;
        CHECK(std::abs(defect) < std::min(1e-10, backend.orbit_error));
    }
}

TEST_CASE("multipliers at omega = 1.9") {
    // Reference good to 4e-10 of the modulus.
    const std::array<std::complex<double>, 4> expected = {{{0.88573446803, 0.0},
                                                           {0.84712674709, 0.0},
                                                           {-0.10218488568, 0.80397229482},
                                                           {-0.10218488568, -0.80397229482}}};
    for (const Backend& backend : backends) {
        CAPTURE(backend.name);
        const auto integrator = backend.make(test::membranes(), backend.tolerance);
        const auto directions = state_directions(4);
        Case c = paper_case(flow::observe_nothing);
        c.request.directions = directions;
        const auto found = multipliers(test::run(*integrator, c), 4);
        for (std::size_t i = 0; i < 4; ++i) {
            CHECK(std::abs(found[i] - expected[i]) < 4e-10 + 3.0 * backend.orbit_error);
        }
    }
}

TEST_CASE("other orbits at omega = 2.2 and 3.0 are found by Newton's method from rounded starts") {
    struct Known {
        double omega;
        flow::State state;
        double peak_force;
        double max_multiplier;
    };
    const std::array<Known, 4> orbits = {
        {{2.2, {0.24433288829767, -0.09712338303067, 1.16699726842616, 1.21157473484297}, 9.721692402, 0.90712398},
         {2.2, {0.47860247948540, -0.15990109872096, 1.17691386448086, 1.19845644637760}, 4.917806357, 2.64292692},
         {2.2, {0.43717580936204, -0.00920081852185, 1.18507565744412, 1.18498227358562}, 0.0, 0.89820161},
         {3.0, {0.41090395464036, -0.00136890359622, 1.18476545344551, 1.18475676192469}, 0.0, 0.92433408}}};
    const auto integrator = flow::make_erk(test::membranes(), 1e-12);
    for (const Known& known : orbits) {
        CAPTURE(known.omega);
        Case c = paper_case(flow::observe_all);
        c.parameters[model::membrane::omega] = known.omega;
        for (std::size_t i = 0; i < 4; ++i) { c.request.state[i] = std::round(known.state[i] * 1e4) * 1e-4; }
        c = closed(*integrator, c);
        for (std::size_t i = 0; i < 4; ++i) { CHECK(std::abs(c.request.state[i] - known.state[i]) < 5e-12); }
        const auto directions = state_directions(4);
        c.request.directions = directions;
        const flow::Result result = test::run(*integrator, c);
        CHECK(std::abs(result.observables.peak_force.value - known.peak_force) < 2e-9);
        CHECK(std::abs(std::abs(multipliers(result, 4).front()) - known.max_multiplier) < 1e-8);
    }
}

TEST_CASE("soft-impact oscillator: multipliers near its fold") {
    // x'' + 0.02 x' + x + 29 max(x - 1, 0) = f cos(w t) at w = 1.5652620209: a complex pair, known from exact
    // propagation and AUTO-07p, 0.95805878 +- 0.07055949 i.
    for (const Backend& backend : backends) {
        CAPTURE(backend.name);
        const auto integrator = backend.make(test::spring(), backend.tolerance);
        Case c{{0.02, 1.0, 0.0, 0.152380952381, 1.0, 29.0, 0.0, 1.5652620209}, {}};
        c.request.state = {-2.6, 6.1};
        c = closed(*integrator, c);
        const auto directions = state_directions(2);
        c.request.directions = directions;
        const flow::Result result = test::run(*integrator, c);
        REQUIRE(result.contacts.size() == 1);
        const auto found = multipliers(result, 2);
        CHECK(std::abs(found[0] - std::complex<double>(0.95805878, 0.07055949)) < 1e-7);
    }
}

TEST_CASE("free linear oscillator: closed form of the forced motion") {
    const double c = 0.13;
    const double k1 = 1.7;
    const double force = 0.6;
    const double w = 1.1;
    const double stiff = k1 - w * w;
    const double scale = force / (stiff * stiff + c * c * w * w);
    // x = scale (stiff cos(theta) + c w sin(theta))
    const double amplitude = scale * std::hypot(stiff, c * w);
    for (const Backend& backend : backends) {
        CAPTURE(backend.name);
        const auto integrator = backend.make(test::spring(), backend.tolerance);
        Case free{{c, k1, 0.0, force, 1e3, 1.0, 0.0, w}, {}};
        free.request.state = {scale * stiff, w * scale * c * w};
        free.request.duration = two_pi;
        free.request.observe = flow::observe_all;
        const flow::Result result = test::run(*integrator, free);
        REQUIRE(result.status == Status::ok);
        const double error = backend.orbit_error;
        CHECK(std::abs(result.state[0] - free.request.state[0]) < error);
        CHECK(std::abs(result.state[1] - free.request.state[1]) < error);
        CHECK(std::abs(result.rate[0] - result.state[1] / w) < 1e-15);
        const flow::Observables& seen = result.observables;
        CHECK(std::abs(seen.x_max.value - amplitude) < error);
        CHECK(std::abs(seen.x_min.value + amplitude) < error);
        CHECK(std::abs(seen.theta_x_max - std::atan2(c * w, stiff)) < 1e-7);
        CHECK(std::abs(seen.peak_acceleration.value - w * w * amplitude) < 10.0 * error);
        const double loss = std::numbers::pi * c * w * amplitude * amplitude;
        CHECK(std::abs(seen.drive_work.value - loss) < 10.0 * error);
        CHECK(std::abs(seen.dissipation.value - loss) < 10.0 * error);
        CHECK(result.contacts.empty());
        CHECK(seen.peak_force.value == 0.0);
        CHECK(seen.contact_time.value == 0.0);
    }
}

TEST_CASE("error falls with the tolerance as the orders of the methods promise") {
    // Error per unit step: proportional to tolerance^(q/(q+1)) or faster. Two-sided: a method of order one would be
    // seen.
    const std::array<double, 3> tolerances = {1e-6, 1e-8, 1e-10};
    for (const Backend& backend : backends) {
        CAPTURE(backend.name);
        double previous = 1.0;
        for (const double tolerance : tolerances) {
            CAPTURE(tolerance);
            const auto integrator = backend.make(test::membranes(), tolerance);
            const flow::Result result = test::run(*integrator, paper_case(flow::observe_nothing));
            double error = 0.0;
            for (std::size_t i = 0; i < 4; ++i) {
                error = std::max(error, std::abs(result.state[i] - test::paper_orbit[i]));
            }
            CHECK(error < 100.0 * tolerance);
            CHECK(error < 0.3 * previous);
            CHECK(result.steps < 1000);
            previous = error;
        }
    }
}
