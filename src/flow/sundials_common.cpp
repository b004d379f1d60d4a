#include "flow/sundials_common.hpp"

#include "flow/stepwise_run.hpp"

#include <nvector/nvector_serial.h>
#include <sundials/sundials_context.h>

#include <cmath>
#include <new>
#include <stdexcept>
#include <string>
#include <utility>

namespace percuss::flow {
namespace {

void free_context(void* context) {
    auto owned = static_cast<SUNContext>(context);
    SUNContext_Free(&owned);
}

void free_vector(void* vector) { N_VDestroy(static_cast<N_Vector>(vector)); }

/// Misuse of a request. Negative hybrid runs: the table of the contact law tells its events forwards.
void check(const AugmentedSystem& system, const Request& request) {
    if (!std::isfinite(request.theta) || !std::isfinite(request.duration)) {
        throw std::invalid_argument("Request.theta and Request.duration must be finite, got " +
                                    std::to_string(request.theta) + " and " + std::to_string(request.duration));
    }
    if (request.stop == StopMode::hybrid && request.duration < 0.0) {
        throw std::invalid_argument("Request.duration must not be negative for a hybrid run, got " +
                                    std::to_string(request.duration));
    }
    if (!(std::abs(system.omega()) > 0.0)) {
        throw std::invalid_argument("the drive frequency omega must not be zero, got " +
                                    std::to_string(system.omega()));
    }
}

}  // namespace

SundialsHandle make_sundials_context() {
    SUNContext context = nullptr;
    if (SUNContext_Create(nullptr, &context) != 0 || context == nullptr) { throw std::bad_alloc(); }
    return {context, free_context};
}

SundialsHandle make_sundials_vector(int size, double* numbers, void* context) {
    N_Vector vector = N_VMake_Serial(size, numbers, static_cast<SUNContext>(context));
    if (vector == nullptr) { throw std::bad_alloc(); }
    N_VEnableFusedOps_Serial(vector, SUNTRUE);  // sums of many vectors in one pass; clones inherit it
    return {vector, free_vector};
}

void ignore_sundials_message(int, const char*, const char*, char*, void*) {}

SundialsIntegrator::SundialsIntegrator(std::shared_ptr<const RightHandSide> rhs, double tolerance)
    : rhs_(std::move(rhs)),
      tolerance_(tolerance) {
    if (rhs_ == nullptr) { throw std::invalid_argument("an integrator needs a right-hand side"); }
    if (!(tolerance >= 1e-16 && tolerance <= 1e-2)) {
        throw std::invalid_argument("tolerance must lie between 1e-16 and 1e-2, got " + std::to_string(tolerance));
    }
}

void SundialsIntegrator::run(const ParameterVector& parameters, const Request& request, Result& result) const {
    if (request.directions.size() > static_cast<std::size_t>(max_lanes)) {
        throw std::invalid_argument("Request.directions may hold at most " + std::to_string(max_lanes) +
                                    " directions, got " + std::to_string(request.directions.size()));
    }
    reset(result);
    const AugmentedSystem system(*rhs_, parameters, request);
    check(system, request);
    const std::unique_ptr<Stepper> stepper = make_stepper(system, request);
    StepwiseRun(system, *stepper, request, result).run();
}

}  // namespace percuss::flow
