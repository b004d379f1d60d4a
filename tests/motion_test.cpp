// Periodic motions as zeros of smooth equations, in all forms, and the walker along curves that follows them.

#include "engine_cases.hpp"
#include "model/membrane/membrane.hpp"
#include "model/spring/spring.hpp"
#include "numerics/arclength.hpp"
#include "orbit/motion.hpp"
#include "orbit/polish.hpp"
#include "relative.hpp"

#include <doctest/doctest.h>

#include <cmath>
#include <complex>
#include <string>
#include <vector>

using namespace percuss;
using flow::ParameterVector;
using model::ContactLaw;
using numerics::Matrix;
using numerics::Vector;
using orbit::Form;
using orbit::Motion;
using test::at;
using test::membranes;
using test::paper_defaults;

namespace {

/// A motion solved for, with what it belongs to.
struct Scene {
    std::string name;
    std::unique_ptr<flow::Integrator> integrator;
    ParameterVector p;
    Motion motion;
    std::vector<int> parameters;
    [[nodiscard]] flow::System system() const { return {integrator.get(), p, nullptr}; }
};

Motion solved(const flow::System& system, const Motion& guess) {
    const auto motion = orbit::solve(system, guess);
    REQUIRE(motion.has_value());
    return *motion;
}

Scene reference_scene(int which, Form form, ContactLaw law, bool mirrored = false) {
    const test::ReferenceOrbit& known = test::reference_orbits[at(which)];
    Scene scene;
    scene.integrator = membranes(law, 1e-16);
    scene.p = test::with(paper_defaults, model::membrane::omega, known.omega);
    scene.name = std::string(known.name) + (law == ContactLaw::kelvin_voigt ? ", kelvin-voigt" : ", no-tension");
    const flow::System system = scene.system();
    const orbit::Orbit found = orbit::polish_orbit(system, known.state, known.period);
    REQUIRE(found.ok());
    Motion motion = orbit::motion_of(system, found);
    CHECK(motion.form == (known.contacts > 0 ? Form::sequence : Form::free));
    CHECK(motion.contacts() == at(known.contacts));
    CHECK(motion.period == known.period);
    if (form == Form::strobed) {
        motion.form = Form::strobed;
        motion.sequence = {};
        scene.name += ", strobed";
    }
    if (mirrored) {
        motion.mirrored = true;
        scene.name += ", mirrored";
    }
    scene.motion = solved(system, motion);
    using namespace model;
    scene.parameters = {membrane::gap,     membrane::omega,  membrane::stiffness, membrane::damping,
                        membrane::voltage, membrane::length, membrane::delta_b};
    return scene;
}

Scene spring_scene(ContactLaw law) {
    Scene scene;
    scene.integrator = test::spring(law, 1e-16);
    scene.p = {0.1, 1.0, 0.3, 0.5, 0.4, 200.0, 1.5, 1.1};
    scene.name = law == ContactLaw::kelvin_voigt ? "spring, kelvin-voigt" : "spring, no-tension";
    const flow::System system = scene.system();
    const auto state = orbit::settle(system, system.integrator->rest_state(scene.p), 300);
    REQUIRE(state.has_value());
    const orbit::Orbit found = orbit::polish_orbit(system, *state, 1);
    REQUIRE(found.ok());
    scene.motion = solved(system, orbit::motion_of(system, found));
    scene.parameters = {model::spring::gap, model::spring::omega, model::spring::cubic, model::spring::force};
    return scene;
}

std::vector<Scene> all_scenes() {
    std::vector<Scene> scenes;
    for (const ContactLaw law : {ContactLaw::kelvin_voigt, ContactLaw::no_tension}) {
        scenes.push_back(reference_scene(1, Form::sequence, law));
        scenes.push_back(reference_scene(5, Form::sequence, law));
        scenes.push_back(reference_scene(1, Form::strobed, law));
        scenes.push_back(spring_scene(law));
    }
    scenes.push_back(reference_scene(3, Form::free, ContactLaw::kelvin_voigt));
    scenes.push_back(reference_scene(4, Form::free, ContactLaw::kelvin_voigt, true));
    return scenes;
}

/// The motion with its unknowns moved off the solution, so that nothing vanishes by luck.
Motion off_solution(const Scene& scene) {
    const flow::System system = scene.system();
    Vector z = orbit::pack(system, scene.motion);
    const Vector unit = orbit::unit_of_unknowns(system, scene.motion, 0.1);
    for (int i = 0; i < z.size(); ++i) { z[i] += (i % 2 == 0 ? 0.01 : -0.007) * std::min(unit[i], 0.1); }
    return orbit::unpack(system, z, scene.motion);
}

void compare(const std::vector<test::Derivative>& numeric, const Vector& column, double size) {
    for (std::size_t r = 0; r < numeric.size(); ++r) {
        CAPTURE(r);
        CAPTURE(numeric[r].value);
        CAPTURE(numeric[r].error);
        const double entry = column[static_cast<int>(r)];
        // Derivative series are cut so that Newton's method is served: 1e-8 of the change over `size`.
        CHECK(numeric[r].error < 1e-6 * (1.0 / size + std::abs(entry)));
        CHECK(std::abs(entry - numeric[r].value) < 10.0 * numeric[r].error + 3e-8 * (1.0 / size + std::abs(entry)));
    }
}

}  // namespace

TEST_CASE("derivatives of the shooting equations in every form") {
    for (const Scene& scene : all_scenes()) {
        CAPTURE(scene.name);
        const flow::System system = scene.system();
        const Motion motion = off_solution(scene);
        const Vector z = orbit::pack(system, motion);
        CHECK(z.size() == motion.unknowns(system));
        // The end somewhere else than the beginning.
        const Motion closing = orbit::unpack(system, z * 1.001, motion);
        std::vector<ParameterVector> directions;
        for (const int parameter : scene.parameters) { directions.push_back(orbit::unit_direction(parameter)); }
        const auto exact = orbit::shoot(system, motion, directions, &closing);
        const auto plain = orbit::shoot(system, motion, directions);
        REQUIRE(exact.has_value());
        REQUIRE(plain.has_value());
        REQUIRE(exact->value.size() == z.size());
        REQUIRE(exact->by_directions.cols() == static_cast<int>(directions.size()));
        const auto residual = [&](const flow::System& there, const Motion& from, const Motion& to) {
            const auto r = orbit::shoot(there, from, {}, &to);
            REQUIRE(r.has_value());
            return std::vector<double>(r->value.begin(), r->value.end());
        };
        const auto rows = static_cast<std::size_t>(z.size());
        for (int column = 0; column < z.size(); ++column) {
            CAPTURE(column);
            const double size = std::max(0.03, std::abs(z[column]));
            const auto moved = [&](double amount) {
                Vector there = z;
                there[column] += amount;
                return orbit::unpack(system, there, motion);
            };
            const auto by_all = test::ridders_many(
                [&](double amount) {
                    const Motion both = moved(amount);
                    return residual(system, both, both);
                },
                rows, 1e-3 * size);
            compare(by_all, plain->by_unknowns.col(column), size);
            const auto by_end = test::ridders_many(
                [&](double amount) { return residual(system, motion, moved(amount)); }, rows, 1e-3 * size);
            compare(by_end, plain->by_closing.col(column), size);
        }
        for (std::size_t i = 0; i < directions.size(); ++i) {
            const int parameter = scene.parameters[i];
            CAPTURE(parameter);
            const double size = std::abs(scene.p[at(parameter)]);
            const auto by_parameter = test::ridders_many(
                [&](double amount) {
                    return residual(system.with(test::with(scene.p, parameter, scene.p[at(parameter)] + amount)),
                                    motion, closing);
                },
                rows, 1e-3 * size);
            compare(by_parameter, exact->by_directions.col(static_cast<int>(i)), size);
        }
    }
}

TEST_CASE("the equations are singular where beginning and end differ by a Floquet multiplier") {
    for (const Scene& scene : all_scenes()) {
        CAPTURE(scene.name);
        const flow::System system = scene.system();
        const auto r = orbit::shoot(system, scene.motion, {});
        REQUIRE(r.has_value());
        CHECK(r->value.norm() < 1e-12);
        auto strobed = orbit::strobe(system, scene.motion);
        REQUIRE(strobed.has_value());
        const orbit::Image image =
            orbit::apply(system, strobed->map, strobed->state, orbit::Differentiate::state, {}, flow::observe_nothing);
        REQUIRE(image.ok());
        // The image of the strobe point is the strobe point.
        CHECK(test::distance(image.state, strobed->state, system.states()) < 1e-11);
        CHECK(image.contacts.size() == (scene.motion.form == Form::strobed ? 1 : scene.motion.contacts()));
        const Matrix monodromy = image.derivative;
        const Eigen::VectorXcd multipliers = monodromy.eigenvalues();  // of the map: half a cycle when mirrored
        const auto lowest_singular = [&](std::complex<double> mu) {
            const Eigen::MatrixXcd a =
                r->by_unknowns.cast<std::complex<double>>() + (mu - 1.0) * r->by_closing.cast<std::complex<double>>();
            const Eigen::JacobiSVD<Eigen::MatrixXcd> svd(a);
            return svd.singularValues().minCoeff() / svd.singularValues().maxCoeff();
        };
        for (const std::complex<double> mu : multipliers) {
            CAPTURE(mu.real());
            CAPTURE(mu.imag());
            // Two multipliers may be close: then both singular values are small away from them as well.
            CHECK(lowest_singular(mu) < 1e-9);
            CHECK(lowest_singular(mu + std::complex<double>(0.02, 0.03)) > 1e-7);
        }
    }
}

TEST_CASE("solved again from nearby, every form comes back") {
    for (const Scene& scene : all_scenes()) {
        CAPTURE(scene.name);
        const flow::System system = scene.system();
        const Motion back = solved(system, off_solution(scene));
        CHECK((orbit::pack(system, back) - orbit::pack(system, scene.motion)).norm() < 1e-9);
        CHECK(back.form == scene.motion.form);
        CHECK(back.mirrored == scene.motion.mirrored);
    }
    // And nowhere else: a sequence whose contact lasts longer than the period is no motion.
    Scene scene = spring_scene(ContactLaw::kelvin_voigt);
    scene.motion.sequence.contacts[0].duration = 7.0;
    CHECK_FALSE(orbit::shoot(scene.system(), scene.motion, {}).has_value());
    CHECK_FALSE(orbit::solve(scene.system(), scene.motion).has_value());
}

TEST_CASE("a motion is strobed in its longest flight, whichever contact comes first") {
    const Scene scene = reference_scene(5, Form::sequence, ContactLaw::kelvin_voigt);
    const flow::System system = scene.system();
    const auto first = orbit::strobe(system, scene.motion);
    Motion rotated = scene.motion;
    auto& contacts = rotated.sequence.contacts;
    REQUIRE(contacts.size() == 2);
    contacts[0].phase += 2.0 * test::pi * 3;
    std::swap(contacts[0], contacts[1]);
    const auto second = orbit::strobe(system, rotated);
    REQUIRE(first.has_value());
    REQUIRE(second.has_value());
    CHECK(test::distance(first->state, second->state, 4) < 1e-10);
    CHECK(std::remainder(first->map.phase - second->map.phase, 2.0 * test::pi) == doctest::Approx(0.0));
    CHECK(first->map.phase >= 0.0);
    CHECK(first->map.phase < 2.0 * test::pi);
    CHECK(first->map.period == 3);
}

TEST_CASE("the walker starts along any direction, probes to both sides and follows a closed curve to its start") {
    // x^2 + 4 y^2 = 1: the last entry, y, turns twice.
    const auto ellipse = [](const Vector& u, Vector& f, Matrix& jacobian) {
        f.resize(1);
        f[0] = u[0] * u[0] + 4.0 * u[1] * u[1] - 1.0;
        jacobian.resize(1, 2);
        jacobian << 2.0 * u[0], 8.0 * u[1];
        return true;
    };
    const auto on_curve = [](const Vector& u) { return std::abs(u[0] * u[0] + 4.0 * u[1] * u[1] - 1.0); };
    numerics::ArclengthWalker walker(ellipse, {});
    Vector u(2);
    Vector along(2);
    u << 0.9, 0.02;
    along << 0.0, 3.0;  // y held, then upwards
    REQUIRE(walker.start_along(u, along));
    CHECK(walker.point()[1] == doctest::Approx(0.02).epsilon(1e-14));
    CHECK(walker.point()[0] == test::relative(std::sqrt(1.0 - 4.0 * 0.02 * 0.02), 1e-13));
    CHECK(walker.tangent()[1] > 0.9);
    along << -1.0, 0.0;  // x held: not the tangent's direction, but to the side where x falls
    u << 0.6, -0.35;
    REQUIRE(walker.start_along(u, along));
    CHECK(walker.point()[0] == doctest::Approx(0.6).epsilon(1e-14));
    CHECK(walker.point()[1] == test::relative(-0.4, 1e-13));
    CHECK(walker.tangent()[0] < 0.0);

    const Vector before = walker.point();
    Vector probed;
    Vector tangent;
    for (const double step : {0.1, -0.1, 0.02}) {
        CAPTURE(step);
        REQUIRE(walker.probe(step, probed, tangent));
        CHECK(on_curve(probed) < 1e-10);
        CHECK((probed - before).dot(walker.tangent()) == test::relative(step, 1e-9));
        // Orthogonal to the gradient, and forward.
        CHECK(std::abs(probed[0] * tangent[0] + 4.0 * probed[1] * tangent[1]) < 1e-9);
        CHECK(tangent.dot(walker.tangent()) > 0.0);
    }
    CHECK((walker.point() - before).norm() == 0.0);
    CHECK_FALSE(walker.probe(3.0, probed, tangent));  // no point of the curve that far along the tangent

    int turns = 0;
    double length = 0.0;
    Vector last = walker.point();
    Vector earlier = last;
    double slope = walker.tangent()[1];
    for (int i = 0; i < 1000 && (length < 1.0 || (walker.point() - before).norm() > 0.05); ++i) {
        REQUIRE(walker.advance());
        CHECK(on_curve(walker.point()) < 1e-10);
        turns += slope * walker.tangent()[1] < 0.0 ? 1 : 0;
        slope = walker.tangent()[1];
        length += (walker.point() - last).norm();
        last = walker.point();
        if (i == 5) {  // back by one, and no further; the next step is half as long
            const double step = (last - earlier).norm();
            REQUIRE(walker.retreat());
            CHECK((walker.point() - earlier).norm() == 0.0);
            CHECK_FALSE(walker.retreat());
            REQUIRE(walker.advance());
            CHECK((walker.point() - earlier).norm() == doctest::Approx(0.5 * step).epsilon(0.05));
            length += (walker.point() - earlier).norm() - step;
            last = walker.point();
            slope = walker.tangent()[1];
        }
        earlier = last;
    }
    CHECK(turns == 2);
    CHECK(length == doctest::Approx(4.8442).epsilon(0.03));  // circumference of the ellipse with axes 1 and 1/2
}
