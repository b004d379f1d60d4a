#include "optimise/nlopt_solver.hpp"

#include <nlopt.h>

#include <cmath>
#include <exception>
#include <memory>
#include <sstream>
#include <stdexcept>

namespace percuss::optimise {
namespace {

struct Destroy {
    void operator()(nlopt_opt handle) const { nlopt_destroy(handle); }
};
using Handle = std::unique_ptr<std::remove_pointer_t<nlopt_opt>, Destroy>;

Handle create(int algorithm, int variables) {
    Handle handle(nlopt_create(static_cast<nlopt_algorithm>(algorithm), static_cast<unsigned>(variables)));
    if (!handle) throw std::bad_alloc();
    return handle;
}

/// What the callbacks need; one per run.
struct CallbackContext {
    Guard& guard;
    nlopt_opt handle;
    bool gradient;  ///< values are computed together with gradients, since the method will ask for both
    double penalty;
    int objectives = 0;  ///< calls of the objective
};

/// CallbackRow -1 is the objective, the others are constraints.
struct CallbackRow {
    CallbackContext* context;
    Eigen::Index index;
};

/// Nothing may be thrown through NLopt: the guard keeps errors. The end is asked for from inside the callback, because
/// COBYLA does not always look at its own limits; not before the second point, because DIRECT with constraints, stopped
/// at its first, returns through an index that it has not set (NLopt 2.7.1, minpos in DIRect.c).
double callback(unsigned n, const double* x, double* gradient, void* data) noexcept {
    const auto& [context, row] = *static_cast<const CallbackRow*>(data);
    const bool objective = row < 0;
    const Evaluation& here = context->guard(Eigen::Map<const Vector>(x, n), context->gradient || gradient != nullptr);
    if (objective) ++context->objectives;
    if (context->guard.halted() && context->objectives > 1) nlopt_force_stop(context->handle);
    if (gradient != nullptr) {
        Eigen::Map<Vector> out(gradient, n);
        if (!here.ok) out.setZero();
        else if (objective) out = here.gradient;
        else out = here.jacobian.row(row).transpose();
    }
    // Finite values: StoGO throws on infinite ones. Every constraint violated, so that the point is never taken for
    // feasible.
    if (!here.ok) return objective ? context->penalty : 1.0;
    return objective ? here.objective : here.constraints[row];
}

/// A row of the table.
struct NloptRow {
    std::string name;
    int algorithm;              ///< nlopt_algorithm when there are no constraints
    int constrained_algorithm;  ///< and with constraints, or none: augmented Lagrangian around it
    Capabilities capabilities;
};
constexpr int none = -1;

void require_compiled(const NloptRow& method) {
    const std::string name = nlopt_algorithm_name(static_cast<nlopt_algorithm>(method.algorithm));
    if (name.find("NOT COMPILED") != std::string::npos) {
        throw std::runtime_error("method = " + method.name +
                                 ": the linked NLopt was built without it; link libnlopt_cxx instead of libnlopt");
    }
}

/// x is judged by its own steps; the value test is much finer, since f is flat at an optimum.
void set_tolerances(nlopt_opt handle, double tolerance, int max_calls) {
    nlopt_set_xtol_rel(handle, tolerance);
    // A variable that ends at zero never meets a relative test.
    nlopt_set_xtol_abs1(handle, tolerance);
    nlopt_set_ftol_rel(handle, std::max(1e-15, tolerance * tolerance));
    nlopt_set_maxeval(handle, max_calls);
}

/// Claims only: SLSQP and MMA also return slightly infeasible points as success. Ended by rounding is often as near as
/// it gets; the check afterwards decides.
SolverAnswer::Claim claim_of(nlopt_result result) {
    switch (result) {
        case NLOPT_SUCCESS:
        case NLOPT_FTOL_REACHED:
        case NLOPT_XTOL_REACHED:
        case NLOPT_ROUNDOFF_LIMITED: return SolverAnswer::Claim::optimum;
        default: return SolverAnswer::Claim::none;
    }
}

/// NLOPT_FAILURE for whatever the library throws; `words` tells what it said.
nlopt_result optimise_without_throwing(nlopt_opt handle, Vector& x, std::string& words) {
    double objective = 0.0;
    try {
        const nlopt_result result = nlopt_optimize(handle, x.data(), &objective);
        words = nlopt_result_to_string(result);
        if (const char* detail = nlopt_get_errmsg(handle)) words += std::string(", ") + detail;
        return result;
    } catch (const std::exception& error) {  // the C++ parts, StoGO and AGS, may
        words = error.what();
    } catch (...) { words = "unknown exception"; }
    return NLOPT_FAILURE;
}

SolverAnswer run_nlopt(Guard& guard, const Vector& start, const NloptRow& method, const Options& options) {
    const MemoisedNlp& nlp = guard.nlp();
    require_compiled(method);
    const int n = nlp.variables();
    const int m = nlp.constraints();
    const bool lagrangian = m > 0 && method.constrained_algorithm < 0;
    // A local method is stopped by the guard, which counts evaluations; a global one knows no other end than its count.
    const int max_calls = method.capabilities.global ? std::max(1, nlp.remaining()) : guard.max_calls();

    Handle handle = create(m == 0 ? method.algorithm : lagrangian ? NLOPT_AUGLAG : method.constrained_algorithm, n);
    CallbackContext context{guard, handle.get(), method.capabilities.gradient, options.failure_penalty};
    std::vector<CallbackRow> rows;
    for (Eigen::Index i = -1; i < m; ++i) rows.push_back({&context, i});

    nlopt_set_min_objective(handle.get(), callback, &rows.front());
    for (std::size_t i = 1; i < rows.size(); ++i) {
        nlopt_add_inequality_constraint(handle.get(), callback, &rows[i], nlp.limits().feasibility_tolerance);
    }
    nlopt_set_lower_bounds(handle.get(), nlp.lower().data());
    nlopt_set_upper_bounds(handle.get(), nlp.upper().data());
    set_tolerances(handle.get(), options.tolerance, max_calls);

    Handle inner;  // NLopt copies local optimisers
    // MLSL runs a local method from its points; SLSQP, as the polish afterwards does.
    if (method.algorithm == NLOPT_G_MLSL_LDS) {
        inner = create(NLOPT_LD_SLSQP, n);
        set_tolerances(inner.get(), options.tolerance, max_calls);
    }
    if (lagrangian) {
        Handle outer_local = create(method.algorithm, n);
        set_tolerances(outer_local.get(), options.tolerance,
                       // A global method takes all the calls it is given, but the augmented Lagrangian needs several
                       // rounds to find its multipliers: at least five.
                       method.capabilities.global ? std::max(1, max_calls / 5) : max_calls);
        if (inner) nlopt_set_local_optimizer(outer_local.get(), inner.get());
        nlopt_set_local_optimizer(handle.get(), outer_local.get());
    } else if (inner) {
        nlopt_set_local_optimizer(handle.get(), inner.get());
    }

    SolverAnswer answer;
    answer.x = start;
    nlopt_srand(static_cast<unsigned long>(options.seed));  // the generator belongs to this thread
    const nlopt_result result = optimise_without_throwing(handle.get(), answer.x, answer.message);
    answer.claim = claim_of(result);
    // Without gradients the last point asked for is just a probe.
    if (method.capabilities.gradient) answer.last = guard.last();
    answer.message = "NLopt " + method.name + ": " + answer.message;
    return answer;
}

constexpr Capabilities local_with(bool gradient) { return {false, gradient}; }
constexpr Capabilities global_with(bool gradient) { return {true, gradient}; }

/// NLopt's praxis never returns when there is one variable only.
constexpr Capabilities praxis_can = {false, false, 2};
/// The limits of the AGS in NLopt.
constexpr Capabilities ags_can = {true, false, 1, 10, 10};

const std::vector<NloptRow>& table() {
    static const std::vector<NloptRow> rows = {
        {"slsqp", NLOPT_LD_SLSQP, NLOPT_LD_SLSQP, local_with(true)},
        {"mma", NLOPT_LD_MMA, NLOPT_LD_MMA, local_with(true)},
        {"ccsaq", NLOPT_LD_CCSAQ, NLOPT_LD_CCSAQ, local_with(true)},
        {"cobyla", NLOPT_LN_COBYLA, NLOPT_LN_COBYLA, local_with(false)},
        {"lbfgs", NLOPT_LD_LBFGS, none, local_with(true)},
        {"bobyqa", NLOPT_LN_BOBYQA, none, local_with(false)},
        {"neldermead", NLOPT_LN_NELDERMEAD, none, local_with(false)},
        {"subplex", NLOPT_LN_SBPLX, none, local_with(false)},
        {"praxis", NLOPT_LN_PRAXIS, none, praxis_can},
        {"direct-l", NLOPT_GN_DIRECT_L, NLOPT_GN_ORIG_DIRECT_L, global_with(false)},
        {"crs2", NLOPT_GN_CRS2_LM, none, global_with(false)},
        {"isres", NLOPT_GN_ISRES, NLOPT_GN_ISRES, global_with(false)},
        {"esch", NLOPT_GN_ESCH, none, global_with(false)},
        {"mlsl", NLOPT_G_MLSL_LDS, none, global_with(true)},
        {"stogo", NLOPT_GD_STOGO, none, global_with(true)},
        {"ags", NLOPT_GN_AGS, NLOPT_GN_AGS, ags_can},
    };
    return rows;
}

}  // namespace

std::vector<Method> nlopt_methods() {
    std::vector<Method> methods;
    for (const NloptRow& row : table()) {
        const auto solver = [&row](Guard& guard, const Vector& start, const Options& options) {
            return run_nlopt(guard, start, row, options);
        };
        methods.push_back({row.name, "NLopt", row.capabilities, solver});
    }
    return methods;
}

}  // namespace percuss::optimise
