#pragma once
/// \file
/// Settings and outcome of one optimisation.

#include "numerics/cancel.hpp"
#include "optimise/nlp.hpp"

#include <cstdint>
#include <limits>
#include <string>

namespace percuss::optimise {

struct Options {
    std::string method = "ipopt";         ///< one of methods()
    int max_evaluations = 2000;           ///< calls of Nlp::evaluate; asking again at a known point is free
    double tolerance = 1e-8;              ///< of the solver's own stopping test (KKT error or relative step)
    double feasibility_tolerance = 1e-9;  ///< a point is feasible when every c_i <= this
    std::uint64_t seed = 1;               ///< for the methods that draw random numbers
    numerics::CancelRequest cancelled{};  ///< asked before each evaluation; true from then on
    double failure_penalty = 1e6;         ///< objective that NLopt's methods see where evaluation failed
    double global_share = 0.5;            ///< part of max_evaluations that a global method has before its polish
    bool warm = false;                    ///< the start is close to an optimum (Ipopt: small barrier, no push inwards)
};

struct Outcome {
    enum class Status : std::uint8_t {
        not_run,
        converged,   ///< the method reports an optimum, and x, re-checked, is feasible and no worse than any point seen
        infeasible,  ///< nothing feasible was found, and the method reports a local minimum of infeasibility
        budget,      ///< max_evaluations spent or cancelled
        failed,      ///< the method gave up; the message has its words
    };
    Status status = Status::not_run;
    /// Best feasible point seen; if none, the least infeasible one; if nothing could be evaluated, the start.
    Vector x;
    double objective = std::numeric_limits<double>::quiet_NaN();     ///< f(x)
    Vector constraints;                                              ///< c(x); empty if x could not be evaluated
    double infeasibility = std::numeric_limits<double>::infinity();  ///< max(0, max_i c_i(x))
    bool feasible = false;                                           ///< infeasibility <= feasibility_tolerance
    int evaluations = 0;                                             ///< calls of Nlp::evaluate
    std::string message;
};

/// "converged", "infeasible", ...
[[nodiscard]] const char* to_string(Outcome::Status status);

}  // namespace percuss::optimise
