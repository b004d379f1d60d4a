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
struct Run {
    Guard& guard;
    nlopt_opt handle;
    bool gradient;  ///< values are computed together with gradients, since the method will ask for both
    double penalty;
    int objectives = 0;  ///< calls of the objective
};

/// Row -1 is the objective, the others are constraints.
struct Row {
    Run* run;
    Eigen::Index index;
};

/// Nothing may be thrown through NLopt: the guard keeps errors. The end is asked for from inside the callback, because
/// COBYLA does not always look at its own limits; not before the second point, because DIRECT with constraints, stopped
/// at its first, returns through an index that it has not set (NLopt 2.7.1, minpos in DIRect.c).
double callback(unsigned n, const double* x, double* gradient, void* data) noexcept {
    const auto& [run, row] = *static_cast<const Row*>(data);
    const bool objective = row < 0;
    const Evaluation& here = run->guard(Eigen::Map<const Vector>(x, n), run->gradient || gradient != nullptr);
    if (objective) ++run->objectives;
    if (run->guard.halted() && run->objectives > 1) nlopt_force_stop(run->handle);
    if (gradient != nullptr) {
        Eigen::Map<Vector> out(gradient, n);
        if (!here.ok) out.setZero();
        else if (objective) out = here.gradient;
        else out = here.jacobian.row(row).transpose();
    }
    if (!here.ok) return objective ? run->penalty : 1.0;
    return objective ? here.objective : here.constraints[row];
}

void check_supported(const NloptMethod& method, const MemoisedNlp& nlp) {
    std::ostringstream message;
    if (method.global && !(nlp.lower().allFinite() && nlp.upper().allFinite())) {
        message << "method = " << method.name << ": it is global and needs finite bounds for every variable";
        throw std::invalid_argument(message.str());
    }
    if (method.algorithm == NLOPT_LN_PRAXIS && nlp.variables() < 2) {  // NLopt's praxis never returns
        message << "method = praxis: 1 variable, must be at least 2";
        throw std::invalid_argument(message.str());
    }
    if (method.algorithm == NLOPT_GN_AGS && (nlp.variables() > 10 || nlp.constraints() > 10)) {
        message << "method = ags: " << nlp.variables() << " variables and " << nlp.constraints()
                << " constraints, must be at most 10 of each";
        throw std::invalid_argument(message.str());
    }
    const std::string name = nlopt_algorithm_name(static_cast<nlopt_algorithm>(method.algorithm));
    if (name.find("NOT COMPILED") != std::string::npos) {
        throw std::runtime_error("method = " + method.name +
                                 ": the linked NLopt was built without it; link libnlopt_cxx instead of libnlopt");
    }
}

/// x is judged by its own steps; the value test is much finer, since f is flat at an optimum.
void set_tolerances(nlopt_opt handle, double tolerance, int max_calls) {
    nlopt_set_xtol_rel(handle, tolerance);
    nlopt_set_xtol_abs1(handle, tolerance);
    nlopt_set_ftol_rel(handle, std::max(1e-15, tolerance * tolerance));
    nlopt_set_maxeval(handle, max_calls);
}

SolverAnswer::Claim claim_of(nlopt_result result) {
    switch (result) {
        case NLOPT_SUCCESS:
        case NLOPT_FTOL_REACHED:
        case NLOPT_XTOL_REACHED:
        case NLOPT_ROUNDOFF_LIMITED: return SolverAnswer::Claim::optimum;
        default: return SolverAnswer::Claim::none;
    }
}

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

}  // namespace

const std::vector<NloptMethod>& nlopt_methods() {
    constexpr int none = -1;
    static const std::vector<NloptMethod> table = {
        {"slsqp", NLOPT_LD_SLSQP, NLOPT_LD_SLSQP, false, true},
        {"mma", NLOPT_LD_MMA, NLOPT_LD_MMA, false, true},
        {"ccsaq", NLOPT_LD_CCSAQ, NLOPT_LD_CCSAQ, false, true},
        {"cobyla", NLOPT_LN_COBYLA, NLOPT_LN_COBYLA, false, false},
        {"lbfgs", NLOPT_LD_LBFGS, none, false, true},
        {"bobyqa", NLOPT_LN_BOBYQA, none, false, false},
        {"neldermead", NLOPT_LN_NELDERMEAD, none, false, false},
        {"subplex", NLOPT_LN_SBPLX, none, false, false},
        {"praxis", NLOPT_LN_PRAXIS, none, false, false},
        {"direct-l", NLOPT_GN_DIRECT_L, NLOPT_GN_ORIG_DIRECT_L, true, false},
        {"crs2", NLOPT_GN_CRS2_LM, none, true, false},
        {"isres", NLOPT_GN_ISRES, NLOPT_GN_ISRES, true, false},
        {"esch", NLOPT_GN_ESCH, none, true, false},
        {"mlsl", NLOPT_G_MLSL_LDS, none, true, true},
        {"stogo", NLOPT_GD_STOGO, none, true, true},
        {"ags", NLOPT_GN_AGS, NLOPT_GN_AGS, true, false},
    };
    return table;
}

SolverAnswer run_nlopt(Guard& guard, const Vector& start, const NloptMethod& method, const Options& options) {
    const MemoisedNlp& nlp = guard.nlp();
    check_supported(method, nlp);
    const int n = nlp.variables();
    const int m = nlp.constraints();
    const bool lagrangian = m > 0 && method.constrained_algorithm < 0;
    // A local method is stopped by the guard, which counts evaluations; a global one knows no other end than its count.
    const int max_calls = method.global ? std::max(1, nlp.remaining()) : guard.max_calls();

    Handle handle = create(m == 0 ? method.algorithm : lagrangian ? NLOPT_AUGLAG : method.constrained_algorithm, n);
    Run run{guard, handle.get(), method.gradient, options.failure_penalty};
    std::vector<Row> rows;
    for (Eigen::Index i = -1; i < m; ++i) rows.push_back({&run, i});

    nlopt_set_min_objective(handle.get(), callback, &rows.front());
    for (std::size_t i = 1; i < rows.size(); ++i) {
        nlopt_add_inequality_constraint(handle.get(), callback, &rows[i], nlp.limits().feasibility_tolerance);
    }
    nlopt_set_lower_bounds(handle.get(), nlp.lower().data());
    nlopt_set_upper_bounds(handle.get(), nlp.upper().data());
    set_tolerances(handle.get(), options.tolerance, max_calls);

    Handle inner;  // NLopt copies local optimisers
    if (method.algorithm == NLOPT_G_MLSL_LDS) {
        inner = create(NLOPT_LD_SLSQP, n);
        set_tolerances(inner.get(), options.tolerance, max_calls);
    }
    if (lagrangian) {
        Handle outer_local = create(method.algorithm, n);
        set_tolerances(outer_local.get(), options.tolerance, method.global ? std::max(1, max_calls / 5) : max_calls);
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
    if (method.gradient) answer.last = guard.last();
    answer.message = "NLopt " + method.name + ": " + answer.message;
    return answer;
}

}  // namespace percuss::optimise
