#pragma once
/// \file
/// What both SUNDIALS backends share: the Integrator around a stepper, and ownership of SUNDIALS objects. No SUNDIALS
/// header is needed to include this one.

#include "flow/augmented_system.hpp"
#include "flow/flow.hpp"
#include "flow/right_hand_side.hpp"
#include "flow/stepper.hpp"

#include <memory>

namespace percuss::flow {

/// An owned SUNContext, N_Vector, SUNMatrix, SUNLinearSolver or integrator memory, released by its own function.
using SundialsHandle = std::unique_ptr<void, void (*)(void*)>;

/// Both throw std::bad_alloc when SUNDIALS returns nothing.
SundialsHandle make_sundials_context();
/// A serial vector over numbers that stay the caller's.
SundialsHandle make_sundials_vector(int size, double* numbers, void* context);

/// Takes the place of SUNDIALS' error messages: failures are told by return values alone.
void ignore_sundials_message(int code, const char* module, const char* function, char* message, void* data);

/// Absolute tolerance of an entry: this share of the relative one, times the natural size of the entry.
inline constexpr double absolute_share = 0.1;
/// Steps are not asked to be more accurate than this, which is about what double precision can tell.
inline constexpr double tightest_tolerance = 1e-15;

class SundialsIntegrator : public Integrator {
public:
    /// Throws std::invalid_argument unless 1e-16 <= tolerance <= 1e-2 and rhs is not null.
    SundialsIntegrator(std::shared_ptr<const RightHandSide> rhs, double tolerance);

    [[nodiscard]] const SystemInfo& info() const override { return rhs_->info(); }
    void run(const ParameterVector& parameters, const Request& request, Result& result) const override;
    [[nodiscard]] double tolerance() const override { return tolerance_; }
    [[nodiscard]] double centre(const ParameterVector& p) const override { return rhs_->centre(p); }
    [[nodiscard]] double centre_derivative(const ParameterVector& p, const ParameterVector& dp) const override {
        return rhs_->centre_derivative(p, dp);
    }
    [[nodiscard]] State rest_state(const ParameterVector& p) const override { return rhs_->rest_state(p); }
    [[nodiscard]] StateRange internal_range(const ParameterVector& p, double reach) const override {
        return rhs_->internal_range(p, reach);
    }
    [[nodiscard]] double linear_resonance(const ParameterVector& p) const override { return rhs_->linear_resonance(p); }
    [[nodiscard]] bool symmetric(const ParameterVector& p) const override { return rhs_->symmetric(p); }

protected:
    [[nodiscard]] virtual std::unique_ptr<Stepper> make_stepper(const AugmentedSystem& system,
                                                                const Request& request) const = 0;

private:
    std::shared_ptr<const RightHandSide> rhs_;
    double tolerance_;
};

}  // namespace percuss::flow
