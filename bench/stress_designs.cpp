// Random designs over wide ranges, each evaluated with the sampled uniqueness check (tier 2), and those called unique
// checked again by brute force:
//
//   stress_designs [designs] [seed] [jobs] [first] [rows.csv]      (2000, 1, 1, 0, no file)
//
// k 1e2..1e6, g 0.01..0.4, delta_A 0.02..1, delta_B 5..500 log-uniform; phi_pp 0.1..0.7, delta_i 0..20 uniform;
// layers 1..8; both stop laws in turn; everything else as in problems/wu2022-nondimensional.ini. Design i is a function
// of the seed and i alone: "1 SEED 1 I" looks at it again.
//
// Asked of every design: status, verdict, all quantities with gradients to the seven keys above and error estimates.
// Criteria: every design returns within `budget` seconds of processor time; every number that a status promises is
// finite; fewer than 1 % failed; of those called unique at most 1 % refuted, and of the refuted at least 95 % with a
// share of starts elsewhere below missed_share_bound. Exit status 1 when one fails.
//
// The check again (brute_force.hpp): `taylor_starts` starts of every design called unique with the Taylor integrator at
// 1e-11, and `erk_starts` of those whose number divides by `erk_every` with ARKODE's explicit Runge-Kutta method at
// 1e-9; both with generator and seeds other than those of the evaluation. A design is refuted when a start does not
// arrive or cannot be followed; its share is then measured with `share_starts`.

#include "brute_force.hpp"
#include "design/evaluate.hpp"
#include "design/integrators.hpp"
#include "kernels/kernels.hpp"
#include "model/membrane/membrane.hpp"
#include "model/specification.hpp"
#include "timing.hpp"

#include <atomic>
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <map>
#include <mutex>
#include <random>
#include <string>
#include <thread>

namespace {

using namespace percuss;
using namespace percuss::bench;
using design::Evaluation;
using design::EvaluationStatus;
using design::Verdict;
using model::Key;

constexpr double budget = 20.0;
constexpr long taylor_starts = 128;
constexpr long erk_starts = 16;
constexpr long erk_every = 13;
constexpr long share_starts = 2048;

constexpr std::array varied = {percuss::model::membrane::key::nd_stiffness, percuss::model::membrane::key::nd_gap,
                               percuss::model::membrane::key::nd_voltage,   percuss::model::membrane::key::nd_layers,
                               percuss::model::membrane::key::nd_delta_a,   percuss::model::membrane::key::nd_delta_b,
                               percuss::model::membrane::key::nd_damping};

model::Specification base(model::ContactLaw law) {
    model::Specification spec;
    spec.type = &model::membrane::nondimensional;
    spec.law = law;
    spec.set(percuss::model::membrane::key::nd_lambda_p, 1.1);
    spec.set(percuss::model::membrane::key::nd_mu_ratio, 1.0);
    spec.set(percuss::model::membrane::key::nd_alpha_a, 3.0);
    spec.set(percuss::model::membrane::key::nd_alpha_b, 2.0);
    spec.set(percuss::model::membrane::key::nd_length, 0.8);
    return spec;
}

model::ContactLaw law_of(long i) {
    return i % 2 == 0 ? model::ContactLaw::kelvin_voigt : model::ContactLaw::no_tension;
}

model::Specification draw(std::uint64_t seed, long i) {
    std::seed_seq seeds{seed, static_cast<std::uint64_t>(i)};
    std::mt19937_64 generator(seeds);
    const auto uniform = [&](double low, double high) {
        return low + (high - low) * static_cast<double>(generator() >> 11U) * 0x1.0p-53;
    };
    const auto logarithmic = [&](double low, double high) { return std::exp(uniform(std::log(low), std::log(high))); };
    model::Specification spec = base(law_of(i));
    spec.set(percuss::model::membrane::key::nd_stiffness, logarithmic(1e2, 1e6));
    spec.set(percuss::model::membrane::key::nd_gap, logarithmic(0.01, 0.4));
    spec.set(percuss::model::membrane::key::nd_voltage, uniform(0.1, 0.7));
    spec.set(percuss::model::membrane::key::nd_layers, std::floor(uniform(1.0, 9.0)));
    spec.set(percuss::model::membrane::key::nd_delta_a, logarithmic(0.02, 1.0));
    spec.set(percuss::model::membrane::key::nd_delta_b, logarithmic(5.0, 500.0));
    spec.set(percuss::model::membrane::key::nd_damping, uniform(0.0, 20.0));
    return spec;
}

struct Row {
    long number = 0;
    model::Specification spec;
    Evaluation evaluation;
    double cpu = 0.0;   ///< processor seconds of the evaluation
    double wall = 0.0;  ///< its seconds
    bool finite = false;
    std::string error;  ///< of an exception
    BruteForce taylor;
    BruteForce erk;
    BruteForce share;

    [[nodiscard]] bool is_unique() const {
        return evaluation.status == EvaluationStatus::ok && evaluation.uniqueness.verdict == Verdict::unique &&
               evaluation.uniqueness.tier == 2;
    }
    [[nodiscard]] bool is_refuted() const { return taylor.elsewhere + taylor.lost + erk.elsewhere + erk.lost > 0; }
};

/// The Evaluators of both stop laws; the demand.
struct Bench {
    design::Evaluator kelvin_voigt = make(model::ContactLaw::kelvin_voigt);
    design::Evaluator no_tension = make(model::ContactLaw::no_tension);
    design::Demand demand;

    Bench() {
        const auto quantities = design::reported_quantities(model::membrane::nondimensional);
        demand.quantities.assign(quantities.begin(), quantities.end());
        demand.gradients.assign(varied.begin(), varied.end());
        demand.error_estimates = true;
    }
    static design::Evaluator make(model::ContactLaw law) {
        design::Problem problem;
        problem.actuator = draw(0, 0);
        problem.actuator.law = law;
        problem.single_stable = design::SingleStable::sampled;
        return design::Evaluator(problem);
    }
    [[nodiscard]] const design::Evaluator& of(const model::Specification& spec) const {
        return spec.law == model::ContactLaw::kelvin_voigt ? kelvin_voigt : no_tension;
    }
};

bool all_finite(const std::vector<double>& list) {
    return std::all_of(list.begin(), list.end(), [](double v) { return std::isfinite(v); });
}

/// Whether every number is there that the status promises. ok and not_unique promise everything asked for.
bool numbers_are_good(const Evaluation& e, const design::Demand& demand) {
    if (e.status == EvaluationStatus::not_run) { return false; }
    if (e.status != EvaluationStatus::ok && e.status != EvaluationStatus::not_unique) { return !e.reason.empty(); }
    bool good = std::isfinite(e.operating_point.omega) && std::isfinite(e.operating_point.edge_omega) &&
                all_finite(e.orbit.state) && e.orbit.state.size() == 4 && std::isfinite(e.orbit.residual) &&
                std::isfinite(e.orbit.x_max) && std::isfinite(e.orbit.x_min) && all_finite(e.gradients.edge_omega);
    for (const design::Quantity q : demand.quantities) {
        const auto at = static_cast<std::size_t>(q);
        good = good && std::isfinite(e.quantities[at]) && std::isfinite(e.error_estimates[at]);
        if (design::quantity_info(q).smooth && q != design::Quantity::max_multiplier) {
            good = good && e.gradients.quantity[at].size() == demand.gradients.size() &&
                   all_finite(e.gradients.quantity[at]);
        }
    }
    for (const design::Attractor& a : e.uniqueness.attractors) {
        good = good && all_finite(a.state) && std::isfinite(a.peak_force) && std::isfinite(a.amplitude);
    }
    return good;
}

void evaluate(const Bench& bench, Row& row) {
    const auto begun = std::chrono::steady_clock::now();
    const double cpu = thread_seconds();
    try {
        row.evaluation = bench.of(row.spec).evaluate(row.spec, bench.demand);
        row.finite = numbers_are_good(row.evaluation, bench.demand);
    } catch (const std::exception& e) { row.error = e.what(); }
    row.cpu = thread_seconds() - cpu;
    row.wall = std::chrono::duration<double>(std::chrono::steady_clock::now() - begun).count();
}

BruteForce follow(const Row& row, const char* integrator, double tolerance, const BruteForceOptions& options) {
    const auto kernel =
        kernels::make_integrator(model::membrane::viscous, row.spec.law,
                                 {.integrator = integrator, .tolerance = tolerance, .instruction_set = "auto"});
    flow::System system{kernel.get(), model::scale(row.spec).parameters, nullptr};
    system = system.at_omega(row.evaluation.operating_point.omega);
    flow::State orbit{};
    std::copy(row.evaluation.orbit.state.begin(), row.evaluation.orbit.state.end(), orbit.begin());
    const double half_stroke = 0.5 * (row.evaluation.orbit.x_max - row.evaluation.orbit.x_min);
    const double begun = thread_seconds();
    BruteForce found = follow_by_brute_force(system, orbit, start_box(system.parameters, half_stroke), options);
    found.seconds = thread_seconds() - begun;
    return found;
}

std::uint64_t seed_of(const Row& row, std::uint64_t purpose) {
    return 1000003U * (static_cast<std::uint64_t>(row.number) + 1U) + purpose;
}

void check_again(Row& row) {
    row.taylor = follow(row, "taylor", 1e-11, {.starts = taylor_starts, .seed = seed_of(row, 1)});
    if (row.number % erk_every == 0) {
        row.erk = follow(row, "erk", 1e-9,
                         {.starts = erk_starts, .seed = seed_of(row, 2), .more_cycles = 4800, .arrived = 1e-3});
    }
    if (row.is_refuted()) {
        row.share =
            follow(row, "taylor", 1e-11, {.starts = share_starts, .seed = seed_of(row, 3), .more_cycles = 4800});
    }
}

template <class Work>
void in_parallel(std::size_t count, int jobs, const Work& work) {
    std::atomic<std::size_t> next{0};
    const auto worker = [&] {
        for (std::size_t i = next++; i < count; i = next++) { work(i); }
    };
    std::vector<std::thread> threads;
    for (int t = 1; t < jobs; ++t) { threads.emplace_back(worker); }
    worker();
    for (std::thread& thread : threads) { thread.join(); }
}

std::string_view status_of(const Row& row) {
    return row.error.empty() ? design::to_string(row.evaluation.status) : "exception";
}

std::string text_of(const Row& row) {
    std::string text = row.error.empty() ? row.evaluation.reason : row.error;
    if (text.empty() && row.evaluation.uniqueness.verdict != Verdict::unique) {
        text = row.evaluation.uniqueness.checked;
    }
    return text;
}

void print_design(const Row& row) {
    std::printf("  %ld (%s, k %.6g g %.6g phi %.6g layers %.0f delta_A %.6g delta_B %.6g delta_i %.6g)\n", row.number,
                row.spec.law == model::ContactLaw::kelvin_voigt ? "kelvin-voigt" : "no-tension",
                row.spec.value(percuss::model::membrane::key::nd_stiffness),
                row.spec.value(percuss::model::membrane::key::nd_gap),
                row.spec.value(percuss::model::membrane::key::nd_voltage),
                row.spec.value(percuss::model::membrane::key::nd_layers),
                row.spec.value(percuss::model::membrane::key::nd_delta_a),
                row.spec.value(percuss::model::membrane::key::nd_delta_b),
                row.spec.value(percuss::model::membrane::key::nd_damping));
}

void write_row(std::FILE* file, const Row& row) {
    const Evaluation& e = row.evaluation;
    std::fprintf(file, "%ld,%s", row.number,
                 row.spec.law == model::ContactLaw::kelvin_voigt ? "kelvin-voigt" : "no-tension");
    for (const Key key : varied) { std::fprintf(file, ",%.17g", row.spec.value(key)); }
    std::fprintf(file, ",%s,%s,%d,%.4f,%.4f,%.0f,%d,%.10g,%.6g,%.6g,%ld,%.4g,\"%s\"\n",
                 std::string(status_of(row)).c_str(), std::string(design::to_string(e.uniqueness.verdict)).c_str(),
                 e.uniqueness.tier, row.cpu, row.wall, e.periods, row.finite ? 1 : 0, e.operating_point.omega,
                 e.value(design::Quantity::peak_force), e.value(design::Quantity::max_multiplier), e.uniqueness.starts,
                 e.uniqueness.missed_share_bound, text_of(row).c_str());
    std::fflush(file);
}

bool print_statuses(const std::vector<Row>& rows) {
    std::map<std::string, long> outcomes;
    std::map<std::string, long> reasons;
    std::vector<double> seconds;
    long bad = 0;
    long failed = 0;
    for (const Row& row : rows) {
        std::string verdict(design::to_string(row.evaluation.uniqueness.verdict));
        verdict += ", tier " + std::to_string(row.evaluation.uniqueness.tier);
        ++outcomes[std::string(status_of(row)) + " | " + verdict];
        std::string text = text_of(row);
        std::replace_if(
            text.begin(), text.end(), [](char c) { return c >= '0' && c <= '9'; }, '#');
        if (row.evaluation.status != EvaluationStatus::not_unique && !text.empty()) {
            ++reasons[std::string(status_of(row)) + ": " + text];
        }
        seconds.push_back(row.cpu);
        failed += row.evaluation.status == EvaluationStatus::failed || !row.error.empty() ? 1 : 0;
        if (!row.finite) {
            ++bad;
            std::printf("numbers missing or not finite (%s):\n", std::string(status_of(row)).c_str());
            print_design(row);
        }
    }
    for (const auto& [outcome, count] : outcomes) { std::printf("%-44s %6ld\n", outcome.c_str(), count); }
    std::printf("\n");
    for (const auto& [reason, count] : reasons) { std::printf("%6ld  %s\n", count, reason.c_str()); }
    std::sort(seconds.begin(), seconds.end());
    const auto quantile = [&](double q) {
        return seconds[static_cast<std::size_t>(q * static_cast<double>(seconds.size() - 1))];
    };
    std::printf("\nprocessor seconds per design: median %.4f, 90 %% %.4f, 99 %% %.4f, maximum %.4f\n", quantile(0.5),
                quantile(0.9), quantile(0.99), seconds.back());
    std::printf("failed %ld of %zu; with missing or non-finite numbers %ld\n", failed, rows.size(), bad);
    return bad == 0 && seconds.back() <= budget && 100 * failed < static_cast<long>(rows.size());
}

void print_brute_force(const char* name, const BruteForce& b) {
    if (b.starts == 0) { return; }
    std::printf("    %-8s %ld starts: elsewhere %ld (still approaching %ld), lost %ld, late %ld", name, b.starts,
                b.elsewhere, b.approaching, b.lost, b.late);
    if (b.elsewhere + b.lost > 0) {
        std::printf("; start %.17g %.17g %.17g %.17g ends at %.10g %.10g %.10g %.10g", b.from[0], b.from[1], b.from[2],
                    b.from[3], b.example[0], b.example[1], b.example[2], b.example[3]);
    }
    std::printf("\n");
}

bool print_refuted(const std::vector<Row*>& unique) {
    long refuted = 0;
    long above = 0;
    std::size_t erk = 0;
    double taylor_seconds = 0.0;
    double erk_seconds = 0.0;
    for (const Row* row : unique) {
        taylor_seconds += row->taylor.seconds;
        erk_seconds += row->erk.seconds;
        erk += row->erk.starts > 0 ? 1 : 0;
        if (!row->is_refuted()) { continue; }
        ++refuted;
        const double bound = row->evaluation.uniqueness.missed_share_bound;
        if (row->share.share() >= bound) { ++above; }
        print_design(*row);
        std::printf("    omega %.10g, max_multiplier %.6f, share elsewhere %.5f, missed_share_bound %.5f\n",
                    row->evaluation.operating_point.omega, row->evaluation.value(design::Quantity::max_multiplier),
                    row->share.share(), bound);
        print_brute_force("taylor", row->taylor);
        print_brute_force("erk", row->erk);
        print_brute_force("share", row->share);
    }
    std::printf("called unique %zu: all checked again with taylor (%.0f s), %zu with erk (%.0f s)\n", unique.size(),
                taylor_seconds, erk, erk_seconds);
    std::printf("refuted %ld, of these %ld with a share not below missed_share_bound\n", refuted, above);
    const long n = static_cast<long>(unique.size());
    return 100 * refuted <= n && 20 * above <= refuted;
}

long argument(int argc, char** argv, int i, long fallback) { return argc > i ? std::atol(argv[i]) : fallback; }

}  // namespace

int main(int argc, char** argv) {
    const long designs = argument(argc, argv, 1, 2000);
    const auto seed = static_cast<std::uint64_t>(argument(argc, argv, 2, 1));
    const int jobs = static_cast<int>(argument(argc, argv, 3, 1));
    const long first = argument(argc, argv, 4, 0);
    std::FILE* file = argc > 5 ? std::fopen(argv[5], "w") : nullptr;
    if (designs < 1 || jobs < 1 || first < 0 || (argc > 5 && file == nullptr)) {
        std::fprintf(stderr, "stress_designs [designs] [seed] [jobs] [first] [rows.csv]\n");
        return 2;
    }
    if (file != nullptr) {
        std::fprintf(file, "number,law,k,g,phi_pp,layers,delta_A,delta_B,delta_i,status,verdict,tier,cpu_s,wall_s,"
                           "cycles,finite,omega,peak_force,max_multiplier,starts,missed_share_bound,reason\n");
    }
    const Bench bench;
    std::vector<Row> rows(static_cast<std::size_t>(designs));
    std::mutex guard;
    in_parallel(rows.size(), jobs, [&](std::size_t i) {
        rows[i].number = first + static_cast<long>(i);
        rows[i].spec = draw(seed, rows[i].number);
        evaluate(bench, rows[i]);
        const std::lock_guard lock(guard);
        if (file != nullptr) { write_row(file, rows[i]); }
    });
    const bool evaluated = print_statuses(rows);
    std::fflush(stdout);

    std::vector<Row*> unique;
    for (Row& row : rows) {
        if (row.is_unique()) { unique.push_back(&row); }
    }
    in_parallel(unique.size(), jobs, [&](std::size_t i) {
        Row& row = *unique[i];
        check_again(row);
        const std::lock_guard lock(guard);
        std::fprintf(stderr, "design %ld: elsewhere %ld of %ld in %.2f s (taylor), %ld of %ld in %.2f s (erk)\n",
                     row.number, row.taylor.elsewhere + row.taylor.lost, row.taylor.starts, row.taylor.seconds,
                     row.erk.elsewhere + row.erk.lost, row.erk.starts, row.erk.seconds);
    });
    std::printf("\n");
    const bool confirmed = print_refuted(unique);
    if (file != nullptr) { std::fclose(file); }
    const bool pass = evaluated && confirmed;
    std::printf("%s\n", pass ? "PASS" : "FAIL");
    return pass ? 0 : 1;
}
