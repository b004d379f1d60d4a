// Derivatives of end states and of every observable: against differences of the integrator itself, and of one backend
// against the other.

#include "model/membrane/membrane.hpp"
#include "sundials_cases.hpp"

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <span>
#include <string>
#include <vector>

using namespace percuss;
using flow::Direction;
using flow::Result;
using flow::Status;
using test::at;
using test::Case;
using test::two_pi;

namespace {

/// A transient through two contacts, starting and ending in flight at arbitrary phases.
Case transient() {
    Case c{test::paper_defaults, {}};
    c.request.state = test::paper_orbit;
    c.request.state[0] += 0.004;
    c.request.theta = 0.3;
    c.request.duration = 1.7 * two_pi;
    c.request.observe = flow::observe_all;
    return c;
}

Case transient_with(double k, double delta) {
    Case c = transient();
    c.parameters[model::membrane::stiffness] = k;
    c.parameters[model::membrane::damping] = delta;
    return c;
}

/// Soft, strongly damped no-tension stop: the mass comes free of the force inside the zone and meets it again there.
Case reloading() {
    Case c{{0.1, 1.0, 0.2, 1.0, 0.05, 3.0, 10.0, 0.5}, {}};
    c.request.duration = 3.0 * two_pi;
    c.request.observe = flow::observe_all;
    return c;
}

/// All results of a run that have derivatives, by name.
struct Output {
    std::string name;
    std::function<flow::Sensitive(const Result&)> read;
};
std::vector<Output> outputs(int states, bool held) {
    std::vector<Output> list;
    for (const test::NamedObservable& o : test::observables) {
        list.push_back({std::string(o.name), [o](const Result& r) { return o.member(r.observables); }});
    }
    for (int i = 0; i < states; ++i) {
        list.push_back({"state " + std::to_string(i), [i](const Result& r) {
                            return flow::Sensitive{r.state[at(i)], r.state_d[at(i)]};
                        }});
    }
    if (held) {
        list.push_back({"divided gap", [](const Result& r) { return r.divided_gap; }});
        list.push_back({"divided force", [](const Result& r) { return r.divided_force; }});
    }
    return list;
}

struct Block {
    std::size_t first = 0;
    Result result;
};
/// Runs with all directions, eight at a time.
std::vector<Block> differentiate(const flow::Integrator& integrator, Case c, const std::vector<Direction>& directions) {
    std::vector<Block> blocks;
    for (std::size_t first = 0; first < directions.size(); first += flow::max_lanes) {
        const std::size_t count = std::min<std::size_t>(flow::max_lanes, directions.size() - first);
        c.request.directions = {directions.data() + first, count};
        blocks.push_back({first, test::run(integrator, c)});
    }
    return blocks;
}

/// Fourth-order central differences with relative steps of 2e-5: the rounding and local errors of a run at tolerance
/// 1e-13 give about 1e-13 / 2e-5; truncation is far below.
void check_against_differences(const flow::Integrator& integrator, const Case& c, double tolerance) {
    const auto directions = test::all_directions(integrator.info());
    const auto list = outputs(integrator.info().states, c.request.stop == flow::StopMode::held);
    for (const Block& block : differentiate(integrator, c, directions)) {
        REQUIRE(block.result.status == Status::ok);
        for (std::size_t j = block.first; j < std::min(block.first + flow::max_lanes, directions.size()); ++j) {
            CAPTURE(j);
            const double size = test::size_along(c, directions[j]);
            const double h = 2e-5 * size;
            const auto off = [&](double steps) {
                return test::run(integrator, test::moved(c, directions[j], steps * h));
            };
            const Result far_below = off(-2.0);
            const Result below = off(-1.0);
            const Result above = off(1.0);
            const Result far_above = off(2.0);
            for (const Output& output : list) {
                CAPTURE(output.name);
                const auto value = [&](const Result& r) { return output.read(r).value; };
                const double numeric =
                    (8.0 * (value(above) - value(below)) - (value(far_above) - value(far_below))) / (12.0 * h);
                const flow::Sensitive found = output.read(block.result);
                const double exact = found.d[j - block.first];
                const double scale = std::max({std::abs(exact), std::abs(found.value) / size, 1e-3});
                CHECK(std::abs(exact - numeric) < tolerance * scale);
            }
        }
    }
}

void check_agreement(const flow::Integrator& a, const flow::Integrator& b, const Case& c, double tolerance) {
    const auto directions = test::all_directions(a.info());
    const auto list = outputs(a.info().states, c.request.stop == flow::StopMode::held);
    const auto from_a = differentiate(a, c, directions);
    const auto from_b = differentiate(b, c, directions);
    for (std::size_t i = 0; i < from_a.size(); ++i) {
        REQUIRE(from_a[i].result.status == Status::ok);
        REQUIRE(from_b[i].result.status == Status::ok);
        REQUIRE(from_a[i].result.contacts.size() == from_b[i].result.contacts.size());
        for (const Output& output : list) {
            CAPTURE(output.name);
            const flow::Sensitive one = output.read(from_a[i].result);
            const flow::Sensitive other = output.read(from_b[i].result);
            CHECK(std::abs(one.value - other.value) < tolerance * std::max(std::abs(one.value), 1e-2));
            for (std::size_t lane = 0; lane < one.d.size(); ++lane) {
                CHECK(std::abs(one.d[lane] - other.d[lane]) <
                      tolerance * std::max({std::abs(one.d[lane]), std::abs(one.value), 1e-2}));
            }
        }
    }
}

}  // namespace

TEST_CASE("gradients of a transient through two contacts, both stop laws") {
    for (const auto law : {model::ContactLaw::kelvin_voigt, model::ContactLaw::no_tension}) {
        const auto erk = flow::make_erk(test::membranes(law), 1e-13);
        const Result result = test::run(*erk, transient());
        REQUIRE(result.contacts.size() == 2);
        const auto [low, high] = std::minmax(result.contacts[0].peak_force, result.contacts[1].peak_force);
        CHECK(result.observables.peak_force.value == high);
        CHECK(result.observables.runner_up_force == low);
        check_against_differences(*erk, transient(), 1e-7);
    }
}

TEST_CASE("gradients where the peak force is the jump at entry and the peak acceleration sits at the event") {
    const auto erk = flow::make_erk(test::membranes(), 1e-13);
    const Case c = transient_with(2500.0, 120.0);
    const Result result = test::run(*erk, c);
    const auto hardest = std::max_element(result.contacts.begin(), result.contacts.end(),
                                          [](const auto& a, const auto& b) { return a.peak_force < b.peak_force; });
    CHECK(result.observables.theta_peak_force == hardest->theta_in);
    CHECK(result.observables.peak_force.value == doctest::Approx(120.0 * hardest->state_in[1]).epsilon(1e-14));
    check_against_differences(*erk, c, 3e-7);
}

TEST_CASE("gradients through release and renewed contact inside the zone") {
    const auto erk = flow::make_erk(test::spring(model::ContactLaw::no_tension), 1e-13);
    const Result result = test::run(*erk, reloading());
    const auto renewed = std::count_if(result.contacts.begin(), result.contacts.end(),
                                       [](const flow::Contact& k) { return k.state_in[0] > 0.05 + 1e-6; });
    REQUIRE(renewed == 3);
    check_against_differences(*erk, reloading(), 1e-7);
}

TEST_CASE("gradients of held and free runs, forwards and backwards") {
    const auto erk = flow::make_erk(test::membranes(), 1e-13);
    for (const auto stop : {flow::StopMode::held, flow::StopMode::off}) {
        for (const double duration : {0.9, -0.9}) {
            CAPTURE(duration);
            Case c = transient();
            c.request.state = {0.505, 0.08, 1.18, 1.19};
            c.request.stop = stop;
            c.request.duration = duration;
            check_against_differences(*erk, c, 3e-7);
        }
    }
}

TEST_CASE("gradients of a run that starts inside the stop and one that has just entered") {
    const auto erk = flow::make_erk(test::membranes(), 1e-13);
    Case inside = transient();
    inside.request.state = {0.504, 0.05, 1.18, 1.19};
    inside.request.duration = 2.0;
    const Result result = test::run(*erk, inside);
    REQUIRE(result.contacts.size() == 1);
    CHECK(result.contacts.front().open_in);
    CHECK_FALSE(result.contacts.front().open_out);
    check_against_differences(*erk, inside, 1e-7);
}

TEST_CASE("gradients of CVODES agree with those of ARKODE") {
    for (const auto law : {model::ContactLaw::kelvin_voigt, model::ContactLaw::no_tension}) {
        const auto rhs = test::membranes(law);
        const auto erk = flow::make_erk(rhs, 1e-13);
        const auto cvode = flow::make_cvode(rhs, 1e-13);
        check_agreement(*erk, *cvode, transient(), 1e-8);
        check_agreement(*erk, *cvode, transient_with(2500.0, 120.0), 1e-8);
    }
    const auto rhs = test::spring(model::ContactLaw::no_tension);
    check_agreement(*flow::make_erk(rhs, 1e-13), *flow::make_cvode(rhs, 1e-13), reloading(), 1e-8);
    Case held = transient();
    held.request.state = {0.5, 0.08, 1.18, 1.19};
    held.request.stop = flow::StopMode::held;
    held.request.duration = 0.11;
    check_agreement(*flow::make_erk(test::membranes(), 1e-13), *flow::make_cvode(test::membranes(), 1e-13), held, 1e-8);
}
