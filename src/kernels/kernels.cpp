#include "kernels/kernels.hpp"

#include "flow/sundials.hpp"
#include "flow/taylor_order.hpp"
#include "kernels/plain_systems.hpp"
#include "kernels/scene_table.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <stdexcept>
#include <vector>

namespace percuss::kernels {
namespace {

/// The kernels of one instruction set, both tables by scene.
struct Set {
    std::string_view name;
    const TaylorTable* single;
    const EnsembleTable* ensemble;
};

/// What was compiled in and runs here, weakest first.
const std::vector<Set>& available_sets() {
    static const std::vector<Set> sets = [] {
        std::vector<Set> found;
#if defined(PERCUSS_HAVE_GENERIC)
        found.push_back({"generic", &taylor_table_generic(), &ensemble_table_generic()});
#endif
#ifdef PERCUSS_HAVE_V2
        found.push_back({"v2", &taylor_table_v2(), &ensemble_table_v2()});
#endif
#ifdef PERCUSS_HAVE_V3
        if (__builtin_cpu_supports("avx2") && __builtin_cpu_supports("fma") && __builtin_cpu_supports("bmi2")) {
            found.push_back({"v3", &taylor_table_v3(), &ensemble_table_v3()});
        }
#endif
#ifdef PERCUSS_HAVE_V4
        if (__builtin_cpu_supports("avx512f") && __builtin_cpu_supports("avx512bw") &&
            __builtin_cpu_supports("avx512cd") && __builtin_cpu_supports("avx512dq") &&
            __builtin_cpu_supports("avx512vl")) {
            found.push_back({"v4", &taylor_table_v4(), &ensemble_table_v4()});
        }
#endif
        return found;
    }();
    return sets;
}

/// The set of this name, auto the strongest that runs here; throws std::invalid_argument that names those that do.
const Set& choose_set(std::string_view requested) {
    const std::vector<Set>& sets = available_sets();
    if (requested == "auto") { return sets.back(); }
    const auto match = std::find_if(sets.begin(), sets.end(), [&](const Set& s) { return s.name == requested; });
    if (match == sets.end()) {
        std::string message = "solver.instruction_set = " + std::string(requested) + ": allowed here are auto";
        for (const Set& s : sets) { message += ", " + std::string(s.name); }
        throw std::invalid_argument(message);
    }
    return *match;
}

/// Rate of the fastest decay over drive frequency from which CVODE is the faster. Time of one orbit from rest, Taylor
/// against CVODE: a voice coil (problems/voice-coil.ini at 400 Hz, inductance 400, 300, 200 nH) 35 to 57, 65 to 76, 70
/// to 78 ms at ratios of 6e3, 8e3, 1.2e4; the same at 100 Hz 86 to 216 and 139 to 196 ms at 9.5e3 and 1.9e4, and from
/// 3e4 on Taylor runs out of steps. Membranes (wu2022-nondimensional.ini, delta_B 3e-4 and 1e-4): 121 to 150 and 297 to
/// 175 ms at 5e3 and 1.6e4.
constexpr double stiff_ratio = 1e4;
/// Decays of the stop in half a drive period from which CVODE is taken. Measured on problems/soft-impact.ini at 0.05 Hz
/// under 2 N, in contact for half the period: Taylor 72 to 606 ms at 3e4, 175 to 756 ms at 1e5, and at 3e5 it runs out
/// of steps.
constexpr double stiff_contact = 1e5;

/// Whether a stop can be in a contact of half a drive period, the longest that a drive which swings holds it for, and
/// decays so fast that this is stiff. An underdamped one throws the mass back long before.
bool stop_is_stiff(const flow::SystemInfo& info, const flow::ParameterVector& p, double stiffness, double omega) {
    if (!info.has_stop) { return false; }
    const double delta = p[static_cast<std::size_t>(info.damping)];
    const double k = p[static_cast<std::size_t>(info.stiffness)] + stiffness;
    // Mass on the stop: s^2 + delta s + k = 0. Overdamped, the faster root decays at delta/2 to delta.
    const bool overdamped = delta > 2.0 * std::sqrt(k);
    return overdamped && delta * std::numbers::pi / omega >= stiff_contact;
}

class TaylorIntegrator final : public flow::Integrator {
public:
    TaylorIntegrator(const model::Scene& scene, model::ContactLaw law, const IntegratorOptions& options)
        : plain_(make_plain_system(scene, law)),
          info_(plain_->info()),
          tolerance_(options.tolerance) {
        const Set& set = choose_set(options.instruction_set);
        const std::size_t index = scene_index(scene);
        kernels_ = &(*set.single)[index];
        ensemble_ = (*set.ensemble)[index];
        settings_.law = law;
        settings_.order = flow::taylor_order(options.tolerance);
    }

    [[nodiscard]] const flow::SystemInfo& info() const override { return info_; }
    [[nodiscard]] double tolerance() const override { return tolerance_; }

    void run(const flow::ParameterVector& parameters, const flow::Request& request,
             flow::Result& result) const override {
        if (request.directions.size() > flow::max_lanes) {
            throw std::invalid_argument("flow request: more than 8 directions");
        }
        if (request.stop == flow::StopMode::hybrid && request.duration < 0.0) {
            throw std::invalid_argument("flow request: a hybrid run cannot go back in time");
        }
        // The narrowest compiled kernel that holds all directions: idle lanes cost as much as used ones.
        std::size_t lanes = 0;
        while (static_cast<std::size_t>(lane_classes[lanes]) < request.directions.size()) { ++lanes; }
        (*kernels_)[lanes](parameters, settings_, request, result);
    }

    void run_ensemble(const flow::ParameterVector& parameters, const flow::EnsembleRequest& request,
                      std::span<flow::EnsembleMember> members) const override {
        flow::check(request, members.size());
        ensemble_(parameters, settings_, request, members);
    }

    [[nodiscard]] double centre(const flow::ParameterVector& p) const override { return plain_->centre(p); }
    [[nodiscard]] double centre_derivative(const flow::ParameterVector& p,
                                           const flow::ParameterVector& dp) const override {
        return plain_->centre_derivative(p, dp);
    }
    [[nodiscard]] flow::State rest_state(const flow::ParameterVector& p) const override {
        return plain_->rest_state(p);
    }
    [[nodiscard]] flow::StateRange internal_range(const flow::ParameterVector& p, double reach) const override {
        return plain_->internal_range(p, reach);
    }
    [[nodiscard]] double linear_resonance(const flow::ParameterVector& p) const override {
        return plain_->linear_resonance(p);
    }
    [[nodiscard]] bool symmetric(const flow::ParameterVector& p) const override { return plain_->symmetric(p); }

private:
    std::shared_ptr<const flow::RightHandSide> plain_;
    flow::SystemInfo info_;
    double tolerance_;
    TaylorSettings settings_;
    const TaylorTable::value_type* kernels_ = nullptr;
    EnsembleKernel ensemble_ = nullptr;
};

}  // namespace

std::string choose_integrator(std::string_view requested, const model::Scene& scene, model::ContactLaw law,
                              const flow::ParameterVector& parameters) {
    if (requested != "auto") { return std::string(requested); }
    const auto system = make_plain_system(scene, law);
    const double resonance = system->linear_resonance(parameters);
    const double given = parameters[static_cast<std::size_t>(system->info().omega)];
    // An edge is not known yet; it lies near the resonance as far as orders of magnitude go.
    const double omega = given > 0.0 ? given : resonance;
    // In contact the suspension, of stiffness resonance^2 per unit mass, acts beside the stop.
    const bool stiff = system->fastest_decay(parameters) >= stiff_ratio * omega ||
                       stop_is_stiff(system->info(), parameters, resonance * resonance, omega);
    return stiff ? "cvode" : "taylor";
}

std::string_view instruction_set_in_use(std::string_view requested) { return choose_set(requested).name; }

std::span<const std::string_view> instruction_sets() {
    static const std::vector<std::string_view> names = [] {
        std::vector<std::string_view> list;
        for (const Set& s : available_sets()) { list.push_back(s.name); }
        return list;
    }();
    return names;
}

std::unique_ptr<flow::Integrator> make_integrator(const model::Scene& scene, model::ContactLaw law,
                                                  const IntegratorOptions& options) {
    if (!(options.tolerance >= 1e-16 && options.tolerance <= 1e-2)) {
        throw std::invalid_argument("solver.tolerance = " + std::to_string(options.tolerance) +
                                    ": allowed is 1e-16 to 1e-2");
    }
    if (options.integrator == "taylor") { return std::make_unique<TaylorIntegrator>(scene, law, options); }
    if (options.integrator == "erk") { return flow::make_erk(make_plain_system(scene, law), options.tolerance); }
    if (options.integrator == "cvode") { return flow::make_cvode(make_plain_system(scene, law), options.tolerance); }
    throw std::invalid_argument("solver.integrator = " + options.integrator + ": allowed are taylor, erk, cvode");
}

}  // namespace percuss::kernels
