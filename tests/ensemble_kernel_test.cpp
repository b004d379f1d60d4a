// Many starts at once, as SIMD lanes: they agree with one run after another, and none of them depends on its company.

#include "engine_cases.hpp"
#include "model/membrane/membrane.hpp"
#include "model/spring/spring.hpp"
#include "numerics/dual.hpp"

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <numeric>
#include <string>
#include <vector>

using namespace percuss;
using flow::EnsembleMember;
using flow::EnsembleRequest;
using flow::ParameterVector;
using flow::State;
using flow::Status;
using flow::StopMode;
using model::ContactLaw;
using test::at;
using test::paper_defaults;
using test::two_pi;

namespace {

struct Scene {
    std::string name;
    const model::Scene* kind = &model::spring::scene;
    ContactLaw law = ContactLaw::kelvin_voigt;
    ParameterVector p{};
    double cycles = 2.0;
    StopMode stop = StopMode::hybrid;
    int least_contacts = 1;  ///< over all starts
};

constexpr const model::Scene* membranes = &model::membrane::viscous;
constexpr const model::Scene* elastic_membranes = &model::membrane::elastic;
constexpr const model::Scene* spring = &model::spring::scene;
const ParameterVector impacting = test::with(paper_defaults, model::membrane::omega, 1.78);
const ParameterVector elastic = test::with(impacting, model::membrane::mu_ratio, 0.0);
// c k1 k3 F gap k delta_i omega: slow drive, so that the mass strikes several times a period
const ParameterVector rattling = {0.1, 1.0, 0.3, 2.0, 0.4, 200.0, 1.0, 0.3};
const ParameterVector undamped_stop = test::with(rattling, model::spring::stop_damping, 0.0);
const ParameterVector overdamped_stop = test::with(rattling, model::spring::stop_damping, 40.0);

const std::vector<Scene> scenes = {
    {"membranes", membranes, ContactLaw::kelvin_voigt, impacting, 2.0, StopMode::hybrid, 30},
    {"membranes at the reference frequency", membranes, ContactLaw::kelvin_voigt, paper_defaults, 1.3},
    {"membranes, no tension", membranes, ContactLaw::no_tension, impacting, 2.0, StopMode::hybrid, 30},
    {"membranes, no stop", membranes, ContactLaw::none, impacting, 2.0, StopMode::hybrid, 0},
    {"membranes, stop off", membranes, ContactLaw::kelvin_voigt, impacting, 2.0, StopMode::off, 0},
    {"membranes, stop held", membranes, ContactLaw::kelvin_voigt, impacting, 0.05, StopMode::held, 0},
    {"elastic membranes", elastic_membranes, ContactLaw::kelvin_voigt, elastic, 2.0, StopMode::hybrid, 30},
    {"elastic membranes, no tension", elastic_membranes, ContactLaw::no_tension, elastic, 2.0, StopMode::hybrid, 30},
    {"spring", spring, ContactLaw::kelvin_voigt, rattling, 2.0, StopMode::hybrid, 150},
    {"spring, no tension", spring, ContactLaw::no_tension, rattling, 2.0, StopMode::hybrid, 150},
    {"spring, no tension, overdamped", spring, ContactLaw::no_tension, overdamped_stop, 2.0, StopMode::hybrid, 30},
    {"spring, no tension, undamped", spring, ContactLaw::no_tension, undamped_stop, 2.0, StopMode::hybrid, 150},
    {"spring, undamped", spring, ContactLaw::kelvin_voigt, undamped_stop, 2.0, StopMode::hybrid, 150},
    {"spring, no stop", spring, ContactLaw::none, rattling, 2.0, StopMode::hybrid, 0},
    {"spring, stop off", spring, ContactLaw::kelvin_voigt, rattling, 2.0, StopMode::off, 0},
};

std::unique_ptr<flow::Integrator> integrator(const Scene& scene, double tolerance = 1e-13,
                                             std::string_view set = "auto") {
    kernels::IntegratorOptions options;
    options.tolerance = tolerance;
    options.instruction_set = set;
    return kernels::make_integrator(*scene.kind, scene.law, options);
}

/// Points about rest, some of them inside the stop.
std::vector<State> starts(const Scene& scene, std::size_t count, std::uint64_t seed = 1) {
    test::Random random(seed);
    std::vector<State> list(count);
    for (State& y : list) {
        if (scene.kind != spring) {
            y = {random.uniform(0.3, 0.51), random.uniform(-0.3, 0.3), 0.0, 0.0};
            if (scene.kind == membranes) {
                y[2] = random.uniform(1.16, 1.21);
                y[3] = random.uniform(1.16, 1.21);
            }
        } else {
            y = {random.uniform(-0.5, 0.45), random.uniform(-1.0, 1.0)};
        }
    }
    return list;
}

EnsembleRequest request_for(const Scene& scene, const std::vector<State>& list) {
    EnsembleRequest request;
    request.states = list;
    request.theta = 0.7;
    request.duration = two_pi * scene.cycles;
    request.stop = scene.stop;
    return request;
}

std::vector<EnsembleMember> in_lanes(const flow::Integrator& engine, const ParameterVector& p,
                                     const EnsembleRequest& request) {
    std::vector<EnsembleMember> members(request.states.size());
    engine.run_ensemble(p, request, members);
    return members;
}
std::vector<EnsembleMember> one_by_one(const flow::Integrator& engine, const ParameterVector& p,
                                       const EnsembleRequest& request) {
    std::vector<EnsembleMember> members(request.states.size());
    engine.flow::Integrator::run_ensemble(p, request, members);
    return members;
}

bool same_bits(const EnsembleMember& a, const EnsembleMember& b) {
    return a.status == b.status && a.contacts == b.contacts &&
           std::memcmp(a.state.data(), b.state.data(), sizeof a.state) == 0;
}

/// Largest difference relative to the larger of the entry and one, which is what the integrator controls.
double relative_distance(const State& a, const State& b) {
    double largest = 0.0;
    for (std::size_t k = 0; k < a.size(); ++k) {
        const double d = std::abs(a[k] - b[k]) / std::max(1.0, std::abs(a[k]));
        if (!(d <= largest)) { largest = d; }  // NaN stays
    }
    return largest;
}

/// Both ways do the same arithmetic in another order: a few units in the last place (1e-16) per step, some tens of
/// steps per cycle. A blow multiplies what is there by about 5, an undamped stop (k = 200) by up to 20; starts of these
/// tests see up to ten blows. Measured: below 1e-13 for membranes, up to 5e-12 at the undamped stops.
constexpr double rounding = 5e-11;

void check_agree(const std::vector<EnsembleMember>& lanes, const std::vector<EnsembleMember>& single,
                 double apart = rounding) {
    REQUIRE(lanes.size() == single.size());
    for (std::size_t i = 0; i < lanes.size(); ++i) {
        CAPTURE(i);
        CHECK(lanes[i].status == single[i].status);
        CHECK(lanes[i].contacts == single[i].contacts);
        if (single[i].status != Status::diverged) { CHECK(relative_distance(lanes[i].state, single[i].state) < apart); }
    }
}

}  // namespace

TEST_CASE("lanes agree with one run after another: all models, laws and instruction sets") {
    for (const Scene& scene : scenes) {
        CAPTURE(scene.name);
        const std::vector<State> list = starts(scene, 29);
        const EnsembleRequest request = request_for(scene, list);
        for (const std::string_view set : kernels::instruction_sets()) {
            CAPTURE(set);
            for (double tolerance : {1e-13, 1e-8}) {
                CAPTURE(tolerance);
                const auto engine = integrator(scene, tolerance, set);
                const auto lanes = in_lanes(*engine, scene.p, request);
                check_agree(lanes, one_by_one(*engine, scene.p, request));
                int contacts = 0;
                for (const EnsembleMember& member : lanes) {
                    CHECK(member.status == Status::ok);
                    contacts += member.contacts;
                }
                CHECK(contacts >= scene.least_contacts);
            }
        }
    }
}

TEST_CASE("the bits of a start depend on nothing but the start") {
    for (const Scene& scene : {scenes[0], scenes[2], scenes[6], scenes[9]}) {
        CAPTURE(scene.name);
        for (const std::string_view set : kernels::instruction_sets()) {
            CAPTURE(set);
            const auto engine = integrator(scene, 1e-10, set);
            std::vector<State> list = starts(scene, 513);
            list[5][1] = std::nan("");
            list[77] = {1e7, 1e7, -1.0, 1e-9};  // far outside every model
            const auto all = in_lanes(*engine, scene.p, request_for(scene, list));
            CHECK(all[5].status == Status::diverged);
            CHECK(all[77].status == Status::diverged);
            CHECK(all[512].status == Status::ok);

            // other neighbours, other lanes
            std::vector<std::size_t> order(list.size());
            std::iota(order.begin(), order.end(), std::size_t{0});
            test::Random random(3);
            for (std::size_t i = order.size() - 1; i > 0; --i) {
                std::swap(order[i], order[static_cast<std::size_t>(random.uniform(0.0, static_cast<double>(i)))]);
            }
            std::vector<State> shuffled;
            for (std::size_t i : order) { shuffled.push_back(list[i]); }
            const auto other = in_lanes(*engine, scene.p, request_for(scene, shuffled));
            std::size_t equal = 0;
            for (std::size_t i = 0; i < order.size(); ++i) { equal += same_bits(other[i], all[order[i]]) ? 1U : 0U; }
            CHECK(equal == list.size());

            // fewer of them
            for (const std::size_t count : {0U, 1U, 7U, 8U, 9U, 100U}) {
                CAPTURE(count);
                const std::vector<State> few(list.end() - static_cast<std::ptrdiff_t>(count), list.end());
                const auto members = in_lanes(*engine, scene.p, request_for(scene, few));
                REQUIRE(members.size() == count);
                for (std::size_t i = 0; i < count; ++i) { CHECK(same_bits(members[i], all[list.size() - count + i])); }
            }
        }
    }
}

TEST_CASE("long runs: several hundred cycles end on the same attractor, at the same place") {
    // Stable orbits, which forget rounding errors; the one at omega = 3 is free, the one at 1.9 strikes once a cycle.
    for (double omega : {3.0, 1.9}) {
        CAPTURE(omega);
        const ParameterVector p = test::with(paper_defaults, model::membrane::omega, omega);
        Scene scene = scenes[0];
        scene.cycles = 300.0;
        std::vector<State> list = starts(scene, 9);
        for (State& y : list) { y[0] = std::min(y[0], 0.45); }
        EnsembleRequest request = request_for(scene, list);
        request.max_events = 4000;
        const auto engine = integrator(scene, 1e-10);
        check_agree(in_lanes(*engine, p, request), one_by_one(*engine, p, request));
    }
    // Phases of some thousand radians, and a contraction too weak to forget: the error of the angle grows with it.
    Scene scene = scenes[7];
    scene.kind = spring;
    scene.law = ContactLaw::none;
    scene.cycles = 600.0;
    const ParameterVector linear = {0.0005, 1.0, 0.01, 0.01, 10.0, 1.0, 0.0, 1.3};
    const std::vector<State> list = starts(scene, 11);
    const auto engine = integrator(scene);
    const EnsembleRequest request = request_for(scene, list);
    check_agree(in_lanes(*engine, linear, request), one_by_one(*engine, linear, request));
}

TEST_CASE("caps and failures have the same status as in a run, and leave the neighbours alone") {
    const Scene& chatter = scenes[8];
    const std::vector<State> list = starts(chatter, 21);
    const auto engine = integrator(chatter);
    EnsembleRequest request = request_for(chatter, list);
    auto lanes = in_lanes(*engine, chatter.p, request);
    std::vector<int> contacts;
    for (const EnsembleMember& member : lanes) { contacts.push_back(member.contacts); }
    std::nth_element(contacts.begin(), contacts.begin() + 10, contacts.end());
    request.max_events = 2 * contacts[10];  // about half of the starts need more
    lanes = in_lanes(*engine, chatter.p, request);
    check_agree(lanes, one_by_one(*engine, chatter.p, request));
    const auto count = [&](Status status) {
        return std::count_if(lanes.begin(), lanes.end(), [&](const EnsembleMember& m) { return m.status == status; });
    };
    CHECK(count(Status::too_many_events) >= 3);
    CHECK(count(Status::ok) >= 3);

    request = request_for(chatter, list);
    const flow::Result first = [&] {
        flow::Request one;
        one.state = list[0];
        one.theta = request.theta;
        one.duration = request.duration;
        return test::run(*engine, chatter.p, one);
    }();
    for (long steps : {1L, 17L, first.steps - 1, first.steps, first.steps + 1}) {
        CAPTURE(steps);
        request.max_steps = steps;
        lanes = in_lanes(*engine, chatter.p, request);
        check_agree(lanes, one_by_one(*engine, chatter.p, request));
        CHECK(lanes[0].status == (steps < first.steps ? Status::too_many_steps : Status::ok));
    }

    // A softening spring: beyond its top it runs away.
    const ParameterVector runaway = {0.1, 1.0, -0.5, 0.1, 10.0, 100.0, 0.0, 1.0};
    std::vector<State> mixed(20);
    for (std::size_t i = 0; i < mixed.size(); ++i) { mixed[i] = {0.2 * static_cast<double>(i), 0.1}; }
    mixed[4][0] = std::nan("");
    mixed[6][1] = std::numeric_limits<double>::infinity();
    request = {};
    request.states = mixed;
    request.duration = 50.0;
    lanes = in_lanes(*engine, runaway, request);
    check_agree(lanes, one_by_one(*engine, runaway, request));
    CHECK(count(Status::diverged) >= 8);
    CHECK(count(Status::ok) >= 5);

    // A stretch that has no logarithm.
    const Scene& scene = scenes[0];
    std::vector<State> broken = starts(scene, 10);
    broken[3][2] = -1.0;
    broken[8][3] = 0.0;
    const auto dea = integrator(scene);
    lanes = in_lanes(*dea, scene.p, request_for(scene, broken));
    check_agree(lanes, one_by_one(*dea, scene.p, request_for(scene, broken)));
    CHECK(lanes[3].status == Status::diverged);
    CHECK(lanes[8].status == Status::diverged);
    CHECK(count(Status::ok) == 8);
}

TEST_CASE("nothing to do is done, and misuse is refused") {
    const Scene& scene = scenes[0];
    const auto engine = integrator(scene);
    const std::vector<State> list = starts(scene, 3);
    EnsembleRequest request = request_for(scene, list);
    request.duration = 0.0;
    const auto still = in_lanes(*engine, scene.p, request);
    for (std::size_t i = 0; i < list.size(); ++i) {
        CHECK(still[i].status == Status::ok);
        CHECK(still[i].contacts == 0);
        CHECK(test::distance(still[i].state, list[i], 4) < 1e-15);
    }
    request.states = {};
    CHECK(in_lanes(*engine, scene.p, request).empty());

    std::vector<EnsembleMember> members(2);
    request = request_for(scene, list);
    CHECK_THROWS_AS(engine->run_ensemble(scene.p, request, members), std::invalid_argument);
    CHECK_THROWS_AS(engine->flow::Integrator::run_ensemble(scene.p, request, members), std::invalid_argument);
    members.resize(3);
    for (double duration : {-1.0, std::nan("")}) {
        request.duration = duration;
        CHECK_THROWS_AS(engine->run_ensemble(scene.p, request, members), std::invalid_argument);
        CHECK_THROWS_AS(engine->flow::Integrator::run_ensemble(scene.p, request, members), std::invalid_argument);
    }
}
