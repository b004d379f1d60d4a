// Sensitivity lanes through entry, exit, release and reload against differences of plain runs.

#include "engine_cases.hpp"
#include "model/membrane/membrane.hpp"
#include "model/spring/spring.hpp"
#include "relative.hpp"

#include <doctest/doctest.h>

#include <cmath>
#include <string>
#include <vector>

using namespace percuss;
using flow::Direction;
using flow::ParameterVector;
using flow::Status;
using model::ContactLaw;
using test::at;
using test::membranes;
using test::paper_defaults;

namespace {

struct Case {
    std::string name;
    const flow::Integrator* integrator;
    ParameterVector p{};
    flow::Request request;
    std::size_t contacts = 0;  ///< that the run must meet
};

/// Every way in which a run can be moved, with the size of a harmless move.
struct Move {
    std::string name;
    Direction direction;
    double size;
};
std::vector<Move> moves(const Case& c) {
    const flow::SystemInfo& info = c.integrator->info();
    std::vector<Move> all;
    for (int i = 0; i < info.states; ++i) {
        Move move{"state " + std::to_string(i), {}, 1.0};
        move.direction.state[at(i)] = 1.0;
        all.push_back(move);
    }
    for (int i = 0; i < info.parameters; ++i) {
        if (c.p[at(i)] == 0.0) { continue; }  // switched off: another kernel or a one-sided range
        Move move{std::string(info.names[at(i)]), {}, std::max(0.05, std::abs(c.p[at(i)]))};
        move.direction.parameter[at(i)] = 1.0;
        all.push_back(move);
    }
    Move phase{"phase", {}, 1.0};
    phase.direction.phase = 1.0;
    all.push_back(phase);
    return all;
}

flow::Result moved_run(const Case& c, const Move& move, double amount) {
    flow::Request request = c.request;
    ParameterVector p = c.p;
    for (std::size_t i = 0; i < p.size(); ++i) { p[i] += amount * move.direction.parameter[i]; }
    for (std::size_t i = 0; i < request.state.size(); ++i) { request.state[i] += amount * move.direction.state[i]; }
    request.theta += amount * move.direction.phase;
    return test::run(*c.integrator, p, request);
}

std::vector<std::string> component_names(const Case& c) {
    std::vector<std::string> names;
    for (int k = 0; k < c.integrator->info().states; ++k) { names.push_back("end state " + std::to_string(k)); }
    for (const auto& [name, member] : test::observables) { names.emplace_back(name); }
    names.emplace_back("divided_gap");
    names.emplace_back("divided_force");
    return names;
}
std::vector<double> components(const Case& c, const flow::Result& result) {
    std::vector<double> all;
    for (int k = 0; k < c.integrator->info().states; ++k) { all.push_back(result.state[at(k)]); }
    for (const auto& [name, member] : test::observables) { all.push_back(member(result.observables).value); }
    all.push_back(result.divided_gap.value);
    all.push_back(result.divided_force.value);
    return all;
}
std::vector<double> lanes_of(const Case& c, const flow::Result& result, std::size_t lane) {
    std::vector<double> all;
    for (int k = 0; k < c.integrator->info().states; ++k) { all.push_back(result.state_d[at(k)][lane]); }
    for (const auto& [name, member] : test::observables) { all.push_back(member(result.observables).d[lane]); }
    all.push_back(result.divided_gap.d[lane]);
    all.push_back(result.divided_force.d[lane]);
    return all;
}

/// The lane of each direction against Ridders' differences. The reference must itself be good to 1e-6 of the size of
/// the quantity over the size of the move (or of the derivative); the lane must then agree within ten times what the
/// reference is uncertain by, plus `agreement` of that size: the runs' own
/// rounding, 1e-16 of displacements times the stop's stiffness over steps of 6e-6, does not show in the estimate.
void check_case(Case c, double agreement = 3e-8) {
    INFO(c.name);
    c.request.observe = flow::observe_all;
    const flow::Result base = test::run(*c.integrator, c.p, c.request);
    REQUIRE(base.status == Status::ok);
    REQUIRE(base.contacts.size() == c.contacts);
    const std::vector<Move> all = moves(c);
    const std::vector<std::string> names = component_names(c);
    const std::vector<double> values = components(c, base);
    for (std::size_t first = 0; first < all.size(); first += flow::max_lanes) {
        const std::size_t count = std::min<std::size_t>(flow::max_lanes, all.size() - first);
        std::vector<Direction> directions;
        for (std::size_t i = 0; i < count; ++i) { directions.push_back(all[first + i].direction); }
        flow::Request request = c.request;
        request.directions = directions;
        const flow::Result exact = test::run(*c.integrator, c.p, request);
        REQUIRE(exact.status == Status::ok);
        for (std::size_t i = 0; i < count; ++i) {
            const Move& move = all[first + i];
            const auto numeric = test::ridders_many(
                [&](double amount) {
                    const flow::Result r = moved_run(c, move, amount);
                    REQUIRE(r.contacts.size() == base.contacts.size());
                    return components(c, r);
                },
                names.size(), 4e-4 * move.size, 7);
            const std::vector<double> lanes = lanes_of(c, exact, i);
            for (std::size_t k = 0; k < names.size(); ++k) {
                INFO(names[k], " by ", move.name);
                CAPTURE(lanes[k]);
                CAPTURE(numeric[k].value);
                CAPTURE(numeric[k].error);
                const double size = std::abs(lanes[k]) + std::abs(values[k]) / move.size + 1e-3;
                CHECK(numeric[k].error < 1e-6 * size);
                CHECK(std::abs(lanes[k] - numeric[k].value) < 10.0 * numeric[k].error + agreement * size);
            }
        }
    }
}

flow::Request request_from(flow::State state, double theta, double duration) {
    flow::Request request;
    request.state = state;
    request.theta = theta;
    request.duration = duration;
    return request;
}

constexpr flow::State near_orbit = {0.283, -0.05, 1.178, 1.196};
const ParameterVector other_membranes = {1.15, 0.7, 2.7, 2.4, 0.2, 45.0, 0.75, 0.08, 1500.0, 1.5, 0.45, 2.0, 2.6};
const ParameterVector spring_parameters = {0.1, 1.0, 0.3, 0.5, 0.4, 200.0, 1.5, 1.1};

// The formulas are checked with the order that belongs to 1e-16, where derivative parts of the series, which stop four
// orders early, lose nothing.
constexpr double tight = 1e-16;

}  // namespace

TEST_CASE("membranes, kelvin-voigt: through entry and exit, with one open end, with both, several contacts") {
    const auto integrator = membranes(ContactLaw::kelvin_voigt, tight);
    check_case({"entry and exit", integrator.get(), paper_defaults, request_from(near_orbit, 0.0, test::two_pi), 1});
    check_case({"from another phase", integrator.get(), paper_defaults,
                request_from({0.45, 0.21, 1.179, 1.195}, 3.1, 2.0), 1});
    check_case({"ends in contact", integrator.get(), paper_defaults, request_from(near_orbit, 0.0, 3.42), 1});
    check_case({"starts in contact", integrator.get(), paper_defaults,
                request_from({0.5012, 0.05, 1.178, 1.196}, 3.4, 1.0), 1});
    check_case({"in contact throughout", integrator.get(), paper_defaults,
                request_from({0.5012, 0.05, 1.178, 1.196}, 3.4, 0.05), 1});
    check_case(
        {"three contacts", integrator.get(), paper_defaults, request_from(near_orbit, 0.0, 3.0 * test::two_pi), 3});
    check_case({"other exponents", integrator.get(), other_membranes,
                request_from({0.3, -0.1, 1.2, 1.25}, 0.0, test::two_pi), 1});
    check_case({"no contact", integrator.get(), paper_defaults, request_from({0.42, 0.02, 1.18, 1.19}, 0.5, 2.0), 0});
}

TEST_CASE("membranes, no-tension: release by force") {
    const auto integrator = membranes(ContactLaw::no_tension, tight);
    check_case(
        {"entry, release, leaving", integrator.get(), paper_defaults, request_from(near_orbit, 0.0, test::two_pi), 1});
    check_case({"ends in contact", integrator.get(), paper_defaults, request_from(near_orbit, 0.0, 3.42), 1});
    check_case({"starts in contact", integrator.get(), paper_defaults,
                request_from({0.5012, 0.05, 1.178, 1.196}, 3.4, 1.0), 1});
    check_case({"strongly damped", integrator.get(), test::with(paper_defaults, model::membrane::damping, 40.0),
                request_from(near_orbit, 0.0, test::two_pi), 1});
}

TEST_CASE("membranes without Maxwell branches, without a stop, held, backwards") {
    const auto elastic = membranes(ContactLaw::kelvin_voigt, tight, false);
    const ParameterVector none = test::with(paper_defaults, model::membrane::mu_ratio, 0.0);
    check_case({"elastic", elastic.get(), none, request_from({0.4, 0.35}, 0.0, 2.0), 1});
    const auto free = membranes(ContactLaw::none, tight);
    check_case({"no stop", free.get(), paper_defaults, request_from(near_orbit, 0.0, test::two_pi), 0});
    const auto integrator = membranes(ContactLaw::kelvin_voigt, tight);
    flow::Request request = request_from(near_orbit, 0.0, test::two_pi);
    request.stop = flow::StopMode::off;
    check_case({"stop off", integrator.get(), paper_defaults, request, 0});
    request.duration = -1.5;
    check_case({"stop off, backwards", integrator.get(), paper_defaults, request, 0});
    request = request_from({0.5, 0.1, 1.178, 1.196}, 3.36, 0.12);
    request.stop = flow::StopMode::held;
    check_case({"held", integrator.get(), paper_defaults, request, 1});
    request.duration = 0.02;
    check_case({"held for a single step", integrator.get(), paper_defaults, request, 1});
    request.state[0] = 0.5007;
    check_case({"held, from inside", integrator.get(), paper_defaults, request, 1});
    request.duration = -0.02;
    check_case({"held, backwards", integrator.get(), paper_defaults, request, 1});
}

TEST_CASE("spring and mass: all laws") {
    const auto kelvin = test::spring(ContactLaw::kelvin_voigt, tight);
    check_case({"kelvin-voigt", kelvin.get(), spring_parameters, request_from({0.0, 0.6}, 0.0, 4.0), 1});
    check_case({"ends in contact", kelvin.get(), spring_parameters, request_from({0.3, 0.6}, 0.0, 0.25), 1});
    check_case({"several contacts", kelvin.get(), spring_parameters, request_from({0.0, 0.6}, 0.0, 14.0), 3});
    // Shortly before release the damper pulls hardest: the largest acceleration is that just before the event.
    check_case({"released", kelvin.get(), test::with(spring_parameters, model::spring::stop_damping, 5.0),
                request_from({0.402, -0.7}, 0.0, 0.5), 1});
    const auto no_tension = test::spring(ContactLaw::no_tension, tight);
    check_case({"no-tension", no_tension.get(), spring_parameters, request_from({0.0, 0.6}, 0.0, 4.0), 1});
    const ParameterVector undamped = test::with(spring_parameters, model::spring::stop_damping, 0.0);
    check_case({"no-tension, no damping", no_tension.get(), undamped, request_from({0.0, 0.6}, 0.0, 4.0), 1});
    // Left and met again inside the stop: soft, strongly damped.
    const ParameterVector deep = {0.05, 1.0, 0.0, 3.0, 0.1, 1.0, 15.0, 0.8};
    check_case({"reload", no_tension.get(), deep, request_from({0.4, -0.5}, 0.2, 3.0), 1});
    const auto none = test::spring(ContactLaw::none, tight);
    check_case({"none", none.get(), spring_parameters, request_from({0.0, 0.6}, 0.0, 6.0), 0});
}

TEST_CASE("the stop's own parameters act through the saltation alone while it is not touched again") {
    // Entry just before the end of the run: what the gap does to the end state is the saltation matrix, in closed form:
    // S = I - delta_i e_v e_x^T for fixed times, so moving the stop by dg changes v by + delta_i dg (first order in the
    // time since entry).
    const auto integrator = test::spring(ContactLaw::kelvin_voigt, tight);
    flow::Request request = request_from({0.3999, 0.6}, 0.0, 1.1 * 2e-4);
    Direction gap;
    gap.parameter[model::spring::gap] = 1.0;
    Direction x;
    x.state[0] = 1.0;
    const std::vector<Direction> directions = {gap, x};
    request.directions = directions;
    const flow::Result result = test::run(*integrator, spring_parameters, request);
    REQUIRE(result.contacts.size() == 1);
    const double delta = spring_parameters[model::spring::stop_damping];
    // 2e-4 of tau at stiffness 200 moves these by at most 200 * 2e-4 = 0.04, and exactly so to first order.
    const double since = (request.duration - result.contacts[0].theta_in) / 1.1;
    CHECK(result.state_d[1][0] == test::relative(delta + 200.0 * since, 1e-3));
    CHECK(result.state_d[1][1] == test::relative(-delta - 200.0 * since - 1.0 * 2e-4, 1e-3));
    CHECK(result.state_d[0][1] == test::relative(1.0, 1e-3));
}

TEST_CASE("at the default tolerance the lanes are good to seven digits at least, to the full order to eight") {
    const auto kelvin = membranes();
    const auto spring = test::spring();
    for (const bool full : {false, true}) {
        CAPTURE(full);
        // Derivative parts of order 13 instead of 17: up to 5e-9 was seen, in the duration of a contact.
        const double agreement = full ? 3e-8 : 1e-7;
        flow::Request request = request_from(near_orbit, 0.0, test::two_pi);
        request.full_derivatives = full;
        check_case({"membranes", kelvin.get(), paper_defaults, request, 1}, agreement);
        request = request_from({0.0, 0.6}, 0.0, 14.0);
        request.full_derivatives = full;
        check_case({"spring", spring.get(), spring_parameters, request, 3}, agreement);
    }
}
