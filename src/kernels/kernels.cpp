#include "kernels/kernels.hpp"

#include "flow/sundials.hpp"
#include "flow/taylor_order.hpp"
#include "kernels/plain_systems.hpp"
#include "kernels/scene_table.hpp"

#include <algorithm>
#include <stdexcept>
#include <vector>

namespace percuss::kernels {
namespace {

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
