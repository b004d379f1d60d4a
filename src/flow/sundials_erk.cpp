#include "flow/sundials.hpp"
#include "flow/sundials_common.hpp"

#include <arkode/arkode_erkstep.h>
#include <nvector/nvector_serial.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <new>
#include <utility>

namespace percuss::flow {
namespace {

constexpr std::size_t at(int i) { return static_cast<std::size_t>(i); }

/// Eighth order with an embedded seventh: at tolerance 1e-12 the fewest evaluations of the methods in ARKODE.
constexpr ARKODE_ERKTableID method = ARKODE_FEHLBERG_13_7_8;
constexpr int max_stages = 13;

/// Rejections in a row: each divides the step by up to ten, and behind an event the first guess may be far off.
constexpr int max_failures = 30;

void free_arkode(void* memory) { ERKStepFree(&memory); }

/// ARKODE chooses the steps. Inside a step its own interpolant is of fifth order at most, so the step is repeated with
/// the same Runge-Kutta method and a shorter length instead: as accurate as the step itself.
class ErkStepper final : public Stepper {
public:
    ErkStepper(const AugmentedSystem& system, double tolerance)
        : system_(system),
          tolerance_(std::max(tolerance, tightest_tolerance)),
          context_(make_sundials_context()),
          vector_(make_sundials_vector(system.size(), right_all_.data(), context_.get())),
          weights_(make_sundials_vector(system.size(), absolute_.data(), context_.get())),
          memory_(nullptr, free_arkode),
          table_(ARKodeButcherTable_LoadERK(method), ARKodeButcherTable_Free) {
        if (!table_) { throw std::bad_alloc(); }
        for (int c = 0; c < system.columns(); ++c) {
            for (int i = 0; i < system.block(); ++i) {
                system.entry(absolute_, c, i) = absolute_share * tolerance_ * system.natural_size(c, i);
            }
        }
    }

    bool start(double t, const Extended& y, bool touching, double limit) override {
        touching_ = touching;
        limit_ = limit;
        right_ = t;
        right_all_ = y;
        right_values_ = system_.values(y);
        void* memory = memory_.get();
        if (memory == nullptr) { return create(t); }
        // The last step before the event as a first guess spares ARKODE the search for one.
        const double first = std::min(std::abs(step_), std::abs(limit - t));
        return ERKStepReInit(memory, &ErkStepper::rate, t, vector()) == ARK_SUCCESS &&
               ERKStepSetInitStep(memory, std::copysign(first, limit - t)) == ARK_SUCCESS &&
               ERKStepSetStopTime(memory, limit) == ARK_SUCCESS;
    }

    bool advance() override {
        left_ = right_;
        left_all_ = right_all_;
        left_values_ = right_values_;
        const int flag = ERKStepEvolve(memory_.get(), limit_, vector(), &right_, ARK_ONE_STEP);
        if (flag < 0) { return false; }
        // Exactly, because the run ends where right == limit.
        if (flag == ARK_TSTOP_RETURN) { right_ = limit_; }
        ERKStepGetLastStep(memory_.get(), &step_);
        right_values_ = system_.values(right_all_);
        return true;
    }

    void values(double t, State& out) override {
        if (t == right_) {
            out = right_values_;
            return;
        }
        out = {};
        repeat(t, system_.states(), out.data(), [this](double t_stage, const double* y, double* rate) {
            system_.state_rate(t_stage, y, touching_, rate);
        });
    }

    void everything(double t, Extended& out) override {
        if (t == right_) {
            out = right_all_;
            return;
        }
        out = {};
        repeat(t, system_.size(), out.data(),
               [this](double t_stage, const double* y, double* rate) { system_.rates(t_stage, y, touching_, rate); });
    }

private:
    [[nodiscard]] N_Vector vector() const { return static_cast<N_Vector>(vector_.get()); }

    bool create(double t) {
        memory_.reset(ERKStepCreate(&ErkStepper::rate, t, vector(), static_cast<SUNContext>(context_.get())));
        void* memory = memory_.get();
        if (memory == nullptr) { throw std::bad_alloc(); }
        return ERKStepSetErrHandlerFn(memory, ignore_sundials_message, nullptr) == ARK_SUCCESS &&
               ERKStepSetUserData(memory, this) == ARK_SUCCESS && ERKStepSetTableNum(memory, method) == ARK_SUCCESS &&
               ERKStepSetMaxErrTestFails(memory, max_failures) == ARK_SUCCESS &&
               ERKStepSVtolerances(memory, tolerance_, static_cast<N_Vector>(weights_.get())) == ARK_SUCCESS &&
               ERKStepSetStopTime(memory, limit_) == ARK_SUCCESS;
    }

    /// Runge-Kutta step of the first `size` numbers from the left end of the last step to t.
    template <class Rate>
    void repeat(double t, int size, double* out, Rate&& rate) {
        const double h = t - left_;
        const auto& table = *table_;
        for (int stage = 0; stage < table.stages; ++stage) {
            Extended& y = scratch_;
            for (int i = 0; i < size; ++i) {
                double sum = 0.0;
                for (int j = 0; j < stage; ++j) { sum += table.A[stage][j] * stages_[at(j)][at(i)]; }
                y[at(i)] = left_all_[at(i)] + h * sum;
            }
            rate(left_ + table.c[stage] * h, y.data(), stages_[at(stage)].data());
        }
        for (int i = 0; i < size; ++i) {
            double sum = 0.0;
            for (int j = 0; j < table.stages; ++j) { sum += table.b[j] * stages_[at(j)][at(i)]; }
            out[i] = left_all_[at(i)] + h * sum;
        }
    }

    static int rate(realtype t, N_Vector y, N_Vector out, void* self) {
        const auto& stepper = *static_cast<const ErkStepper*>(self);
        double* rate = N_VGetArrayPointer(out);
        stepper.system_.rates(t, N_VGetArrayPointer(y), stepper.touching_, rate);
        // Outside the domain of the model rates are NaN; a positive value makes ARKODE repeat the step.
        constexpr int try_shorter = 1;
        const bool finite = std::all_of(rate, rate + stepper.system_.size(), [](double r) { return std::isfinite(r); });
        return finite ? 0 : try_shorter;
    }

    const AugmentedSystem& system_;
    double tolerance_;
    Extended left_all_{};
    Extended right_all_{};
    Extended absolute_{};
    Extended scratch_{};
    std::array<Extended, max_stages> stages_{};
    SundialsHandle context_;
    SundialsHandle vector_;
    SundialsHandle weights_;
    SundialsHandle memory_;
    std::unique_ptr<ARKodeButcherTableMem, void (*)(ARKodeButcherTable)> table_;
    bool touching_ = false;
    double limit_ = 0.0;
    double step_ = 0.0;
};

class ErkIntegrator final : public SundialsIntegrator {
public:
    using SundialsIntegrator::SundialsIntegrator;

protected:
    [[nodiscard]] std::unique_ptr<Stepper> make_stepper(const AugmentedSystem& system, const Request&) const override {
        return std::make_unique<ErkStepper>(system, tolerance());
    }
};

}  // namespace

std::unique_ptr<Integrator> make_erk(std::shared_ptr<const RightHandSide> rhs, double tolerance) {
    return std::make_unique<ErkIntegrator>(std::move(rhs), tolerance);
}

}  // namespace percuss::flow
