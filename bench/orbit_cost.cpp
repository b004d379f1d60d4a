// What a converged orbit costs, against ARKODE and CVODE.
//
// Criterion: at an achieved error of 1e-10 the Taylor integrator is at least 10 times faster than the better of ARKODE
// (explicit Runge-Kutta, Fehlberg 13-7-8) and CVODE (BDF; CVODES for sensitivities), without and with sensitivities.
// Exit status 0 when it is, 1 when it is not.
//
// What runs: the period-1 impacting orbit of the dielectric elastomer actuator at omega = 1.9 and the defaults of the
// paper, from a start that is off by two percent of the stroke, in four jobs:
//
//   one period        the flow alone, from the orbit's state
//   orbit by runs     no sensitivities anywhere: Newton's method with its Jacobian from plain runs by forward
//                     differences, five runs per iteration
//   orbit             orbit::find_orbit: damped Newton with the monodromy matrix from the integrator's own
//   sensitivities orbit, gradients  the same, then orbit::portray: derivatives of the orbit and of the five force
//   observables along
//                     8 parameters
//
// The bar applies to the last three. Each integrator runs each job at its own tolerance: the loosest of a scan, in
// quarters of a decade, at which this job and all tighter ones down to a factor of 30 stay below the error asked for,
// so that no lucky hit counts. Both stopping tolerances of Newton are the same for all.
//
// Error: of the state, largest component, against reference/dea.json (see scenes.hpp; good to 1e-14). For gradients
// also the largest error of d log(observable) / d log(parameter) against the Taylor integrator at tolerance 1e-16,
// whose distance from the Runge-Kutta method at 1e-14 is printed.
//
// Fairness: the SUNDIALS contestants integrate a right-hand side that was rearranged for speed (lean_membranes.hpp);
// the one that percuss ships, which evaluates the printed equations, runs along as "(printed)". The Taylor kernels use
// what the processor has; "taylor v2" runs along to show what is left with SSE alone, which is what Debian's SUNDIALS
// is compiled for.
//
// Machine: any x86-64; the numbers in commit messages and reports are from two shared cores of an AMD EPYC (Zen 4).
// Times are processor time of one thread; the ratios of minima over interleaved rounds are what counts.

#include "flow/sundials.hpp"
#include "lean_membranes.hpp"
#include "orbit/orbit.hpp"
#include "scenes.hpp"
#include "timing.hpp"

#include <cstdio>
#include <functional>
#include <limits>
#include <optional>

namespace {

using namespace percuss;
using namespace percuss::bench;

constexpr double target_error = 1e-10;
constexpr double bar = 10.0;
constexpr flow::State start = {0.28641053480900, -0.05307487486239, 1.17903265118641, 1.19539597555165};
/// lambda_p, delta_A, delta_B, l, g, k, delta_i, phi_pp
constexpr std::array<int, 8> keys = {0, 4, 5, 6, 7, 8, 9, 10};
constexpr std::array<orbit::ObservableIndex, 5> forces = {orbit::peak_force, orbit::impact_velocity,
                                                          orbit::contact_time, orbit::impulse, orbit::stop_work};

struct Peer {
    std::string name;
    std::function<std::unique_ptr<flow::Integrator>(double)> make;
    bool rival = false;  ///< one of those that the bar speaks of
};

std::vector<Peer> peers() {
    const auto taylor = [](std::string_view set) {
        return [set](double tolerance) { return make({}, "taylor", tolerance, set); };
    };
    const auto lean = std::make_shared<LeanMembranes>(model::ContactLaw::kelvin_voigt);
    const std::shared_ptr<const flow::RightHandSide> printed =
        kernels::make_plain_system(model::membrane::viscous, model::ContactLaw::kelvin_voigt);
    std::vector<Peer> list = {
        {"taylor", taylor("auto")},
        {"arkode", [lean](double tolerance) { return flow::make_erk(lean, tolerance); }, true},
        {"cvode", [lean](double tolerance) { return flow::make_cvode(lean, tolerance); }, true},
        {"arkode (printed)", [printed](double tolerance) { return flow::make_erk(printed, tolerance); }, true},
        {"cvode (printed)", [printed](double tolerance) { return flow::make_cvode(printed, tolerance); }, true},
    };
    const auto sets = kernels::instruction_sets();
    if (std::find(sets.begin(), sets.end(), "v2") != sets.end()) { list.push_back({"taylor v2", taylor("v2")}); }
    return list;
}

/// State after the job, and what the job found on the way.
struct Outcome {
    bool ok = false;
    flow::State state{};
    orbit::Portrait portrait;
};

std::vector<flow::ParameterVector> parameter_directions() {
    std::vector<flow::ParameterVector> list;
    for (int key : keys) { list.push_back(orbit::unit_direction(key)); }
    return list;
}

Outcome one_period(const flow::System& system) {
    flow::Result result;
    system.run(cycles_from(paper_orbit), result);
    return {result.status == flow::Status::ok, result.state, {}};
}

/// Newton's method as in orbit::find_orbit, with forward differences for the Jacobian.
Outcome orbit_by_runs(const flow::System& system) {
    constexpr double difference = 1e-6;
    const orbit::NewtonOptions options;
    const orbit::ReturnMap map;
    const int n = system.states();
    const auto defect = [&](const numerics::SmallVector& y) -> std::optional<numerics::SmallVector> {
        const orbit::Image image = orbit::apply(system, map, orbit::to_state(y), orbit::Differentiate::nothing);
        if (!image.ok()) { return std::nullopt; }
        return orbit::to_vector(system, image.state) - y;
    };
    numerics::SmallVector y = orbit::to_vector(system, start);
    auto f = defect(y);
    for (int iteration = 0; f && iteration < options.max_iterations; ++iteration) {
        numerics::SmallMatrix jacobian(n, n);
        for (int k = 0; k < n; ++k) {
            numerics::SmallVector moved = y;
            moved[k] += difference;
            const auto g = defect(moved);
            if (!g) { return {}; }
            jacobian.col(k) = (*g - *f) / difference;
        }
        const numerics::SmallVector step = jacobian.partialPivLu().solve(-*f);
        const double scale = 1.0 + y.norm();
        if (f->norm() <= options.residual_tolerance * scale && step.norm() <= options.step_tolerance * scale) {
            return {true, orbit::to_state(y + step), {}};
        }
        const double before = f->norm();
        double fraction = 1.0;
        for (int halving = 0; halving <= options.max_halvings; ++halving, fraction *= 0.5) {
            f = defect(y + fraction * step);
            if (f && f->norm() < (1.0 - 0.1 * fraction) * before) { break; }
        }
        y += fraction * step;
    }
    return {};
}

Outcome orbit_by_sensitivities(const flow::System& system) {
    const orbit::Orbit found = orbit::find_orbit(system, {}, start);
    return {found.ok(), found.state, {}};
}

Outcome orbit_with_gradients(const flow::System& system) {
    static const std::vector<flow::ParameterVector> directions = parameter_directions();
    const orbit::Orbit found = orbit::find_orbit(system, {}, start);
    if (!found.ok()) { return {}; }
    Outcome outcome{true, found.state, orbit::portray(system, found, directions, flow::observe_force)};
    outcome.ok = outcome.portrait.ok();
    return outcome;
}

/// Largest error of an observable or of its derivative, both relative to the observable, per relative change of the
/// parameter.
double gradient_error(const orbit::Portrait& portrait, const orbit::Portrait& reference) {
    double worst = 0.0;
    for (orbit::ObservableIndex q : forces) {
        const double size = std::abs(reference.image.observed[q].value);
        worst = std::max(worst, std::abs(portrait.image.observed[q].value - reference.image.observed[q].value) / size);
        for (std::size_t i = 0; i < keys.size(); ++i) {
            const int column = static_cast<int>(i);
            const double d = portrait.total(q, column) - reference.total(q, column);
            worst = std::max(worst, std::abs(d * paper_defaults[at(keys[i])]) / size);
        }
    }
    return worst;
}

const orbit::Portrait& reference_portrait() {
    static const orbit::Portrait portrait = [] {
        const auto integrator = make({}, "taylor", 1e-16);
        return orbit_with_gradients({integrator.get(), paper_defaults, nullptr}).portrait;
    }();
    return portrait;
}

struct Job {
    const char* name;
    Outcome (*run)(const flow::System&);
    bool barred = true;
    bool gradients = false;

    [[nodiscard]] double error(const flow::Integrator& integrator) const {
        const Outcome outcome = run({&integrator, paper_defaults, nullptr});
        if (!outcome.ok) { return std::numeric_limits<double>::infinity(); }
        const double of_state = distance(outcome.state, paper_orbit);
        return gradients ? std::max(of_state, gradient_error(outcome.portrait, reference_portrait())) : of_state;
    }
};

struct Setting {
    double tolerance = 0.0;
    double error = std::numeric_limits<double>::infinity();
    [[nodiscard]] bool found() const { return tolerance > 0.0; }
};

/// The loosest tolerance at which the job reaches the target for good.
Setting loosest(const Job& job, const Peer& peer) {
    constexpr int per_decade = 4;
    constexpr int confirmed_by = 6;  // tighter ones in a row: a factor of 30
    Setting setting;
    int kept = 0;
    for (double tolerance : tolerances(1e-4, 1e-15, per_decade)) {
        const double error = job.error(*peer.make(tolerance));
        if (!(error <= target_error)) {
            setting = {};
            kept = 0;
            continue;
        }
        if (kept++ == 0) { setting = {tolerance, error}; }
        if (kept > confirmed_by) { break; }
    }
    return setting;
}

/// Prints one job's table; false when the bar applies and is missed.
bool compare(const Job& job, const std::vector<Peer>& all) {
    std::vector<Contestant> contestants;
    std::vector<std::size_t> entered;
    std::vector<Setting> settings;
    std::vector<std::unique_ptr<flow::Integrator>> integrators;
    for (std::size_t i = 0; i < all.size(); ++i) {
        settings.push_back(loosest(job, all[i]));
        if (!settings.back().found()) { continue; }
        integrators.push_back(all[i].make(settings.back().tolerance));
        const flow::Integrator* integrator = integrators.back().get();
        contestants.push_back({all[i].name, [integrator, &job] { job.run({integrator, paper_defaults, nullptr}); }});
        entered.push_back(i);
    }
    if (entered.empty() || entered.front() != 0) {
        std::printf("%s: the Taylor integrator does not reach %.0e\n\n", job.name, target_error);
        return false;
    }
    const Times times = interleave(contestants);

    std::printf("%s\n  %-18s %10s %10s %12s %9s %9s %9s\n", job.name, "", "tolerance", "error", "microseconds", "ratio",
                "median", "lowest");
    double better = std::numeric_limits<double>::infinity();
    for (std::size_t c = 0; c < contestants.size(); ++c) {
        const Setting& setting = settings[entered[c]];
        std::printf("  %-18s %10.1e %10.1e %12.1f %9.2f %9.2f %9.2f\n", contestants[c].name.c_str(), setting.tolerance,
                    setting.error, times.microseconds(c), times.ratio_of_minima(c, 0), times.median_ratio(c, 0),
                    times.lowest_ratio(c, 0));
        if (all[entered[c]].rival) { better = std::min(better, times.ratio_of_minima(c, 0)); }
    }
    for (std::size_t i = 0; i < all.size(); ++i) {
        if (!settings[i].found()) { std::printf("  %-18s does not reach %.0e\n", all[i].name.c_str(), target_error); }
    }
    const bool pass = better >= bar;
    if (job.barred) {
        std::printf("  %s: %.1f times faster than the better of them, asked for %.0f\n\n", pass ? "PASS" : "FAIL",
                    better, bar);
    } else {
        std::printf("\n");
    }
    return pass || !job.barred;
}

}  // namespace

int main() {
    const std::array<Job, 4> jobs = {{
        {"one period", one_period, false},
        {"orbit by runs", orbit_by_runs},
        {"orbit", orbit_by_sensitivities},
        {"orbit, gradients", orbit_with_gradients, true, true},
    }};
    const std::vector<Peer> all = peers();
    const auto tight = make({}, "erk", 1e-14);
    const Outcome check = orbit_with_gradients({tight.get(), paper_defaults, nullptr});
    std::printf(
        "Achieved error at most %.0e; kernels %s. Ratios: time in units of taylor's; ratio of minima, median and\n"
        "lowest of single rounds. Reference gradients against arkode at 1e-14: %.1e\n\n",
        target_error, std::string(kernels::instruction_set_in_use("auto")).c_str(),
        gradient_error(check.portrait, reference_portrait()));
    bool pass = true;
    for (const Job& job : jobs) { pass = compare(job, all) && pass; }
    return pass ? 0 : 1;
}
