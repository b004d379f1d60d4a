// The voice coil against its closed form, its limit of no inductance, its energy balance, differences and the other
// integrators; the program run as a user runs it.

#include "engine_cases.hpp"
#include "orbit/orbit.hpp"
#include "program_run.hpp"
#include "relative.hpp"

#include <doctest/doctest.h>

#include <array>
#include <cmath>
#include <complex>
#include <map>
#include <numbers>
#include <string>
#include <vector>

#include <nlohmann/json.hpp>

using namespace percuss;
using test::relative;
using tests::Outcome;
using tests::run;
using tests::ScratchFolder;
using Json = nlohmann::json;

namespace {

constexpr double pi = std::numbers::pi;

struct Coil {
    double mass = 5e-3, damping = 0.05, stiffness = 1263.0, cubic = 0.0, bias = 0.0;
    double force_constant = 1.0, resistance = 6.0, inductance = 1e-4, voltage = 2.0;
    double gap = 4e-4, stop_stiffness = 1e5, stop_damping = 0.5;
    double frequency = 95.0;
    bool stop = true;
};

std::string text(double value) {
    std::array<char, 40> digits{};
    std::snprintf(digits.data(), digits.size(), "%.17g", value);
    return digits.data();
}

std::string stop_section(const Coil& c) {
    if (!c.stop) { return "[stop]\nlaw = none\n"; }
    return "[stop]\nlaw = kelvin-voigt\ngap = " + text(c.gap) + "\nstiffness = " + text(c.stop_stiffness) +
           "\ndamping = " + text(c.stop_damping) + "\n";
}

std::string coil_file(const Coil& c) {
    return "[actuator]\ntype = voice-coil\n[voice-coil]\nmass = " + text(c.mass) + "\ndamping = " + text(c.damping) +
           "\nstiffness = " + text(c.stiffness) + "\ncubic = " + text(c.cubic) + "\nbias = " + text(c.bias) +
           "\nforce_constant = " + text(c.force_constant) + "\nresistance = " + text(c.resistance) +
           "\ninductance = " + text(c.inductance) + "\nvoltage = " + text(c.voltage) + "\n" + stop_section(c) +
           "[drive]\nfrequency = " + text(c.frequency) + "\n";
}

/// The spring-mass that the coil becomes as its inductance vanishes.
std::string spring_file(const Coil& c) {
    const double bl = c.force_constant;
    return "[actuator]\ntype = spring-mass\n[spring-mass]\nmass = " + text(c.mass) +
           "\ndamping = " + text(c.damping + bl * bl / c.resistance) + "\nstiffness = " + text(c.stiffness) +
           "\ncubic = " + text(c.cubic) + "\nbias = " + text(c.bias) +
           "\nforce = " + text(bl * c.voltage / c.resistance) + "\n" + stop_section(c) +
           "[drive]\nfrequency = " + text(c.frequency) + "\n";
}

Json answer(const std::string& verb, const std::string& file, std::vector<std::string> options = {}) {
    const ScratchFolder folder;
    folder.write("coil.ini", file);
    std::vector<std::string> arguments = {verb, "coil.ini", "--json", "--quiet", "--out", "none"};
    arguments.insert(arguments.end(), options.begin(), options.end());
    const Outcome outcome = run(folder, arguments);
    CAPTURE(outcome.err);
    REQUIRE_FALSE(outcome.out.empty());
    return Json::parse(outcome.out);
}

double quantity(const Json& document, const std::string& name) {
    return document.at("quantities").at(name).get<double>();
}

/// X = Bl V / |(k1 - m w^2 + j w c)(R + j w Le) + j w Bl^2|, from m x'' + c x' + k1 x = Bl i and
/// Le i' + R i + Bl x' = V cos(w t) with everything proportional to exp(j w t).
double closed_form_amplitude(const Coil& c) {
    using namespace std::complex_literals;
    const double w = 2.0 * pi * c.frequency;
    const double bl = c.force_constant;
    const std::complex<double> mechanical = c.stiffness - c.mass * w * w + 1i * w * c.damping;
    const std::complex<double> electric = c.resistance + 1i * w * c.inductance;
    return bl * c.voltage / std::abs(mechanical * electric + 1i * w * bl * bl);
}

/// |i| = |V (k1 - m w^2 + j w c)| / |...|.
double closed_form_current(const Coil& c) {
    using namespace std::complex_literals;
    const double w = 2.0 * pi * c.frequency;
    return closed_form_amplitude(c) / c.force_constant * std::abs(c.stiffness - c.mass * w * w + 1i * w * c.damping);
}

Coil random_coil(test::Random& random) {
    Coil c;
    c.damping = random.uniform(0.02, 0.2);
    c.stiffness = random.uniform(800.0, 2000.0);
    c.cubic = random.uniform(0.0, 2e8);
    c.force_constant = random.uniform(0.6, 1.5);
    c.resistance = random.uniform(4.0, 9.0);
    c.inductance = random.log_uniform(5e-5, 1e-3);
    c.voltage = random.uniform(1.0, 3.0);
    c.gap = random.uniform(2e-4, 5e-4);
    c.stop_stiffness = random.log_uniform(2e4, 2e5);
    c.stop_damping = random.uniform(0.2, 1.0);
    return c;
}

}  // namespace

TEST_CASE("without a stop the linear coil has its closed form") {
    test::Random random(7);
    for (int i = 0; i < 8; ++i) {
        Coil c = random_coil(random);
        c.stop = false;
        c.cubic = 0.0;
        c.frequency = random.uniform(40.0, 160.0);
        CAPTURE(i);
        const Json document = answer("orbit", coil_file(c));
        CHECK(quantity(document, "amplitude") == relative(closed_form_amplitude(c), 1e-12));
        CHECK(quantity(document, "coil_current") == relative(closed_form_current(c), 1e-11));
        // Sinusoidal current: the mean of R i^2 is half of R times the square of its amplitude.
        const double current = closed_form_current(c);
        CHECK(quantity(document, "coil_heat") == relative(0.5 * c.resistance * current * current, 1e-10));
    }
}

TEST_CASE("as the inductance vanishes the coil becomes the spring-mass with damping c + Bl^2/R and force Bl V/R") {
    Coil c;
    const Json limit = answer("orbit", spring_file(c));
    REQUIRE(limit.at("orbit").at("contacts") == 1);
    std::map<double, Json> at;
    for (const double inductance : {4e-5, 2e-5, 1e-5}) {
        c.inductance = inductance;
        at[inductance] = answer("orbit", coil_file(c));
    }
    for (const char* name : {"peak_force", "amplitude", "impact_velocity", "contact_time", "impulse", "stop_work"}) {
        CAPTURE(name);
        const double spring = quantity(limit, name);
        const double a = quantity(at[4e-5], name);
        const double b = quantity(at[2e-5], name);
        const double d = quantity(at[1e-5], name);
        // Linear in Le to leading order: the difference halves with it.
        CHECK((a - spring) / (b - spring) == doctest::Approx(2.0).epsilon(0.02));
        CHECK((b - spring) / (d - spring) == doctest::Approx(2.0).epsilon(0.01));
        // Richardson: the polynomial through the three points at Le = 0.
        const double extrapolated = (8.0 * d - 6.0 * b + a) / 3.0;
        CHECK(extrapolated == relative(spring, 1e-6));
    }
}

TEST_CASE("gradients agree with differences at ten random designs") {
    test::Random random(11);
    int checked = 0;
    for (int i = 0; checked < 10 && i < 30; ++i) {
        const Coil c = random_coil(random);
        const std::string at_edge =
            coil_file(c).substr(0, coil_file(c).find("[drive]")) + "[drive]\nfrequency = edge\nmargin = 1 %\n";
        const Json document = answer("evaluate", at_edge, {"--gradients"});
        if (document.at("status") != "ok") { continue; }
        ++checked;
        CAPTURE(i);
        const std::map<std::string, double> keys = {{"stop.gap", c.gap},
                                                    {"stop.stiffness", c.stop_stiffness},
                                                    {"voice-coil.voltage", c.voltage},
                                                    {"voice-coil.inductance", c.inductance},
                                                    {"voice-coil.resistance", c.resistance},
                                                    {"voice-coil.force_constant", c.force_constant},
                                                    {"voice-coil.mass", c.mass}};
        for (const auto& [key, value] : keys) {
            CAPTURE(key);
            const double h = 1e-4 * value;
            const auto moved = [&](double steps) {
                return answer("evaluate", at_edge, {"--" + key, text(value + steps * h)});
            };
            const Json one = moved(1.0);
            const Json minus_one = moved(-1.0);
            const Json two = moved(2.0);
            const Json minus_two = moved(-2.0);
            for (const char* name : {"peak_force", "amplitude", "drive_frequency", "coil_current", "coil_heat",
                                     "electric_power", "impulse"}) {
                CAPTURE(name);
                const double difference = (8.0 * (quantity(one, name) - quantity(minus_one, name)) -
                                           (quantity(two, name) - quantity(minus_two, name))) /
                                          (12.0 * h);
                const double exact = document.at("gradients").at(name).at(key).get<double>();
                // Fourth-order differences with a relative step of 1e-4: truncation far below 1e-8, rounding of values
                // good to 1e-12 gives 1e-8 of value / key.
                const double size = std::max(std::abs(exact), 1e-2 * std::abs(quantity(document, name) / value));
                CHECK(std::abs(difference - exact) < 1e-6 * size);
            }
        }
    }
    CHECK(checked == 10);
}

TEST_CASE("Taylor, ERK and CVODE agree") {
    Coil c;
    c.inductance = 5e-4;
    const Json taylor = answer("orbit", coil_file(c), {"--solver.integrator", "taylor"});
    for (const char* integrator : {"erk", "cvode"}) {
        CAPTURE(integrator);
        const Json other = answer("orbit", coil_file(c), {"--solver.integrator", integrator});
        for (const char* name :
             {"peak_force", "amplitude", "coil_current", "coil_heat", "electric_power", "stop_work"}) {
            CAPTURE(name);
            CHECK(quantity(other, name) == relative(quantity(taylor, name), 1e-8));
        }
    }
}

TEST_CASE("auto takes CVODE where the current or the stop is stiff") {
    const auto chosen = [](const model::Scene& scene, const flow::ParameterVector& p) {
        return kernels::choose_integrator("auto", scene, model::ContactLaw::kelvin_voigt, p);
    };
    flow::ParameterVector p = {0.1, 1.0, 0.0, 1e3, 100.0, 300.0, 0.4, 100.0, 1.0, 1.2};
    CHECK(chosen(model::coil::scene, p) == "taylor");
    p[model::coil::resistance] = 2e4;
    CHECK(chosen(model::coil::scene, p) == "cvode");
    flow::ParameterVector s = {0.1, 1.0, 0.0, 0.5, 0.4, 200.0, 1.0, 1.1};
    CHECK(chosen(model::spring::scene, s) == "taylor");
    s[model::spring::stop_damping] = 1e5;
    CHECK(chosen(model::spring::scene, s) == "cvode");
    s[model::spring::stop_stiffness] = 1e10;  // no longer overdamped
    CHECK(chosen(model::spring::scene, s) == "taylor");
    CHECK(kernels::choose_integrator("erk", model::spring::scene, model::ContactLaw::none, s) == "erk");
    Coil c;
    c.inductance = 1e-8;
    c.gap = 3e-4;
    const Json stiff = answer("orbit", coil_file(c));
    CHECK(stiff.at("status") == "ok");
}

TEST_CASE("over a period the electric work is the heat, the damper's and the stop's") {
    test::Random random(3);
    int balanced = 0;
    for (const model::ContactLaw law : {model::ContactLaw::kelvin_voigt, model::ContactLaw::no_tension}) {
        for (int i = 0; i < 6; ++i) {
            CAPTURE(i);
            flow::ParameterVector p{};
            p[model::coil::damping] = random.uniform(0.02, 0.2);
            p[model::coil::stiffness] = 1.0;
            p[model::coil::cubic] = random.uniform(0.0, 0.3);
            p[model::coil::resistance] = random.log_uniform(1.0, 100.0);
            p[model::coil::coupling] = p[model::coil::resistance] * random.uniform(0.1, 0.4);
            p[model::coil::voltage] = p[model::coil::resistance] * random.uniform(0.2, 0.6);
            p[model::coil::gap] = random.uniform(0.2, 0.6);
            p[model::coil::stop_stiffness] = random.log_uniform(10.0, 300.0);
            p[model::coil::stop_damping] = random.uniform(0.5, 2.0);
            p[model::coil::omega] = random.uniform(1.0, 1.4);
            const auto taylor = kernels::make_integrator(model::coil::scene, law);
            const flow::System system{taylor.get(), p, nullptr};
            const auto settled = orbit::settle(system, taylor->rest_state(p), 200);
            REQUIRE(settled);
            const orbit::Orbit orbit = orbit::find_orbit(system, {}, *settled);
            if (!orbit.ok()) { continue; }  // not every one of these motions has period 1
            for (const std::string method : {"taylor", "erk", "cvode"}) {
                CAPTURE(method);
                kernels::IntegratorOptions options;
                options.integrator = method;
                const auto integrator = kernels::make_integrator(model::coil::scene, law, options);
                flow::Request request;
                request.state = orbit.state;
                request.duration = 2.0 * pi;
                request.observe = flow::observe_all;
                const flow::Result result = test::run(*integrator, p, request);
                REQUIRE(result.status == flow::Status::ok);
                const flow::Observables& seen = result.observables;
                const double work = seen.drive_work.value;
                CHECK(seen.dissipation.value + seen.stop_work.value == relative(work, 1e-10));
                CHECK(seen.mean[model::coil::power].value == relative(work, 1e-10));
                CHECK(seen.mean[model::coil::heat].value < work);
                ++balanced;
            }
        }
    }
    CHECK(balanced >= 18);
}

TEST_CASE("the shipped voice coil is optimised") {
    const ScratchFolder folder;
    const Outcome outcome =
        run(folder, {"optimise", tests::shipped("voice-coil.ini"), "--json", "--quiet", "--out", "none"});
    REQUIRE(outcome.exit_code == 0);
    const Json document = Json::parse(outcome.out);
    CHECK(document.at("status") == "optimal");
    // Heat, frequency and contact time hold three variables inside their bounds.
    CHECK(quantity(document, "coil_heat") == relative(0.15, 1e-8));
    CHECK(quantity(document, "drive_frequency") == relative(100.0, 1e-8));
    CHECK(quantity(document, "contact_time") == relative(5e-4, 1e-8));
    CHECK(document.at("kkt_residual").get<double>() < 1e-8);
}

TEST_CASE("a quantity of the coil is refused elsewhere, and the other way round") {
    const ScratchFolder folder;
    const Outcome on_spring = run(
        folder, {"evaluate", tests::shipped("soft-impact.ini"), "--out", "none", "--design.limit", "coil_heat <= 1 W"});
    CHECK(on_spring.exit_code == 2);
    CHECK(tests::has(on_spring.err, "coil_heat"));
    folder.write("coil.ini", coil_file(Coil{}));
    const Outcome on_coil =
        run(folder, {"evaluate", "coil.ini", "--out", "none", "--design.limit", "electric_field <= 50 V/um"});
    CHECK(on_coil.exit_code == 2);
    CHECK(tests::has(on_coil.err, "electric_field"));
}
