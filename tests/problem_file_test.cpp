#include "problem/nearest_name.hpp"
#include "problem/problem_error.hpp"
#include "problem/problem_file.hpp"
#include "scratch_folder.hpp"
#include "verbs/optimise/verb.hpp"
#include "verbs/orbit/orbit.hpp"
#include "verbs/verbs.hpp"

#include <doctest/doctest.h>

#include <cstdlib>
#include <string>
#include <vector>

using namespace percuss;
using design::Quantity;
using model::Key;
using problem::ProblemError;
using problem::ProblemFile;
using problem::Setting;

namespace {

const std::string nondimensional = R"(
[nondimensional]
lambda_p = 1.1
mu_ratio = 1
alpha_A = 3
alpha_B = 2
delta_A = 0.3
delta_B = 60
l = 0.8
g = 0.1
k = 2500
delta_i = 2
phi_pp = 0.4
)";

const std::string spring = R"(
[spring-mass]
mass = 2 g
damping = 0.02
stiffness = 1 kN/m
force = 10 mN
[stop]
gap = 0.5 mm
stiffness = 29 N/mm
damping = 0
)";

std::filesystem::path shipped(const std::string& name) {
    const char* source = std::getenv("PERCUSS_SOURCE_DIR");
    return std::filesystem::path(source == nullptr ? "." : source) / "problems" / name;
}

Setting option(std::string key, std::string value) { return {std::move(key), std::move(value), true}; }

ProblemFile read(const std::string& text, const std::vector<Setting>& options = {}) {
    const tests::ScratchFolder folder;
    return verbs::read_problem(folder.write("p.ini", text), options);
}

/// The message with which a text is refused, or "accepted".
std::string refusal(const std::string& text, const std::vector<Setting>& options = {}) {
    try {
        read(text, options);
    } catch (const ProblemError& error) { return error.what(); }
    return "accepted";
}

bool has(const std::string& text, const std::string& part) { return text.find(part) != std::string::npos; }

}  // namespace

TEST_CASE("the shipped actuator is the paper's") {
    const ProblemFile problem = verbs::read_problem(shipped("wu2022-actuator.ini"), {});
    const model::Specification& spec = problem.design.actuator;
    CHECK(problem.name == "wu2022-actuator");
    CHECK(spec.type == &model::membrane::si);
    CHECK(spec.value(Key::stop_gap) == 0.6e-3);
    CHECK(spec.value(Key::stop_stiffness) == 51.9e3);
    CHECK(spec.value(percuss::model::membrane::key::drive_voltage) == 3300.0);
    CHECK(spec.value(percuss::model::membrane::key::layers) == 1.0);
    CHECK_FALSE(model::has_frequency(spec));
    CHECK(problem.design.margin == 0.01);
    CHECK(problem.design.variables.empty());
}

TEST_CASE("the shipped nondimensional problem has the paper's defaults") {
    const ProblemFile problem = verbs::read_problem(shipped("wu2022-nondimensional.ini"), {});
    const auto& p = model::scale(problem.design.actuator).parameters;
    const std::array<double, 12> expected = {1.1, 1.0, 3.0, 2.0, 0.3, 60.0, 0.8, 0.1, 2500.0, 2.0, 0.4, 1.0};
    for (std::size_t i = 0; i < expected.size(); ++i) { CHECK(p[i] == expected[i]); }
    CHECK(problem::units_of(problem) == "nondimensional");
}

TEST_CASE("the shipped crawler is the main job") {
    const ProblemFile problem = verbs::read_problem(shipped("crawler.ini"), {});
    const design::Problem& design = problem.design;
    REQUIRE(design.variables.size() == 4);
    CHECK(design.variables[0].key == Key::stop_gap);
    CHECK(design.variables[0].lower == 0.2e-3);
    CHECK(design.variables[0].upper == 1.6e-3);
    CHECK_FALSE(design.variables[0].logarithmic);
    CHECK(design.variables[1].logarithmic);
    CHECK(design.variables[1].upper == 200e3);
    CHECK(design.variables[2].key == percuss::model::membrane::key::layers);
    CHECK(design.variables[2].integer);
    REQUIRE(design.objectives.size() == 1);
    CHECK(design.objectives[0].maximise);
    CHECK(design.objectives[0].quantity == Quantity::peak_force);
    REQUIRE(design.limits.size() == 4);
    CHECK(design.limits[0].upper);
    CHECK(design.limits[0].bound == 0.45e-3);
    CHECK_FALSE(design.limits[1].upper);
    CHECK(design.limits[1].quantity == Quantity::contact_time);
    CHECK(design.limits[1].bound == 0.5e-3);
    CHECK(design.limits[2].bound == 50e6);
    CHECK(design.limits[3].bound == 110.0);
    CHECK(design.single_stable == design::SingleStable::orbit);
    CHECK_NOTHROW(verbs::require_one_objective(problem.design));
    CHECK_FALSE(model::has_frequency(design.actuator));  // so orbit refuses it: see cli_test
}

TEST_CASE("the shipped oscillators are the published ones") {
    const auto soft = model::scale(verbs::read_problem(shipped("soft-impact.ini"), {}).design.actuator).parameters;
    CHECK(soft[model::spring::force] == 0.152380952381);
    CHECK(soft[model::spring::stop_stiffness] == 29.0);
    const ProblemFile duffing = verbs::read_problem(shipped("duffing.ini"), {});
    CHECK(duffing.design.actuator.law == model::StopLaw::none);
    const auto scaled = model::scale(duffing.design.actuator);
    CHECK(scaled.parameters[model::spring::omega] == doctest::Approx(1.2).epsilon(1e-15));
    CHECK(scaled.parameters[model::spring::cubic] == doctest::Approx(0.1 * 0.18 * 0.18).epsilon(1e-15));
}

TEST_CASE("options win over the file") {
    const ProblemFile problem =
        read(nondimensional + "omega = 1.9\n", {option("nondimensional.omega", "2.2"), option("drive.margin", "0")});
    CHECK(problem.design.actuator.value(Key::nd_omega) == 2.2);
    CHECK(problem.design.margin == 0.0);
    CHECK_FALSE(model::has_frequency(
        read(nondimensional + "omega = 1.9\n", {option("nondimensional.omega", "edge")}).design.actuator));
    // The two ways to give the frequency of an oscillator replace each other.
    const ProblemFile oscillator = read(spring + "[drive]\nfrequency = 50 Hz\n", {option("spring-mass.omega", "300")});
    CHECK_FALSE(oscillator.design.actuator.has(Key::drive_frequency));
    CHECK(oscillator.design.actuator.value(Key::sm_omega) == 300.0);
}

TEST_CASE("repeatable options add to the list of the file or replace their entry in it") {
    const std::string text = spring + "[design]\nvariable = stop.gap in 0.1 mm .. 1 mm\nmaximise = peak_force\n"
                                      "limit = amplitude <= 1 mm\nlimit = contact_time >= 1 ms\n";
    CHECK(read(text).design.limits.size() == 2);
    const auto added = read(text, {option("design.limit", "impulse <= 3 mN s")}).design.limits;
    REQUIRE(added.size() == 3);
    CHECK(added[2].quantity == Quantity::impulse);
    CHECK(added[2].bound == 3e-3);
    // The same quantity on the same side: replaced in its place. On the other side: a range.
    const auto replaced = read(text, {option("design.limit", "amplitude<=0.5 mm")}).design.limits;
    REQUIRE(replaced.size() == 2);
    CHECK(replaced[0].quantity == Quantity::amplitude);
    CHECK(replaced[0].bound == 0.5e-3);
    CHECK(read(text, {option("design.limit", "amplitude >= 0.2 mm")}).design.limits.size() == 3);
    // "none" clears the list; what follows it is added.
    CHECK(read(text, {option("design.limit", "none")}).design.limits.empty());
    CHECK(read(text, {option("design.limit", "none"), option("design.limit", "impulse <= 3 mN s")})
              .design.limits.size() == 1);
    CHECK(read(text, {option("design.limit", "none")}).design.variables.size() == 1);
    // Variables by their key, objectives by their quantity, whichever way they go.
    const auto varied = read(text, {option("design.variable", "stop.gap in 0.2 mm .. 2 mm"),
                                    option("design.variable", "stop.stiffness in 1 N/mm .. 9 N/mm")})
                            .design.variables;
    REQUIRE(varied.size() == 2);
    CHECK(varied[0].upper == 2e-3);
    const auto objectives = read(text, {option("design.minimise", "peak_force")}).design.objectives;
    REQUIRE(objectives.size() == 1);
    CHECK_FALSE(objectives[0].maximise);
}

TEST_CASE("comments, and the origin of what stands in lists") {
    CHECK(
        read(nondimensional + "; a comment\nomega = 1.9 ; and another # one\n").design.actuator.value(Key::nd_omega) ==
        1.9);
    const std::string text = spring + "[design]\nlimit = amplitude <= 1 mm\n";
    const ProblemFile problem = read(text, {option("design.limit", "impulse <= 3 mN s")});
    std::vector<problem::Origin> origins;
    for (const problem::ResolvedSetting& setting : problem.settings) {
        if (setting.name == "design.limit") { origins.push_back(setting.origin); }
    }
    CHECK(origins == std::vector<problem::Origin>{problem::Origin::file, problem::Origin::option});
}

TEST_CASE("defaults are filled in") {
    const ProblemFile problem = read(nondimensional);
    CHECK(problem.design.actuator.value(Key::nd_layers) == 1.0);
    CHECK(problem.design.actuator.law == model::StopLaw::kelvin_voigt);
    const verbs::OptimiserOptions defaults;
    CHECK(problem.get<verbs::OptimiserOptions>().method == defaults.method);
    CHECK(problem.get<verbs::OrbitOptions>().period == 1);
    CHECK_FALSE(problem.get<verbs::OrbitOptions>().start);
}

TEST_CASE("a variable without a value starts in the middle of its range") {
    const std::string text = "[spring-mass]\nmass = 1\ndamping = 0.1\nforce = 1\n[stop]\ndamping = 0\n[design]\n"
                             "variable = spring-mass.stiffness in 1 .. 100 log\nvariable = stop.gap in 1 mm .. 3 mm\n"
                             "variable = stop.stiffness in 1 .. 4 integer\n";
    const auto& spec = read(text).design.actuator;
    CHECK(spec.value(Key::sm_stiffness) == doctest::Approx(10.0).epsilon(1e-14));
    CHECK(spec.value(Key::stop_gap) == doctest::Approx(2e-3).epsilon(1e-14));
    CHECK(spec.value(Key::stop_stiffness) == 2.0);
}

TEST_CASE("the start of an orbit may be separated by commas or blanks") {
    const auto start =
        read(nondimensional, {option("orbit.start", "0.47, -0.15 ,1.17 1.2")}).get<verbs::OrbitOptions>().start;
    REQUIRE(start);
    CHECK(*start == std::vector<double>{0.47, -0.15, 1.17, 1.2});
    CHECK(has(refusal(nondimensional, {option("orbit.start", "0.47, -0.15")}), "has 4 numbers"));
    CHECK(has(refusal(spring, {option("orbit.start", "0.47, -0.15, 1, 2")}), "has 2 numbers"));
    CHECK(has(refusal(nondimensional, {option("orbit.start", "1, nan, 1, 1")}), "'nan'"));
}

TEST_CASE("what is wrong is refused with a hint") {
    const struct {
        std::string text;
        std::vector<std::string> parts;
    } cases[] = {
        {nondimensional + "[stop]\ngapp = 1 mm\n", {"stop.gapp", "nearest known key is stop.gap"}},
        {nondimensional + "lambda = 1\n", {"nondimensional.lambda", "nondimensional.lambda_p"}},
        {nondimensional + "g = 0.1\n", {"nondimensional.g", "twice"}},
        {nondimensional + "omega = 0\n", {"nondimensional.omega = 0", "above 0"}},
        {nondimensional + "omega = 1.9 Hz\n", {"nondimensional.omega", "1.9 Hz", "plain number"}},
        {nondimensional + "omega = nan\n", {"nondimensional.omega", "nan"}},
        {nondimensional + "this is no setting\n", {"this is no setting"}},
        {nondimensional + "[stop]\ngap = 1 mm\n", {"stop.gap", "use nondimensional.g"}},
        {nondimensional + "[drive]\nvoltage = 1 kV\n", {"drive.voltage", "use nondimensional.phi_pp"}},
        {nondimensional + "[actuator]\ninner_radius = 4 mm\n", {"nondimensional.lambda_p", "actuator.inner_radius"}},
        {nondimensional + "[actuator]\ntype = spring-mass\n", {"actuator.type = spring-mass"}},
        {nondimensional + "[actuator]\ntype = coil\n", {"actuator.type = coil", "dielectric-elastomer"}},
        {nondimensional + "[stop]\nlaw = hard\n", {"stop.law = hard", "kelvin-voigt"}},
        {nondimensional + "[stop]\nlaw = none\n", {"stop.law = none", "frequency"}},
        {nondimensional + "[drive]\nmargin = 1\n", {"drive.margin = 1", "below 0.5 (50 %)"}},
        {nondimensional + "[drive]\nmargin = -1 %\n", {"drive.margin = -1 %", "at least 0"}},
        {spring + "[spring-mass]\nmaximum = 3\n", {"spring-mass.maximum"}},
        {spring + "[material]\nshear_modulus = 3\n", {"spring-mass.mass", "material.shear_modulus"}},
        {spring + "[drive]\nvoltage = 3 V\n", {"drive.voltage", "use spring-mass.force"}},
        {spring + "[drive]\nfrequency = 3000 rpm\n", {"drive.frequency", "angle", "edge"}},
        {spring + "[drive]\nfrequency = 300 rad/s\n", {"drive.frequency", "300 rad/s", "2 pi", "47.7465 Hz"}},
        {spring + "[drive]\nmargin = 0.5\n", {"drive.margin = 0.5", "below 0.5 (50 %)"}},
        {spring + "[design]\nvariable = stop.gap in 0.2 .. 1.6 mm\n", {"no unit", "write 0.2 mm .. 1.6 mm"}},
        {spring + "[design]\nvariable = stop.gap in 0.2 mm .. 1.6\n", {"no unit", "write 0.2 mm .. 1.6 mm"}},
        {nondimensional + "[orbit]\nperiod = 65\n", {"orbit.period = 65", "at most 64"}},
        {nondimensional + "[attractors]\ncycles = 1000001\n", {"attractors.cycles", "at most 1000000"}},
        {spring + "[drive]\nfrequency = 0 Hz\n", {"drive.frequency = 0 Hz", "above 0"}},
        {spring + "[drive]\nfrequency = 3 Hz\n[spring-mass]\nomega = 3\n", {"both given"}},
        {"[spring-mass]\nmass = -2 g\n", {"spring-mass.mass = -0.002 kg", "above 0"}},
        {"[spring-mass]\nmass = 2 mm\n", {"spring-mass.mass", "2 mm", "dimension of kg"}},
        {"[spring-mass]\nmass = 2\n", {"spring-mass.damping is missing"}},
        {"[stop]\ngap = 1 mm\n", {"no actuator"}},
        {"", {"no actuator"}},
        {nondimensional + "[design]\nvariable = nondimensional.g\n", {"expected KEY in LOWER .. UPPER"}},
        {nondimensional + "[design]\nvariable = stop.gap in 1 .. 2\n", {"stop.gap", "nearest one is nondimensional.g"}},
        {nondimensional + "[design]\nvariable = nondimensional.g in 0.3 .. 0.1\n", {"reversed", "nondimensional.g"}},
        {nondimensional + "[design]\nvariable = nondimensional.g in 0 .. 0.1 log\n", {"log range", "above 0"}},
        {nondimensional + "[design]\nvariable = nondimensional.g in -1 .. 0.1\n", {"at least 0"}},
        {nondimensional + "[design]\nvariable = nondimensional.layers in 1.5 .. 4 integer\n", {"whole numbers"}},
        {nondimensional + "[design]\nvariable = nondimensional.g in 0 .. nan\n", {"nan"}},
        {nondimensional + "[design]\nmaximise = peak_farce\n", {"peak_farce", "nearest one is peak_force"}},
        {nondimensional + "[design]\nmaximise = electric_field\n", {"electric_field", "SI"}},
        {nondimensional + "[design]\nmaximise = contacts\n", {"contacts", "whole number"}},
        {nondimensional + "[design]\nlimit = amplitude < 3\n", {"amplitude < 3", "QUANTITY <= VALUE"}},
        {nondimensional + "[design]\nlimit = amplitud <= 3\n", {"nearest one is amplitude"}},
        {nondimensional + "[design]\nlimit = amplitude <= 3 mm\n", {"3 mm", "plain number"}},
        {nondimensional + "[design]\nlimit = drive_current <= 3\n", {"drive_current", "SI"}},
        {spring + "[design]\nlimit = amplitude <= 3 N\n", {"3 N", "dimension of m"}},
        {nondimensional + "[design]\nsingle_stable = yes\n", {"single_stable = yes", "orbit"}},
        {nondimensional + "[optimiser]\nmethod = newton\n", {"method = newton", "ipopt"}},
        {nondimensional + "[optimiser]\nstarts = 0\n", {"starts = 0", "at least 1"}},
        {nondimensional + "[optimiser]\nstarts = 2.5\n", {"starts = 2.5", "whole number"}},
        {nondimensional + "[optimiser]\ntolerance = 0\n", {"optimiser.tolerance = 0", "above 0"}},
        {nondimensional + "[solver]\ntolerance = 0\n", {"solver.tolerance = 0", "above 1e-16"}},
        {nondimensional + "[solver]\ntolerance = nan\n", {"solver.tolerance = nan"}},
        {nondimensional + "[solver]\nintegrator = euler\n", {"integrator = euler", "taylor"}},
        {nondimensional + "[orbit]\nperiod = 0\n", {"orbit.period = 0", "at least 1"}},
    };
    for (const auto& each : cases) {
        const std::string message = refusal(each.text);
        CAPTURE(each.text);
        CAPTURE(message);
        CHECK(message.find('\n') == std::string::npos);
        for (const std::string& part : each.parts) {
            CAPTURE(part);
            CHECK(has(message, part));
        }
    }
}

TEST_CASE("files that cannot be read are refused") {
    const tests::ScratchFolder folder;
    CHECK_THROWS_AS(verbs::read_problem(folder.path() / "absent.ini", {}), ProblemError);
    CHECK_THROWS_AS(verbs::read_problem(folder.path(), {}), ProblemError);
}

TEST_CASE("no stop, no stop keys") {
    const std::string text = "[spring-mass]\nmass = 1\ndamping = 0.1\nstiffness = 1\nforce = 1\nomega = 2\n";
    CHECK(has(refusal(text), "stop.gap is missing"));
    CHECK(refusal(text + "[stop]\nlaw = none\n") == "accepted");
    CHECK(has(refusal(text + "[stop]\nlaw = none\n[design]\nvariable = stop.gap in 1 .. 2\n"), "no stop to vary"));
}

TEST_CASE("optimise wants variables and one objective") {
    const auto complaint = [](const std::string& design) -> std::string {
        try {
            verbs::require_one_objective(read(nondimensional + "[design]\n" + design).design);
        } catch (const ProblemError& error) { return error.what(); }
        return "";
    };
    const std::string variable = "variable = nondimensional.g in 0.05 .. 0.2\n";
    CHECK(complaint(variable + "maximise = peak_force\n").empty());
    CHECK(has(complaint("maximise = peak_force\n"), "design.variable"));
    CHECK(has(complaint(variable), "design.maximise"));
    CHECK(has(complaint(variable + "maximise = peak_force\nminimise = amplitude\n"), "exactly one"));
    CHECK(has(refusal(nondimensional + "[design]\n" + variable + variable), "variable already"));
    CHECK(has(refusal(nondimensional + "[design]\nmaximise = amplitude\nminimise = amplitude\n"), "objective already"));
}

TEST_CASE("inspection collects every trouble and marks the settings") {
    const tests::ScratchFolder folder;
    const auto file =
        folder.write("p.ini", "[spring-mass]\nmass = -1\ndamping = 3 mm\nforce = 1\n[stop]\ngap = 1 mm\n");
    const ProblemFile problem = verbs::inspect_problem(file, {});
    // mass out of range, damping of the wrong dimension, stiffness and two keys of the stop missing
    CHECK(problem.troubles.size() == 5);
    int marked = 0;
    for (const problem::ResolvedSetting& setting : problem.settings) { marked += setting.trouble.empty() ? 0 : 1; }
    CHECK(marked == 5);
    CHECK_THROWS_AS(verbs::read_problem(file, {}), ProblemError);
}

TEST_CASE("the hash tells problems apart and units and spelling do not matter") {
    const std::string base = problem::problem_hash(read(spring));
    std::string other = spring;
    other.replace(other.find("0.5 mm"), 6, "500 um");
    CHECK(problem::problem_hash(read(other)) == base);
    CHECK(problem::problem_hash(read(spring, {option("stop.gap", "0.0005")})) == base);
    CHECK(problem::problem_hash(read(spring, {option("stop.gap", "0.51 mm")})) != base);
    CHECK(problem::problem_hash(read(spring, {option("stop.law", "no-tension")})) != base);
    CHECK(problem::problem_hash(read(spring, {option("design.limit", "amplitude <= 1 mm")})) != base);
    // Bounds count to the last digit, though people see six.
    const auto limited = [](const char* bound) {
        return problem::problem_hash(read(spring, {option("design.limit", std::string("amplitude <= ") + bound)}));
    };
    CHECK(limited("0.001") != limited("0.001000000001"));
    const auto ranged = [](const char* upper) {
        return problem::problem_hash(
            read(spring, {option("design.variable", std::string("stop.gap in 0 .. ") + upper)}));
    };
    CHECK(ranged("0.001") != ranged("0.001000000001"));
    CHECK(base.size() == 16);
}

TEST_CASE("every key has its line in the table") {
    for (std::size_t i = 0; i < model::key_count; ++i) {
        CHECK(problem::find_row(verbs::sections(), model::key_info(static_cast<Key>(i)).name) != nullptr);
    }
    CHECK(problem::find_row(verbs::sections(), "design.limit")->repeatable());
    CHECK(problem::find_row(verbs::sections(), "stop.gapp") == nullptr);
    // Caps are told.
    const auto allowed = [](const char* name) { return problem::find_row(verbs::sections(), name)->allowed; };
    CHECK(allowed("orbit.period") == "whole number, at least 1, at most 64");
    CHECK(allowed("attractors.cycles") == "whole number, at least 1, at most 1000000");
    CHECK(allowed("drive.margin") == "at least 0, below 0.5 (50 %)");
    // Defaults are those of the structs.
    CHECK(problem::find_row(verbs::sections(), "orbit.period")->fallback ==
          std::to_string(verbs::OrbitOptions().period));
}

TEST_CASE("edit distance") {
    CHECK(problem::edit_distance("", "abc") == 3);
    CHECK(problem::edit_distance("abc", "abc") == 0);
    CHECK(problem::edit_distance("kitten", "sitting") == 3);
    CHECK(problem::edit_distance("gap", "gpa") == 1);
    const std::vector<std::string> names = {"stop.gap", "stop.damping", "drive.voltage"};
    CHECK(problem::nearest_name("gap", names) == "stop.gap");
    CHECK(problem::nearest_name("drive.volts", names) == "drive.voltage");
}
