// What demand-driven evaluation saves: each group compares runs that are asked for more and more with the leanest one.
//
//   skip_what_is_not_needed [problem.ini]         the table; the default problem is problems/crawler.ini
//   skip_what_is_not_needed --loop CASE COUNT     runs one case COUNT times and nothing else, for counting instructions
//
// Criteria: a sensitivity costs less than the plain run that a finite difference would need; a scene without Maxwell
// branches is cheaper than the full one with mu_ratio = 0; a stop that is switched off (StopMode::off) costs less than
// 1 % more than one that the scene does not have (law none); peak_force alone costs less than all quantities, gradients
// less than one more evaluation.
//
// Reference: the first line of each group. No accuracy is at stake here: the orbits are the same in all lines.
//
// Machine: any x86-64. Processor time of one thread, interleaved rounds in one process; 1 % is below what shared cores
// resolve, so instructions decide there. Valgrind 3.19 has no AVX-512, hides it from programs, and so counts the v3
// kernels. The difference of two counts leaves out start-up:
//
//   for n in 1000 3000; do
//     valgrind --tool=callgrind --callgrind-out-file=/dev/null build-bench/bench/skip_what_is_not_needed --loop CASE $n
//   done
//
// CASE is the last column of the table.

#include "design/evaluate.hpp"
#include "model/membrane/membrane.hpp"
#include "scenes.hpp"
#include "timing.hpp"
#include "verbs/verbs.hpp"

#include <cstdio>
#include <cstdlib>
#include <deque>
#include <exception>
#include <filesystem>

namespace {

using namespace percuss;
using namespace percuss::bench;

constexpr double tolerance = 1e-13;

struct Case {
    std::string label;
    std::string name;  ///< for --loop
    std::function<void()> work;
};

struct Group {
    std::string title;
    std::vector<Case> cases;
};

/// A run over one period and all that it refers to.
struct Run {
    SceneKind kind;
    flow::ParameterVector parameters = paper_defaults;
    flow::Request request;
    std::vector<flow::Direction> lanes;
    std::shared_ptr<flow::Integrator> integrator;
    flow::Result result;

    Run(const SceneKind& scene, const flow::ParameterVector& p, const flow::State& state, int lane_count = 0,
        std::uint32_t observe = flow::observe_nothing, flow::StopMode stop = flow::StopMode::hybrid)
        : kind(scene),
          parameters(p),
          request(cycles_from(state)),
          lanes(directions(scene.scene->states, lane_count)),
          integrator(make(scene, "taylor", tolerance)) {
        request.directions = lanes;
        request.observe = observe;
        request.stop = stop;
    }
    void operator()() { integrator->run(parameters, request, result); }
};

class Cases {
public:
    void group(std::string title) { groups_.push_back({std::move(title), {}}); }
    void add(std::string label, std::string name, std::function<void()> work) {
        groups_.back().cases.push_back({std::move(label), std::move(name), std::move(work)});
    }
    template <class... Arguments>
    void add_run(std::string label, std::string name, Arguments&&... arguments) {
        runs_.push_back(std::make_unique<Run>(std::forward<Arguments>(arguments)...));
        add(std::move(label), std::move(name), [run = runs_.back().get()] { (*run)(); });
    }
    [[nodiscard]] const std::vector<Group>& groups() const { return groups_; }

private:
    std::vector<Group> groups_;
    std::vector<std::unique_ptr<Run>> runs_;
};

void add_runs(Cases& cases) {
    const SceneKind full;
    cases.group("Sensitivities: one period of the impacting orbit");
    for (int lanes : {0, 4, 8}) {
        cases.add_run(std::to_string(lanes) + " lanes", "lanes" + std::to_string(lanes), full, paper_defaults,
                      paper_orbit, lanes);
    }

    struct Mask {
        const char* name;
        std::uint32_t mask;
    };
    constexpr std::array<Mask, 8> masks = {{{"nothing", flow::observe_nothing},
                                            {"extrema", flow::observe_extrema},
                                            {"force", flow::observe_force},
                                            {"acceleration", flow::observe_acceleration},
                                            {"field", flow::observe_peak(model::membrane::field)},
                                            {"current", flow::observe_peak(model::membrane::current)},
                                            {"energy", flow::observe_energy},
                                            {"all", flow::observe_all}}};
    for (int lanes : {0, 8}) {
        cases.group("Observables: the same period with " + std::to_string(lanes) + " lanes");
        for (const Mask& mask : masks) {
            cases.add_run(mask.name, std::string(mask.name) + std::to_string(lanes), full, paper_defaults, paper_orbit,
                          lanes, mask.mask);
        }
    }

    const flow::ParameterVector elastic = with(paper_defaults, model::membrane::mu_ratio, 0.0);
    SceneKind two_states = full;
    two_states.scene = &model::membrane::elastic;
    const flow::State start = {paper_orbit[0], paper_orbit[1], 0.0, 0.0};
    for (int lanes : {0, 8}) {
        cases.group("No Maxwell branches (mu_ratio = 0): one period, " + std::to_string(lanes) + " lanes");
        cases.add_run("own kernel", "elastic" + std::to_string(lanes), two_states, elastic, start, lanes);
        cases.add_run("full kernel", "viscous" + std::to_string(lanes), full, elastic, paper_orbit, lanes);
    }

    SceneKind lawless = full;
    lawless.law = model::ContactLaw::none;
    const flow::ParameterVector clear = with(paper_defaults, model::membrane::omega, clear_omega);
    const flow::ParameterVector far = with(clear, model::membrane::gap, 10.0);
    cases.group("The stop: one period of an orbit that never touches it");
    cases.add_run("law none", "none", lawless, clear, clear_orbit);
    cases.add_run("kelvin-voigt, StopMode::off", "off", full, clear, clear_orbit, 0, flow::observe_nothing,
                  flow::StopMode::off);
    cases.add_run("kelvin-voigt, hybrid, far away", "far", full, far, clear_orbit);
    cases.add_run("kelvin-voigt, hybrid, in reach", "near", full, clear, clear_orbit);
}

/// Evaluators and demands live as long as the program.
struct Evaluations {
    std::deque<design::Evaluator> evaluators;
    std::deque<design::Demand> demands;
};

design::Problem read_design(const std::filesystem::path& file) {
    design::Problem problem = verbs::read_problem(file, {}).design;
    if (problem.actuator.type == &model::membrane::si) {  // near the optimum of crawler.ini
        problem.actuator.set(model::membrane::key::layers, 3.0);
        problem.actuator.set(model::Key::stop_gap, 0.35e-3);
        problem.actuator.set(model::Key::stop_stiffness, 95e3);
        problem.actuator.set(percuss::model::membrane::key::drive_voltage, 3500.0);
    }
    return problem;
}

void add_evaluations(Cases& cases, Evaluations& kept, const std::filesystem::path& file) {
    design::Problem problem = read_design(file);
    const std::vector<design::Quantity> force = {design::Quantity::peak_force};
    const auto reported = design::reported_quantities(*problem.actuator.type);
    const std::vector<design::Quantity> everything(reported.begin(), reported.end());
    std::vector<model::Key> variables;
    for (const design::DesignVariable& v : problem.variables) { variables.push_back(v.key); }

    const auto evaluator = [&](design::SingleStable tier) -> const design::Evaluator& {
        problem.single_stable = tier;
        return kept.evaluators.emplace_back(problem);
    };
    const design::Evaluator& plain = evaluator(design::SingleStable::off);
    const design::Evaluator& checked = evaluator(design::SingleStable::orbit);
    const auto add = [&](const char* label, const char* name, const design::Evaluator& who, design::Demand demand) {
        const design::Demand& what = kept.demands.emplace_back(std::move(demand));
        const design::Evaluation once = who.evaluate(what);
        char text[160];
        std::snprintf(text, sizeof text, "%s (%.0f periods)", label, once.periods);
        cases.add(text, name, [&who, &what] { static_cast<void>(who.evaluate(what)); });
    };
    cases.group("design::Evaluator::evaluate at the edge, " + file.filename().string());
    add("peak_force, single_stable off", "force", plain, {force, {}, false});
    add("peak_force, single_stable orbit", "orbit", checked, {force, {}, false});
    add("all quantities, orbit", "quantities", checked, {everything, {}, false});
    add("peak_force, gradients, orbit", "gradients", checked, {force, variables, false});
    add("all quantities, gradients, orbit", "optimise", checked, {everything, variables, false});
    add("the same with error estimates", "estimates", checked, {everything, variables, true});
}

void print(const Group& group) {
    std::vector<Contestant> contestants;
    for (const Case& c : group.cases) { contestants.push_back({c.name, c.work}); }
    const Times times = interleave(contestants, {.rounds = 100, .sample_seconds = 1e-3});
    std::printf("%s\n", group.title.c_str());
    for (std::size_t i = 0; i < group.cases.size(); ++i) {
        std::printf("  %-50s %8.3f  (median %7.3f) %10.1f us  %s\n", group.cases[i].label.c_str(),
                    times.ratio_of_minima(i, 0), times.median_ratio(i, 0), times.microseconds(i),
                    group.cases[i].name.c_str());
    }
    std::printf("\n");
}

bool loop(const Cases& cases, const std::string& name, long count) {
    for (const Group& group : cases.groups()) {
        for (const Case& c : group.cases) {
            if (c.name != name) { continue; }
            for (long i = 0; i < count; ++i) { c.work(); }
            return true;
        }
    }
    return false;
}

int run(const std::vector<std::string>& arguments) {
    const bool looping = arguments.size() == 3 && arguments[0] == "--loop";
    if (!looping && arguments.size() > 1) {
        std::fprintf(stderr, "usage: skip_what_is_not_needed [problem.ini | --loop CASE COUNT]\n");
        return 2;
    }
    const std::filesystem::path file = looping || arguments.empty() ? "problems/crawler.ini" : arguments[0];
    Cases cases;
    Evaluations kept;
    add_runs(cases);
    if (looping && loop(cases, arguments[1], std::atol(arguments[2].c_str()))) { return 0; }
    add_evaluations(cases, kept, file);
    if (looping) {
        if (loop(cases, arguments[1], std::atol(arguments[2].c_str()))) { return 0; }
        std::fprintf(stderr, "no case is called %s\n", arguments[1].c_str());
        return 2;
    }
    for (const Group& group : cases.groups()) { print(group); }
    return 0;
}

}  // namespace

int main(int count, char** values) {
    try {
        return run({values + 1, values + count});
    } catch (const std::exception& error) {
        std::fprintf(stderr, "%s\n", error.what());
        return 2;
    }
}
