// Traps around stable orbits, the capture of motions, Lyapunov exponents and aperiodic motions.

#include "attractor/ensemble.hpp"
#include "engine_cases.hpp"
#include "model/membrane/membrane.hpp"
#include "orbit/polish.hpp"
#include "relative.hpp"

#include <doctest/doctest.h>

#include <stdexcept>

namespace {

using namespace percuss;
using attractor::Box;
using attractor::Ensemble;
using attractor::EnsembleOptions;
using attractor::Kind;
using attractor::Trap;
using attractor::Wander;
using test::at;
using test::paper_defaults;

flow::System system_at(const flow::Integrator& integrator, double omega) {
    return {&integrator, test::with(paper_defaults, model::membrane::omega, omega), nullptr};
}

flow::State one_cycle(const flow::System& system, const flow::State& from) {
    flow::Request request;
    request.state = from;
    request.duration = test::two_pi;
    flow::Result result;
    system.run(request, result);
    REQUIRE(result.status == flow::Status::ok);
    return result.state;
}

constexpr flow::State scale = {0.15, 0.4, 0.1, 0.1};

}  // namespace

TEST_CASE("a trap holds what its orbit attracts and not its saddle") {
    const auto integrator = test::membranes(model::ContactLaw::kelvin_voigt, 1e-8);
    const flow::System system = system_at(*integrator, 2.2);
    const auto& struck = test::reference_orbits[1];
    const auto& saddle = test::reference_orbits[2];
    const auto& clear = test::reference_orbits[3];
    for (const auto* reference : {&struck, &clear}) {
        const Trap trap(system, orbit::polish_orbit(system, reference->state, 1), scale);
        CHECK(trap.period() == 1);
        CHECK(trap.radius() > 1e-3);
        CHECK(trap.max_multiplier() == test::relative(reference->max_multiplier, 1e-5));
        CHECK(trap.holds(reference->state) == 0);
        CHECK_FALSE(trap.holds(saddle.state).has_value());
        CHECK_FALSE(trap.holds(reference == &struck ? clear.state : struck.state).has_value());
    }
}

TEST_CASE("all strobe points of an orbit have their part of the trap") {
    const auto integrator = test::membranes();
    const flow::System system = system_at(*integrator, 1.78);
    const auto& reference = test::reference_orbits[5];
    const Trap trap(system, orbit::polish_orbit(system, reference.state, 3), scale);
    REQUIRE(trap.period() == 3);
    CHECK(trap.max_multiplier() == test::relative(reference.max_multiplier, 1e-6));
    flow::State y = reference.state;
    for (int cycle = 0; cycle < 3; ++cycle) {
        const auto point = trap.holds(y);
        REQUIRE(point.has_value());
        CHECK(test::distance(trap.points()[at(*point)], y, 4) < 1e-10);
        // Points a little off are carried into the next part, nearer to it, as the multipliers say.
        flow::State off = y;
        off[0] += 0.3 * trap.radius() * scale[0];
        if (trap.holds(off)) {
            const flow::State image = one_cycle(system, off);
            CHECK(trap.agrees(*point, off, image));
            CHECK(trap.norm((*point + 1) % 3, image) < trap.norm(*point, off));
            flow::State elsewhere = image;
            elsewhere[1] += 0.05 * scale[1];
            CHECK_FALSE(trap.agrees(*point, off, elsewhere));
        }
        y = one_cycle(system, y);
    }
}

TEST_CASE("beside a fold the trap shrinks below the distance of the saddle") {
    const auto integrator = test::membranes();
    for (const double omega : {2.5, 2.58, 2.586}) {  // the fold is at 2.58605
        CAPTURE(omega);
        const flow::System system = system_at(*integrator, omega);
        // Along the branch from the orbit known at 2.2.
        orbit::Orbit node = orbit::polish_orbit(system_at(*integrator, 2.2), test::reference_orbits[1].state, 1);
        for (double w = 2.2; w < omega;) {
            w = std::min(omega, w + (w < 2.57 ? 0.02 : 0.001));
            node = orbit::find_orbit(system.at_omega(w), node.map, node.state);
            REQUIRE(node.ok());
        }
        REQUIRE(orbit::max_multiplier(node) < 1.0);
        const Trap trap(system, node, scale);
        CHECK(trap.radius() > 0.0);
        // The saddle lies beyond, along the slow direction: Newton from ever farther out, until it is met.
        const Eigen::EigenSolver<numerics::SmallMatrix> spectrum(node.monodromy);
        Eigen::Index slow = 0;
        spectrum.eigenvalues().cwiseAbs().maxCoeff(&slow);
        const numerics::SmallVector direction = spectrum.eigenvectors().col(slow).real().normalized();
        double separation = 0.0;
        for (double out = 1e-3; out < 0.3 && separation == 0.0; out *= 1.3) {
            for (const double sign : {1.0, -1.0}) {
                const numerics::SmallVector guess = orbit::to_vector(system, node.state) + sign * out * direction;
                const orbit::Orbit met = orbit::find_orbit(system, node.map, orbit::to_state(guess));
                if (met.ok() && orbit::max_multiplier(met) > 1.0 && node.map.phase == 0.0) {
                    CHECK_FALSE(trap.holds(met.state).has_value());
                    separation = std::max(separation, trap.distance(met.state));
                }
            }
        }
        if (omega > 2.55) {
            REQUIRE(separation > 0.0);
            CHECK(trap.radius() < separation);
        }
    }
}

TEST_CASE("a watch wants agreement for a whole period, and forgets what leaves") {
    const auto integrator = test::membranes();
    const flow::System system = system_at(*integrator, 1.78);
    const Trap trap(system, orbit::polish_orbit(system, test::reference_orbits[5].state, 3), scale);
    const std::vector<const Trap*> traps = {&trap};
    flow::State y = trap.points()[1];
    y[0] += 1e-4 * scale[0];
    attractor::Watch watch;
    int strobes = 0;
    std::optional<int> captured;
    while (!captured && strobes < 20) {
        captured = watch.see(y, traps);
        ++strobes;
        y = one_cycle(system, y);
    }
    CHECK(captured == 0);
    CHECK(strobes == 4);  // one to enter, three that agree
    // A state that stands still beside a strobe point is near, but does not agree.
    attractor::Watch idle;
    flow::State still = trap.points()[1];
    still[0] += 1e-4 * scale[0];
    for (int i = 0; i < 50; ++i) { CHECK_FALSE(idle.see(still, traps).has_value()); }
    // The strobe points in the wrong order neither.
    attractor::Watch backwards;
    for (int i = 30; i > 0; --i) { CHECK_FALSE(backwards.see(trap.points()[at(i % 3)], traps).has_value()); }
}

TEST_CASE("orbits found in different places are told apart and put together") {
    const auto integrator = test::membranes();
    const flow::System system = system_at(*integrator, 1.78);
    const attractor::Systems systems{system, system};
    const auto known = [&](flow::State state, int period, int later) {
        for (int i = 0; i < later; ++i) { state = one_cycle(system, state); }
        const auto orbit = attractor::stable_orbit(system, state, period);
        REQUIRE(orbit.has_value());
        return attractor::make_known(systems, *orbit, scale);
    };
    const flow::State one = {0.2943, -0.0392, 1.1815, 1.1923};
    const flow::State three = test::reference_orbits[5].state;
    const flow::State four = {0.3083, 0.0527, 1.1802, 1.1938};
    attractor::KnownOrbits all = {known(one, 1, 0)};
    CHECK(attractor::merge_into(all, {known(four, 4, 0), known(three, 3, 0)}) == std::vector<int>{1, 2});
    REQUIRE(all.size() == 3);
    CHECK(attractor::merge_into(all, {known(three, 3, 2), known(one, 1, 1), known(four, 4, 3)}) ==
          std::vector<int>{2, 0, 1});
    CHECK(attractor::merge_into(all, {known(three, 6, 1), known(one, 4, 0)}) == std::vector<int>{2, 0});  // multiples
    CHECK(all.size() == 3);
    CHECK(all[1]->orbit.map.period == 4);
    CHECK(all[2]->orbit.map.period == 3);
    // The same motion begins at the same strobe point, wherever it was met.
    CHECK(test::distance(known(three, 3, 1)->trap.points()[0], known(three, 3, 2)->trap.points()[0], 4) < 1e-9);
}

TEST_CASE("starts that come to rest on a stiff stop for a while are followed on") {
    // 43 bounces and more in one drive cycle, then captured by the orbit of one contact.
    const flow::ParameterVector p = {1.1,
                                     1.0,
                                     3.0,
                                     2.0,
                                     0.47977269636356429,
                                     321.73079918240154,
                                     0.8,
                                     0.015738030666405039,
                                     182971.47070625273,
                                     5.1005538916301818,
                                     0.17525032942320956,
                                     7.0,
                                     5.05094986034};
    const auto integrator = test::membranes(model::ContactLaw::no_tension);
    const auto loose = test::membranes(model::ContactLaw::no_tension, 1e-8);
    const flow::System system{integrator.get(), p, nullptr};
    const flow::System scout{loose.get(), p, nullptr};
    const orbit::Orbit struck =
        orbit::polish_orbit(system, {0.388683305148, -0.058715861610, 1.183740411669, 1.185843469999}, 1);
    REQUIRE(struck.ok());
    const flow::State bouncing = {0.40871791441221904, -0.067052746989810924, 1.1904021598637127, 1.1174580179251721};
    Box box{bouncing, bouncing};
    box.upper[0] += 1e-7;
    EnsembleOptions options;
    options.starts = 8;
    options.max_cycles = 4000;
    const auto answer = attractor::refute({system, scout}, struck, box, options);
    CHECK(answer.unclassified == 0);
    CHECK(answer.status == attractor::Refutation::Status::not_refuted);
}

TEST_CASE("the exponent of a periodic orbit is the logarithm of its multiplier") {
    const auto integrator = test::membranes();
    const struct {
        std::size_t reference;
        double tolerance;
    } cases[] = {{0, 1e-3}, {1, 1e-3}, {3, 1e-3}, {5, 1e-3}};
    for (const auto& each : cases) {
        const auto& reference = test::reference_orbits[each.reference];
        CAPTURE(reference.name);
        attractor::ExponentOptions options;
        options.transient = 500;  // the second multiplier is not much smaller
        options.cycles = 960;
        const Wander run = attractor::wander(system_at(*integrator, reference.omega), reference.state, options);
        REQUIRE(run.status == attractor::WanderStatus::ok);
        const double expected = std::log(reference.max_multiplier) / reference.period;
        CHECK(std::abs(run.exponent.value - expected) < each.tolerance);
        CHECK(run.exponent.negative());
        CHECK_FALSE(run.exponent.positive());
        CHECK(run.peak_force == doctest::Approx(reference.peak_force).epsilon(1e-8));
        CHECK(run.contacts_per_cycle * reference.period == doctest::Approx(reference.contacts));
        CHECK(run.strobes.size() == 960);
        CHECK_FALSE(attractor::measure(run).has_value());  // not an aperiodic motion
    }
    attractor::ExponentOptions wrong;
    wrong.batches = 1;
    CHECK_THROWS_AS(attractor::wander(system_at(*integrator, 1.9), test::reference_orbits[0].state, wrong),
                    std::invalid_argument);
    CHECK(Wander{}.status == attractor::WanderStatus::not_run);
}

TEST_CASE("chaos with a known exponent: Ueda's oscillator") {
    // x'' + 0.05 x' + x^3 = 7.5 cos t; largest exponent 0.1034 per unit of time (J. C. Sprott, Chaos and Time-Series
    // Analysis, Oxford 2003, appendix A).
    const flow::ParameterVector ueda = {0.05, 0.0, 1.0, 7.5, 0.0, 0.0, 0.0, 1.0};
    const auto exact_integrator = test::spring(model::ContactLaw::none);
    const auto scout_integrator = test::spring(model::ContactLaw::none, 1e-8);
    const flow::System exact{exact_integrator.get(), ueda, nullptr};
    const flow::System scout{scout_integrator.get(), ueda, nullptr};
    const Box box{{-4.0, -6.0}, {4.0, 6.0}};
    EnsembleOptions options;
    options.starts = 100;
    options.max_cycles = 300;
    options.jobs = 2;
    const Ensemble ensemble = attractor::find_attractors({exact, scout}, box, options);
    REQUIRE(ensemble.attractors.size() == 1);  // all starts are told to be on one and the same motion
    const attractor::Attractor& chaos = ensemble.attractors[0];
    CHECK(chaos.kind == Kind::chaotic);
    CHECK(chaos.period == 0);
    CHECK(chaos.starts == 100);
    CHECK(ensemble.unclassified == 0);
    CHECK(chaos.exponent.positive());
    CHECK(chaos.exponent.error / test::two_pi < 0.005);
    CHECK(std::abs(chaos.exponent.value / test::two_pi - 0.1034) < 1.5 * chaos.exponent.error / test::two_pi);

    // Two trajectories 1e-8 apart, brought back to that distance each cycle, know nothing of tangent vectors.
    constexpr double apart = 1e-8;
    flow::State a = chaos.state;
    flow::State b = a;
    b[0] += apart;
    double sum = 0.0;
    constexpr int skipped = 50;
    constexpr int cycles = 6000;
    for (int i = 0; i < cycles + skipped; ++i) {
        a = one_cycle(exact, a);
        b = one_cycle(exact, b);
        const double distance = std::hypot(b[0] - a[0], b[1] - a[1]);
        for (std::size_t k = 0; k < 2; ++k) { b[k] = a[k] + (b[k] - a[k]) * (apart / distance); }
        if (i >= skipped) { sum += std::log(distance / apart); }
    }
    CHECK(std::abs(sum / cycles - chaos.exponent.value) < 2.0 * chaos.exponent.error);
}

TEST_CASE("an impacting actuator in chaos, and what refutes an orbit there") {
    const auto exact_integrator = test::membranes();
    const auto scout_integrator = test::membranes(model::ContactLaw::kelvin_voigt, 1e-8);
    const flow::System exact = system_at(*exact_integrator, 1.7);
    const flow::System scout = system_at(*scout_integrator, 1.7);
    EnsembleOptions options;
    options.starts = 64;
    options.max_cycles = 400;
    const Box box = attractor::ensemble_box(exact, attractor::amplitude_to_expect(scout));
    const Ensemble ensemble = attractor::find_attractors({exact, scout}, box, options);
    REQUIRE(ensemble.attractors.size() == 1);
    CHECK(ensemble.attractors[0].kind == Kind::chaotic);
    CHECK(ensemble.attractors[0].exponent.value == doctest::Approx(0.4).epsilon(0.1));
    CHECK(ensemble.attractors[0].peak_force > 5.0);
    CHECK(ensemble.attractors[0].starts == 64);
}

TEST_CASE("a motion on a torus is quasi-periodic") {
    // The free motion with low losses, beyond its torus point near 1.79; a periodic motion coexists.
    flow::ParameterVector p = test::with(paper_defaults, model::membrane::voltage, 0.232);
    p[model::membrane::delta_a] = 0.022;
    p[model::membrane::delta_b] = 390.0;
    p[model::membrane::omega] = 1.785;
    const auto integrator = test::membranes(model::ContactLaw::none, 1e-10);
    const flow::System system{integrator.get(), p, nullptr};
    flow::State y = {0.9352, -0.0530, 1.2337, 1.2336};
    for (int i = 0; i < 500; ++i) { y = one_cycle(system, y); }
    const Wander run = attractor::wander(system, y);
    const auto motion = attractor::measure(run);
    REQUIRE(motion.has_value());
    CHECK(motion->kind == Kind::quasi_periodic);
    CHECK(std::abs(motion->exponent.value) < 0.005);
}

TEST_CASE("clouds tell sets apart") {
    const auto circle = [](double radius, double shift, int count, double turn) {
        std::vector<flow::State> points;
        for (int i = 0; i < count; ++i) {
            const double angle = turn * i;
            points.push_back({shift + radius * std::cos(angle), radius * std::sin(angle), 0.0, 0.0});
        }
        return points;
    };
    const double golden = test::pi * (3.0 - std::sqrt(5.0));  // fills a circle evenly
    const flow::State unit = {1.0, 1.0, 1.0, 1.0};
    const attractor::Cloud cloud(circle(1.0, 0.0, 1000, golden), unit, 2);
    CHECK(cloud.holds(circle(1.0, 0.0, 300, 1.0)));
    CHECK(cloud.holds(circle(1.0005, 0.0, 300, 0.7)));  // still settling on it
    CHECK_FALSE(cloud.holds(circle(1.05, 0.0, 300, 1.0)));
    CHECK_FALSE(cloud.holds(circle(1.0, 0.2, 300, 1.0)));
    CHECK_FALSE(cloud.holds({}));
    CHECK_FALSE(attractor::Cloud{}.holds(circle(1.0, 0.0, 10, 1.0)));
}
