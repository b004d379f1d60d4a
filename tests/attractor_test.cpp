// Ensembles: where starts are drawn, what they are found to lead to, what is said of shares and of uniqueness.

#include "attractor/ensemble.hpp"
#include "engine_cases.hpp"
#include "model/membrane/membrane.hpp"
#include "orbit/polish.hpp"
#include "relative.hpp"

#include <doctest/doctest.h>

#include <atomic>
#include <set>
#include <stdexcept>

namespace {

using namespace percuss;
using attractor::Attractor;
using attractor::Box;
using attractor::Ensemble;
using attractor::EnsembleOptions;
using attractor::Kind;
using attractor::Refutation;
using test::at;
using test::paper_defaults;

/// The paper's actuator at a frequency, with the two integrators that an ensemble takes.
struct Case {
    std::unique_ptr<flow::Integrator> exact_integrator = test::membranes();
    std::unique_ptr<flow::Integrator> scout_integrator = test::membranes(model::ContactLaw::kelvin_voigt, 1e-8);
    flow::System exact, scout;
    Box box;

    explicit Case(double omega)
        : exact{exact_integrator.get(), test::with(paper_defaults, model::membrane::omega, omega), nullptr},
          scout{scout_integrator.get(), exact.parameters, nullptr},
          box(attractor::ensemble_box(exact, attractor::amplitude_to_expect(scout))) {}

    [[nodiscard]] Ensemble motions(const EnsembleOptions& options = {}) const {
        return attractor::find_attractors({exact, scout}, box, options);
    }
    [[nodiscard]] orbit::Orbit orbit(const flow::State& from, int period) const {
        return orbit::polish_orbit(exact, from, period);
    }
};

/// c k1 k3 F gap k delta_i omega
struct SpringCase {
    std::unique_ptr<flow::Integrator> exact_integrator = test::spring(model::ContactLaw::none);
    std::unique_ptr<flow::Integrator> scout_integrator = test::spring(model::ContactLaw::none, 1e-8);
    flow::System exact, scout;
    explicit SpringCase(const flow::ParameterVector& p)
        : exact{exact_integrator.get(), p, nullptr},
          scout{scout_integrator.get(), p, nullptr} {}
};
constexpr flow::ParameterVector duffing = {0.05, 1.0, 0.1, 0.18, 0.0, 0.0, 0.0, 1.2};

const Attractor* with_force(const Ensemble& ensemble, double peak_force, double within) {
    for (const Attractor& motion : ensemble.attractors) {
        if (std::abs(motion.peak_force - peak_force) < within) { return &motion; }
    }
    return nullptr;
}

bool same_bits(const Attractor& a, const Attractor& b) {
    return a.kind == b.kind && a.period == b.period && a.state == b.state && a.peak_force == b.peak_force &&
           a.x_max == b.x_max && a.x_min == b.x_min && a.contacts_per_cycle == b.contacts_per_cycle &&
           a.exponent.value == b.exponent.value && a.starts == b.starts && a.share.lower == b.share.lower;
}

bool same_bits(const Ensemble& a, const Ensemble& b) {
    return a.status == b.status && a.led_to == b.led_to && a.starts == b.starts && a.cycles == b.cycles &&
           a.missed_share_bound == b.missed_share_bound &&
           std::equal(a.attractors.begin(), a.attractors.end(), b.attractors.begin(), b.attractors.end(),
                      [](const Attractor& x, const Attractor& y) { return same_bits(x, y); });
}

}  // namespace

TEST_CASE("the box of starts") {
    const auto integrator = test::membranes();
    const flow::System system{integrator.get(), test::with(paper_defaults, model::membrane::omega, 2.0), nullptr};
    const Box narrow = attractor::ensemble_box(system, 0.05);  // the gap, 0.1, is wider
    CHECK(narrow.lower[0] == doctest::Approx(0.4 - 0.2));
    CHECK(narrow.upper[0] == doctest::Approx(0.4 + 0.1));
    CHECK(narrow.lower[1] == doctest::Approx(-2.0 * 2.0 * 0.1));
    CHECK(narrow.upper[1] == doctest::Approx(2.0 * 2.0 * 0.1));
    for (const std::size_t k : {2U, 3U}) {
        CHECK(narrow.lower[k] == doctest::Approx(1.1));
        CHECK(narrow.upper[k] == doctest::Approx(1.1 * std::sqrt(1.0 + 0.6 * 0.6)));
    }
    const Box wide = attractor::ensemble_box(system, 0.15);
    CHECK(wide.lower[0] == doctest::Approx(0.4 - 0.3));
    CHECK(wide.upper[0] == doctest::Approx(0.4 + 0.1));
    CHECK(wide.upper[3] == doctest::Approx(1.1 * std::sqrt(1.0 + 0.7 * 0.7)));

    const SpringCase spring(duffing);  // no stop: the box reaches as far to both sides, and has two states
    const Box both = attractor::ensemble_box(spring.exact, 3.0);
    CHECK(both.lower[0] == doctest::Approx(-6.0));
    CHECK(both.upper[0] == doctest::Approx(6.0));
    CHECK(both.upper[1] == doctest::Approx(7.2));
    CHECK(both.upper[2] == 0.0);

    const double nan = std::nan("");
    CHECK_THROWS_AS(attractor::ensemble_box(system, -0.1), std::invalid_argument);
    CHECK_THROWS_AS(attractor::ensemble_box(system, nan), std::invalid_argument);
    CHECK_THROWS_AS(attractor::ensemble_box(system.at_omega(0.0), 0.1), std::invalid_argument);
    CHECK_THROWS_AS(attractor::ensemble_box(spring.exact, 0.0), std::invalid_argument);  // nothing has a size
    CHECK_THROWS_AS(attractor::validate({{0.0, 1.0}, {1.0, 0.5}}, 2), std::invalid_argument);
    CHECK_THROWS_AS(attractor::validate({{0.0, 1.0}, {1.0, nan}}, 2), std::invalid_argument);
    CHECK_THROWS_AS(attractor::validate({{1.0, 2.0}, {1.0, 2.0}}, 2), std::invalid_argument);
    CHECK_NOTHROW(attractor::validate({{1.0, 2.0}, {1.0, 2.5}}, 2));
}

TEST_CASE("starts are uniform, independent, and a function of seed and number alone") {
    Box cube;
    cube.upper.fill(1.0);
    constexpr int count = 20000;
    std::array<double, 4> mean{};
    std::array<double, 4> square{};
    double across = 0.0;  // between entries of one start
    double along = 0.0;   // between consecutive starts
    double seeds = 0.0;   // between the same start of consecutive seeds
    std::set<double> seen;
    for (long i = 0; i < count; ++i) {
        const flow::State y = attractor::start_state(cube, 4, 1, i);
        const flow::State next = attractor::start_state(cube, 4, 1, i + 1);
        const flow::State other = attractor::start_state(cube, 4, 2, i);
        for (std::size_t k = 0; k < 4; ++k) {
            CHECK_UNARY(y[k] >= 0.0 && y[k] < 1.0);
            mean[k] += y[k] / count;
            square[k] += y[k] * y[k] / count;
        }
        seen.insert(y[0]);
        across += (y[0] - 0.5) * (y[1] - 0.5) / count;
        along += (y[2] - 0.5) * (next[2] - 0.5) / count;
        seeds += (y[3] - 0.5) * (other[3] - 0.5) / count;
    }
    CHECK(seen.size() == count);
    const double sigma = 1.0 / std::sqrt(12.0 * count);  // of a mean of uniform numbers; 4 sigma: 6e-5 two-sided
    for (std::size_t k = 0; k < 4; ++k) {
        CHECK(std::abs(mean[k] - 0.5) < 4.0 * sigma);
        CHECK(std::abs(square[k] - 1.0 / 3.0) < 4.0 * std::sqrt(4.0 / 45.0 / count));
    }
    for (const double covariance : {across, along, seeds}) {
        CHECK(std::abs(covariance) < 4.0 / (12.0 * std::sqrt(count)));
    }
    // Seeds are no shifted copies of one another, not even by the constant that the generator counts with.
    const std::uint64_t shifted = 1 + 0x9e3779b97f4a7c15U;
    CHECK(attractor::start_state(cube, 4, shifted, 0)[0] != attractor::start_state(cube, 4, 1, 0)[1]);
    CHECK(attractor::start_state(cube, 4, 7, 123) == attractor::start_state(cube, 4, 7, 123));
    // The first entries do not depend on how many there are; an interval of no length is a constant.
    const Box flat{{0.0, 3.0, 0.0, 0.0}, {1.0, 3.0, 1.0, 1.0}};
    const flow::State two = attractor::start_state(flat, 2, 1, 5);
    CHECK(two[0] == attractor::start_state(cube, 4, 1, 5)[0]);
    CHECK(two[1] == 3.0);
    CHECK(two[2] == 0.0);
}

TEST_CASE("shares and their bounds") {
    // Tables of Clopper and Pearson: 5 of 10 and 0 of 10, two-sided 95 %.
    const auto half = attractor::share_of(5, 10);
    CHECK(half.value == 0.5);
    CHECK(half.lower == test::relative(0.18709, 1e-4));
    CHECK(half.upper == test::relative(0.81291, 1e-4));
    const auto none = attractor::share_of(0, 10);
    CHECK(none.lower == 0.0);
    CHECK(none.upper == test::relative(0.30850, 1e-4));
    CHECK(attractor::share_of(10, 10).upper == 1.0);
    CHECK(attractor::share_of(10, 10).lower == test::relative(1.0 - none.upper, 1e-12));
    // None of 512: (1 - p)^512 = 0.05.
    const double bound = attractor::share_bound(0, 512);
    CHECK(std::pow(1.0 - bound, 512) == test::relative(0.05, 1e-10));
    CHECK(bound < 3.0 / 512.0);
    CHECK(attractor::share_bound(1, 512) > bound);
    CHECK(attractor::share_bound(512, 512) == 1.0);
    CHECK_THROWS_AS(attractor::share_of(0, 0), std::invalid_argument);
    CHECK_THROWS_AS(attractor::share_of(-1, 3), std::invalid_argument);
    CHECK_THROWS_AS(attractor::share_bound(4, 3), std::invalid_argument);
}

TEST_CASE("three stable motions at 1.78, whatever the seed") {
    const Case c(1.78);
    EnsembleOptions options;
    options.jobs = 2;
    for (std::uint64_t seed = 1; seed <= 10; ++seed) {
        CAPTURE(seed);
        options.seed = seed;
        const Ensemble ensemble = c.motions(options);
        CHECK(ensemble.status == Ensemble::Status::done);
        CHECK(ensemble.attractors.size() == 3);
        const Attractor* low = with_force(ensemble, 3.04, 5e-3);
        const Attractor* third = with_force(ensemble, 5.40627738, 6e-9 * 5.4);
        const Attractor* high = with_force(ensemble, 7.466, 5e-4);
        REQUIRE(low != nullptr);
        REQUIRE(third != nullptr);
        REQUIRE(high != nullptr);
        CHECK(low->period == 1);
        CHECK(third->period == 3);
        CHECK(high->period == 4);
        const test::ReferenceOrbit& reference = test::reference_orbits[5];
        CHECK(test::distance(third->state, reference.state, 4) < 1e-11);
        CHECK(third->contacts == reference.contacts);
        CHECK(std::abs(third->multipliers[0]) == test::relative(reference.max_multiplier, 1e-7));
        CHECK(ensemble.unclassified == 0);
        CHECK(low->starts + third->starts + high->starts == 512);
        CHECK(third->share.lower < third->share.value);
        CHECK(third->share.upper > third->share.value);
        CHECK(std::abs(low->share.value - 0.395) < 0.09);  // 4 sigma of a share near 0.4 of 512
    }
}

TEST_CASE("known motions at other frequencies") {
    EnsembleOptions options;
    options.starts = 192;
    const Ensemble at_1_65 = Case(1.65).motions(options);
    CHECK(at_1_65.unclassified == 0);
    for (const Attractor& motion : at_1_65.attractors) { CHECK(motion.period != 1); }
    REQUIRE_FALSE(at_1_65.attractors.empty());

    const Ensemble at_1_9 = Case(1.9).motions(options);
    REQUIRE(at_1_9.attractors.size() == 1);
    CHECK(at_1_9.attractors[0].starts == 192);
    CHECK(test::distance(at_1_9.attractors[0].state, test::reference_orbits[0].state, 4) < 1e-12);
    CHECK(at_1_9.attractors[0].amplitude() == test::relative(0.110756049472569, 1e-11));
    CHECK(at_1_9.missed_share_bound == attractor::share_bound(0, 192));

    const Ensemble at_2_2 = Case(2.2).motions(options);
    REQUIRE(at_2_2.attractors.size() == 2);
    const Attractor* struck = with_force(at_2_2, 9.721692402, 1e-8);
    const Attractor* clear = with_force(at_2_2, 0.0, 1e-300);
    REQUIRE(struck != nullptr);
    REQUIRE(clear != nullptr);
    CHECK(struck->period == 1);
    CHECK(clear->period == 1);
    CHECK(clear->contacts == 0);
    CHECK(test::distance(struck->state, test::reference_orbits[1].state, 4) < 1e-11);
    CHECK(test::distance(clear->state, test::reference_orbits[3].state, 4) < 1e-11);
}

TEST_CASE("duffing: both motions, without a stop to give the box its size") {
    const SpringCase spring(duffing);
    const Box box = attractor::ensemble_box(spring.exact, attractor::amplitude_to_expect(spring.scout));
    EnsembleOptions options;
    options.starts = 128;
    const Ensemble ensemble = attractor::find_attractors({spring.exact, spring.scout}, box, options);
    REQUIRE(ensemble.attractors.size() == 2);
    CHECK(ensemble.unclassified == 0);
    for (const Attractor& motion : ensemble.attractors) {
        CHECK(motion.period == 1);
        CHECK(motion.starts > 30);
        // Liouville: the multipliers' product is exp(-c 2 pi/omega), both have its root as modulus (complex pair).
        CHECK(std::abs(motion.multipliers[0]) == test::relative(std::exp(-0.05 * test::pi / 1.2), 1e-9));
    }
    CHECK(std::abs(ensemble.attractors[0].amplitude() - ensemble.attractors[1].amplitude()) > 1.0);
}

TEST_CASE("every captured start really goes where it is said to go") {
    for (const double omega : {1.78, 2.2, 1.8609}) {  // 1.8609: just below where the period-3 motion ends
        CAPTURE(omega);
        const Case c(omega);
        EnsembleOptions options;
        options.starts = 128;
        const Ensemble ensemble = c.motions(options);
        CHECK(ensemble.unclassified == 0);
        std::vector<flow::State> states;
        for (long i = 0; i < options.starts; ++i) { states.push_back(attractor::start_state(c.box, 4, 1, i)); }
        std::vector<flow::EnsembleMember> members(states.size());
        flow::EnsembleRequest request;
        request.states = states;
        request.duration = test::two_pi * 3.0 * 4.0 * 40.0;  // whole periods of all of them
        request.max_events = 10000;
        c.scout.integrator->run_ensemble(c.scout.parameters, request, members);
        std::vector<attractor::Trap> traps;
        for (const Attractor& motion : ensemble.attractors) {
            traps.emplace_back(c.scout, motion.orbit, attractor::half_widths(c.box, 4));
        }
        for (std::size_t i = 0; i < members.size(); ++i) {
            REQUIRE(members[i].status == flow::Status::ok);
            CHECK(traps[at(ensemble.led_to[i])].distance(members[i].state) < 1e-6);
        }
    }
}

TEST_CASE("the same bits with any number of threads, other starts with another seed") {
    const Case c(1.78);
    EnsembleOptions options;
    options.starts = 200;  // the last block is not full
    const Ensemble one = c.motions(options);
    CHECK(one.starts == 200);
    for (const int jobs : {2, 5}) {
        options.jobs = jobs;
        CHECK(same_bits(one, c.motions(options)));
    }
    options.seed = 2;
    CHECK_FALSE(same_bits(one, c.motions(options)));
}

TEST_CASE("is the given orbit alone?") {
    const Case alone(1.9);
    EnsembleOptions options;
    const orbit::Orbit tuned = alone.orbit(test::reference_orbits[0].state, 1);
    REQUIRE(tuned.ok());
    const Refutation kept = attractor::refute({alone.exact, alone.scout}, tuned, alone.box, options);
    CHECK(kept.status == Refutation::Status::not_refuted);
    CHECK(kept.starts == 512);
    CHECK(kept.unclassified == 0);
    CHECK_FALSE(kept.other.has_value());
    CHECK(kept.missed_share_bound == attractor::share_bound(0, 512));
    CHECK(kept.cycles / 512.0 < 60.0);  // cheap: a few dozen cycles a start

    const Case crowded(1.78);
    const orbit::Orbit third = crowded.orbit(test::reference_orbits[5].state, 3);
    REQUIRE(third.ok());
    const Refutation refuted = attractor::refute({crowded.exact, crowded.scout}, third, crowded.box, options);
    CHECK(refuted.status == Refutation::Status::refuted);
    CHECK(refuted.starts == 64);
    REQUIRE(refuted.other.has_value());
    CHECK(refuted.other->kind == Kind::periodic);
    CHECK(refuted.other->period != 3);
    CHECK(std::abs(refuted.other->multipliers[0]) < 1.0);
    options.jobs = 3;
    const Refutation again = attractor::refute({crowded.exact, crowded.scout}, third, crowded.box, options);
    CHECK(again.starts == refuted.starts);
    CHECK(again.cycles == refuted.cycles);
    REQUIRE(again.other.has_value());
    CHECK(again.other->state == refuted.other->state);
}

TEST_CASE("a budget that is too small is told, not hidden") {
    const Case c(1.9);
    EnsembleOptions options;
    options.starts = 64;
    options.max_cycles = 3;
    const Ensemble ensemble = c.motions(options);
    CHECK(ensemble.unclassified > 32);
    CHECK(ensemble.missed_share_bound > 0.5);
    const orbit::Orbit tuned = c.orbit(test::reference_orbits[0].state, 1);
    const Refutation refutation = attractor::refute({c.exact, c.scout}, tuned, c.box, options);
    CHECK(refutation.status == Refutation::Status::undecided);
    CHECK(refutation.unclassified > 32);
    CHECK(refutation.missed_share_bound > 0.5);
}

TEST_CASE("asked to stop, an ensemble keeps the blocks that were finished") {
    const Case c(1.78);
    EnsembleOptions options;
    std::atomic<int> asked{0};
    options.cancelled = [&] { return ++asked > 12; };
    const Ensemble ensemble = c.motions(options);
    CHECK(ensemble.status == Ensemble::Status::cancelled);
    CHECK(ensemble.starts < 512);
    CHECK(ensemble.starts % 64 == 0);
    const orbit::Orbit third = c.orbit(test::reference_orbits[5].state, 3);
    options.cancelled = [] { return true; };
    CHECK(attractor::refute({c.exact, c.scout}, third, c.box, options).status == Refutation::Status::cancelled);
    CHECK(Ensemble{}.status == Ensemble::Status::not_run);
    CHECK(Refutation{}.status == Refutation::Status::not_run);
}

TEST_CASE("misuse of ensembles throws") {
    const Case c(2.2);
    const attractor::Systems systems{c.exact, c.scout};
    EnsembleOptions options;
    options.starts = 0;
    CHECK_THROWS_AS(attractor::find_attractors(systems, c.box, options), std::invalid_argument);
    options = {};
    options.jobs = 0;
    CHECK_THROWS_AS(attractor::find_attractors(systems, c.box, options), std::invalid_argument);
    options = {};
    options.max_cycles = 0;
    CHECK_THROWS_AS(attractor::find_attractors(systems, c.box, options), std::invalid_argument);
    options = {};
    Box reversed = c.box;
    std::swap(reversed.lower[0], reversed.upper[0]);
    CHECK_THROWS_AS(attractor::find_attractors(systems, reversed, options), std::invalid_argument);
    const orbit::Orbit saddle = c.orbit(test::reference_orbits[2].state, 1);
    REQUIRE(saddle.ok());
    CHECK_THROWS_AS(attractor::refute(systems, saddle, c.box, options), std::invalid_argument);
    CHECK_THROWS_AS(attractor::refute(systems, orbit::Orbit{}, c.box, options), std::invalid_argument);
}

TEST_CASE("a box narrower than what states resolve: its starts are classified as those of a wider one") {
    const Case c(1.9);
    EnsembleOptions options;
    options.starts = 64;
    for (const double width : {1e-6, 1e-9, 1e-12, 1e-15}) {
        CAPTURE(width);
        attractor::Box box{{0.5, 0.0, 1.0, 1.0}, {0.5, 0.0, 1.0, 1.0}};
        for (std::size_t k = 0; k < 4; ++k) { box.upper[k] += width; }
        const Ensemble ensemble = attractor::find_attractors({c.exact, c.scout}, box, options);
        CHECK(ensemble.unclassified == 0);
        REQUIRE(ensemble.attractors.size() == 1);
        CHECK(ensemble.attractors[0].starts == 64);
        CHECK(test::distance(ensemble.attractors[0].state, test::reference_orbits[0].state, 4) < 1e-12);
    }
}
