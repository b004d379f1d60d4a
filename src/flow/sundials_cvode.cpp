#include "flow/sundials.hpp"
#include "flow/sundials_common.hpp"

#include <cvodes/cvodes.h>
#include <nvector/nvector_serial.h>
#include <sunlinsol/sunlinsol_dense.h>
#include <sunmatrix/sunmatrix_dense.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <new>
#include <utility>
#include <vector>

namespace percuss::flow {
namespace {

constexpr std::size_t at(int i) { return static_cast<std::size_t>(i); }

void free_cvode(void* memory) { CVodeFree(&memory); }
void free_matrix(void* matrix) { SUNMatDestroy(static_cast<SUNMatrix>(matrix)); }
void free_solver(void* solver) { SUNLinSolFree(static_cast<SUNLinearSolver>(solver)); }

N_Vector as_vector(const SundialsHandle& handle) { return static_cast<N_Vector>(handle.get()); }

/// Failures in a row of the error test or of the corrector: the first step behind an event may be far off.
constexpr int max_failures = 30;

/// One vector per column, each over numbers of its own.
class VectorSet {
public:
    VectorSet(int columns, int size, void* context) : size_(size), numbers_(at(columns)) {
        for (auto& column : numbers_) {
            owned_.push_back(make_sundials_vector(size, column.data(), context));
            vectors_.push_back(as_vector(owned_.back()));
        }
    }
    [[nodiscard]] N_Vector values() const { return vectors_.front(); }
    [[nodiscard]] N_Vector* lanes() { return vectors_.data() + 1; }
    /// Copies to or from the rows `first .. first + size` of each column.
    void load(const AugmentedSystem& system, const Extended& y, int first) {
        for (int c = 0; c < system.columns(); ++c) {
            std::copy_n(y.begin() + c * system.block() + first, size_, numbers_[at(c)].begin());
        }
    }
    void store(const AugmentedSystem& system, Extended& y, int first) const {
        for (int c = 0; c < system.columns(); ++c) {
            std::copy_n(numbers_[at(c)].begin(), size_, y.begin() + c * system.block() + first);
        }
    }
    [[nodiscard]] const std::array<double, at(max_block)>& numbers(int column) const { return numbers_[at(column)]; }
    void set(int column, int i, double value) { numbers_[at(column)][at(i)] = value; }

private:
    int size_;
    std::vector<std::array<double, at(max_block)>> numbers_;
    std::vector<SundialsHandle> owned_;
    std::vector<N_Vector> vectors_;
};

/// CVODES chooses the steps; inside a step its own interpolating polynomial is as accurate as the step.
class CvodeStepper final : public Stepper {
public:
    CvodeStepper(const AugmentedSystem& system, double tolerance)
        : system_(system),
          tolerance_(std::max(tolerance, tightest_tolerance)),
          context_(make_sundials_context()),
          state_(system.columns(), system.states(), context_.get()),
          integral_(system.columns(), system.integrals().count, context_.get()),
          absolute_(system.columns(), system.states(), context_.get()),
          matrix_(SUNDenseMatrix(system.states(), system.states(), context()), free_matrix),
          solver_(nullptr, free_solver),
          memory_(nullptr, free_cvode) {
        for (int c = 0; c < system.columns(); ++c) {
            for (int i = 0; i < system.states(); ++i) {
                absolute_.set(c, i, absolute_share * tolerance_ * system.natural_size(c, i));
            }
            // Entry 1 stands for any that is not the overlap: integrals are of the size of states.
            integral_absolute_[at(c)] = absolute_share * tolerance_ * system.natural_size(c, 1);
        }
        if (matrix_) {
            solver_.reset(SUNLinSol_Dense(state_.values(), static_cast<SUNMatrix>(matrix_.get()), context()));
        }
        if (!matrix_ || !solver_) { throw std::bad_alloc(); }
    }

    bool start(double t, const Extended& y, bool touching, double limit) override {
        touching_ = touching;
        limit_ = limit;
        right_ = t;
        right_values_ = system_.values(y);
        state_.load(system_, y, 0);
        integral_.load(system_, y, system_.states());
        return (memory_ ? restart(t) : create(t)) && ok(CVodeSetStopTime(memory_.get(), limit));
    }

    bool advance() override {
        left_ = right_;
        left_values_ = right_values_;
        const int flag = CVode(memory_.get(), limit_, state_.values(), &right_, CV_ONE_STEP);
        if (flag < 0) { return false; }
        // Exactly, because the run ends where right == limit.
        if (flag == CV_TSTOP_RETURN) { right_ = limit_; }
        std::copy_n(state_.numbers(0).begin(), system_.states(), right_values_.begin());
        return true;
    }

    void values(double t, State& out) override {
        if (t == right_) {
            out = right_values_;
            return;
        }
        // The vector of values is only a place to put them: CVODES goes on from its own history.
        CVodeGetDky(memory_.get(), t, 0, state_.values());
        out = {};
        std::copy_n(state_.numbers(0).begin(), system_.states(), out.begin());
    }

    void everything(double t, Extended& out) override {
        void* memory = memory_.get();
        out = {};
        CVodeGetDky(memory, t, 0, state_.values());
        if (has_lanes()) { CVodeGetSensDky(memory, t, 0, state_.lanes()); }
        state_.store(system_, out, 0);
        if (has_integrals()) {
            CVodeGetQuadDky(memory, t, 0, integral_.values());
            if (has_lanes()) { CVodeGetQuadSensDky(memory, t, 0, integral_.lanes()); }
            integral_.store(system_, out, system_.states());
        }
    }

private:
    static bool ok(int flag) { return flag == CV_SUCCESS; }
    [[nodiscard]] SUNContext context() const { return static_cast<SUNContext>(context_.get()); }
    [[nodiscard]] bool has_lanes() const { return system_.lanes() > 0; }
    [[nodiscard]] bool has_integrals() const { return system_.integrals().count > 0; }

    bool create(double t) {
        // BDF: this backend is there for what is stiff.
        memory_.reset(CVodeCreate(CV_BDF, context()));
        void* memory = memory_.get();
        if (memory == nullptr) { throw std::bad_alloc(); }
        bool fine = ok(CVodeSetErrHandlerFn(memory, ignore_sundials_message, nullptr)) &&
                    ok(CVodeInit(memory, &CvodeStepper::rate, t, state_.values())) &&
                    ok(CVodeSetUserData(memory, this)) && ok(CVodeSetMaxErrTestFails(memory, max_failures)) &&
                    ok(CVodeSetMaxConvFails(memory, max_failures)) &&
                    ok(CVodeSVtolerances(memory, tolerance_, absolute_.values())) &&
                    ok(CVodeSetLinearSolver(memory, static_cast<SUNLinearSolver>(solver_.get()),
                                            static_cast<SUNMatrix>(matrix_.get()))) &&
                    ok(CVodeSetJacFn(memory, &CvodeStepper::jacobian));
        if (fine && has_lanes()) {
            // Staggered: lanes are corrected after the values have converged, with the same factorised matrix. They
            // take part in the error test, and so do integrals: else steps that suit the values alone would leave them
            // at no known accuracy.
            fine = ok(CVodeSensInit(memory, system_.lanes(), CV_STAGGERED, &CvodeStepper::lane_rate, state_.lanes())) &&
                   ok(CVodeSensSVtolerances(memory, tolerance_, absolute_.lanes())) &&
                   ok(CVodeSetSensErrCon(memory, SUNTRUE));
        }
        if (fine && has_integrals()) {
            fine = ok(CVodeQuadInit(memory, &CvodeStepper::integral_rate, integral_.values())) &&
                   ok(CVodeQuadSStolerances(memory, tolerance_, integral_absolute_[0])) &&
                   ok(CVodeSetQuadErrCon(memory, SUNTRUE));
        }
        if (fine && has_integrals() && has_lanes()) {
            fine = ok(CVodeQuadSensInit(memory, &CvodeStepper::integral_lane_rate, integral_.lanes())) &&
                   ok(CVodeQuadSensSStolerances(memory, tolerance_, integral_absolute_.data() + 1)) &&
                   ok(CVodeSetQuadSensErrCon(memory, SUNTRUE));
        }
        return fine;
    }

    bool restart(double t) {
        void* memory = memory_.get();
        return ok(CVodeReInit(memory, t, state_.values())) &&
               (!has_lanes() || ok(CVodeSensReInit(memory, CV_STAGGERED, state_.lanes()))) &&
               (!has_integrals() || ok(CVodeQuadReInit(memory, integral_.values()))) &&
               (!has_integrals() || !has_lanes() || ok(CVodeQuadSensReInit(memory, integral_.lanes())));
    }

    /// What SUNDIALS makes of a rate that is not finite: the step is tried again with a shorter length.
    static int verdict(const double* rate, int size) {
        return std::all_of(rate, rate + size, [](double r) { return std::isfinite(r); }) ? 0 : 1;
    }

    [[nodiscard]] Columns columns(N_Vector values, N_Vector* lanes) const {
        Columns result{};
        result[0] = N_VGetArrayPointer(values);
        for (int lane = 0; lane < system_.lanes(); ++lane) { result[at(1 + lane)] = N_VGetArrayPointer(lanes[lane]); }
        return result;
    }
    /// Values are asked for separately: here they go nowhere.
    [[nodiscard]] MutableColumns lane_columns(N_Vector* lanes, std::array<double, at(max_block)>& unused) const {
        MutableColumns result{};
        result[0] = unused.data();
        for (int lane = 0; lane < system_.lanes(); ++lane) { result[at(1 + lane)] = N_VGetArrayPointer(lanes[lane]); }
        return result;
    }

    static int rate(realtype t, N_Vector y, N_Vector out, void* self) {
        const auto& stepper = *static_cast<const CvodeStepper*>(self);
        double* rate = N_VGetArrayPointer(out);
        stepper.system_.state_rate(t, N_VGetArrayPointer(y), stepper.touching_, rate);
        return verdict(rate, stepper.system_.states());
    }
    static int jacobian(realtype t, N_Vector y, N_Vector, SUNMatrix out, void* self, N_Vector, N_Vector, N_Vector) {
        const auto& stepper = *static_cast<const CvodeStepper*>(self);
        const int size = stepper.system_.states();
        double* entries = SUNDenseMatrix_Data(out);
        stepper.system_.jacobian(t, N_VGetArrayPointer(y), stepper.touching_, entries);
        return verdict(entries, size * size);
    }
    static int lane_rate(int, realtype t, N_Vector y, N_Vector, N_Vector* lanes, N_Vector* out, void* self, N_Vector,
                         N_Vector) {
        const auto& stepper = *static_cast<const CvodeStepper*>(self);
        std::array<double, at(max_block)> unused{};
        stepper.system_.state_rates(t, stepper.columns(y, lanes), stepper.touching_, stepper.lane_columns(out, unused));
        return verdict(unused.data(), stepper.system_.states());
    }
    static int integral_rate(realtype t, N_Vector y, N_Vector out, void* self) {
        const auto& stepper = *static_cast<const CvodeStepper*>(self);
        stepper.system_.integral_rate(t, N_VGetArrayPointer(y), stepper.touching_, N_VGetArrayPointer(out));
        return 0;
    }
    static int integral_lane_rate(int, realtype t, N_Vector y, N_Vector* lanes, N_Vector, N_Vector* out, void* self,
                                  N_Vector, N_Vector) {
        const auto& stepper = *static_cast<const CvodeStepper*>(self);
        std::array<double, at(max_block)> unused{};
        stepper.system_.integral_rates(t, stepper.columns(y, lanes), stepper.touching_,
                                       stepper.lane_columns(out, unused));
        return 0;
    }

    const AugmentedSystem& system_;
    double tolerance_;
    SundialsHandle context_;
    VectorSet state_;
    VectorSet integral_;
    VectorSet absolute_;
    std::array<double, at(max_columns)> integral_absolute_{};
    SundialsHandle matrix_;
    SundialsHandle solver_;
    SundialsHandle memory_;
    bool touching_ = false;
    double limit_ = 0.0;
};

class CvodeIntegrator final : public SundialsIntegrator {
public:
    using SundialsIntegrator::SundialsIntegrator;

protected:
    [[nodiscard]] std::unique_ptr<Stepper> make_stepper(const AugmentedSystem& system, const Request&) const override {
        return std::make_unique<CvodeStepper>(system, tolerance());
    }
};

}  // namespace

std::unique_ptr<Integrator> make_cvode(std::shared_ptr<const RightHandSide> rhs, double tolerance) {
    return std::make_unique<CvodeIntegrator>(std::move(rhs), tolerance);
}

}  // namespace percuss::flow
