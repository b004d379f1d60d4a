#include "optimise/ipopt_solver.hpp"

#include <mutex>

#ifndef HAVE_CSTDDEF
#define HAVE_CSTDDEF 1  // Debian's Ipopt headers ask for a configuration macro
#endif
#if __has_include(<coin/IpIpoptApplication.hpp>)
#include <coin/IpIpoptApplication.hpp>
#include <coin/IpTNLP.hpp>
#else
#include <coin-or/IpIpoptApplication.hpp>
#include <coin-or/IpTNLP.hpp>
#endif

namespace percuss::optimise {
namespace {

using Ipopt::Index;
using Ipopt::Number;
using Lock = std::unique_lock<std::mutex>;

constexpr double ipopt_infinity = 2e19;  // Ipopt takes bounds beyond 1e19 as absent

/// Held by whoever is inside Ipopt. Two threads in Debian's Ipopt 3.11.9 with MUMPS 5.5.1 at once crash, or worse.
std::mutex& ipopt_mutex() {
    static std::mutex mutex;
    return mutex;
}

/// Unlocked for the length of a scope.
class Released {
public:
    explicit Released(Lock& lock) : lock_(lock) { lock_.unlock(); }
    ~Released() { lock_.lock(); }
    Released(const Released&) = delete;
    Released& operator=(const Released&) = delete;

private:
    Lock& lock_;
};

/// The problem as Ipopt sees it. Values are always computed together with gradients: a point with a value then has a
/// gradient, which is the only kind of point where Ipopt can survive without one.
class Problem final : public Ipopt::TNLP {
public:
    Problem(Guard& guard, Lock& lock, Vector start) : guard_(guard), lock_(lock), x_(std::move(start)) {}

    [[nodiscard]] const Vector& x() const { return x_; }
    [[nodiscard]] int iterations() const { return iterations_; }

    bool get_nlp_info(Index& n, Index& m, Index& jacobian_entries, Index& hessian_entries,
                      IndexStyleEnum& index_style) override {
        n = guard_.nlp().variables();
        m = guard_.nlp().constraints();
        jacobian_entries = n * m;
        hessian_entries = 0;
        index_style = C_STYLE;
        return true;
    }

    bool get_bounds_info(Index n, Number* x_lower, Number* x_upper, Index m, Number* c_lower,
                         Number* c_upper) override {
        write(x_lower, guard_.nlp().lower().cwiseMax(Vector::Constant(n, -ipopt_infinity)));
        write(x_upper, guard_.nlp().upper().cwiseMin(Vector::Constant(n, ipopt_infinity)));
        write(c_lower, Vector::Constant(m, -ipopt_infinity));
        write(c_upper, Vector::Zero(m));
        return true;
    }

    bool get_starting_point(Index /*n*/, bool init_x, Number* x, bool init_z, Number* /*z_lower*/, Number* /*z_upper*/,
                            Index /*m*/, bool init_lambda, Number* /*lambda*/) override {
        // No multipliers to begin with; Ipopt estimates its own.
        if (init_z || init_lambda) return false;
        if (init_x) write(x, x_);
        return true;
    }

    bool eval_f(Index n, const Number* x, bool /*new_x*/, Number& objective) override {
        const Evaluation& here = evaluate(n, x);
        if (here.ok) objective = here.objective;
        return here.ok;
    }

    bool eval_grad_f(Index n, const Number* x, bool /*new_x*/, Number* gradient) override {
        const Evaluation& here = evaluate(n, x);
        if (here.ok) write(gradient, here.gradient);
        return here.ok;
    }

    bool eval_g(Index n, const Number* x, bool /*new_x*/, Index /*m*/, Number* constraints) override {
        const Evaluation& here = evaluate(n, x);
        if (here.ok) write(constraints, here.constraints);
        return here.ok;
    }

    bool eval_jac_g(Index n, const Number* x, bool /*new_x*/, Index m, Index /*entries*/, Index* rows, Index* columns,
                    Number* values) override {
        if (values == nullptr) {  // asked for the structure: dense, row by row
            for (Index k = 0; k < m * n; ++k) {
                rows[k] = k / n;
                columns[k] = k % n;
            }
            return true;
        }
        const Evaluation& here = evaluate(n, x);
        if (!here.ok) return false;
        for (Index k = 0; k < m * n; ++k) values[k] = here.jacobian(k / n, k % n);
        return true;
    }

    bool intermediate_callback(Ipopt::AlgorithmMode /*mode*/, Index iteration, Number, Number, Number, Number, Number,
                               Number, Number, Number, Index, const Ipopt::IpoptData*,
                               Ipopt::IpoptCalculatedQuantities*) override {
        iterations_ = std::max(iterations_, static_cast<int>(iteration));
        // Failed evaluations alone would make Ipopt shorten its steps on and on: a halted guard has to be told here.
        return !guard_.halted();
    }

    void finalize_solution(Ipopt::SolverReturn /*status*/, Index n, const Number* x, const Number*, const Number*,
                           Index, const Number*, const Number*, Number, const Ipopt::IpoptData*,
                           Ipopt::IpoptCalculatedQuantities*) override {
        if (x != nullptr) x_ = Eigen::Map<const Vector>(x, n);
    }

private:
    static void write(Number* target, const Vector& source) { std::copy(source.begin(), source.end(), target); }

    const Evaluation& evaluate(Index n, const Number* x) {
        const Vector point = Eigen::Map<const Vector>(x, n);
        const Released released(lock_);
        return guard_(point, true);
    }

    Guard& guard_;
    Lock& lock_;
    Vector x_;
    int iterations_ = 0;
};

/// stay_put: begin where the start is, not pushed inwards as interior-point methods like it, and with a small barrier:
/// for a start that is nearly an optimum, or beside a region where nothing can be evaluated.
void configure(Ipopt::OptionsList& list, const Options& options, const Limits& limits, bool stay_put) {
    list.SetIntegerValue("print_level", 0);
    list.SetStringValue("sb", "yes");
    list.SetStringValue("hessian_approximation", "limited-memory");
    // More pairs than there are variables (ten or so): the model can hold the whole curvature.
    list.SetIntegerValue("limited_memory_max_history", 12);
    list.SetStringValue("nlp_scaling_method", "none");  // the caller has scaled
    // By default Ipopt moves the bounds outwards by 1e-8 and evaluates there, where points are clipped to the bounds
    // and gradients belong to other points than it thinks.
    list.SetNumericValue("bound_relax_factor", 0.0);
    list.SetStringValue("honor_original_bounds", "yes");
    list.SetNumericValue("tol", options.tolerance);
    // Ipopt wants it positive; the caller's tolerance may be zero.
    list.SetNumericValue("constr_viol_tol", std::max(1e-12, limits.feasibility_tolerance));
    list.SetNumericValue("compl_inf_tol", options.tolerance);
    list.SetNumericValue("dual_inf_tol", std::max(1e-12, 100 * options.tolerance));
    // Not meant to be the end of a run: the guard counts evaluations.
    list.SetIntegerValue("max_iter", std::max(100, limits.max_evaluations));
    if (!stay_put) return;
    for (const char* name : {"bound_push", "bound_frac", "slack_bound_push", "slack_bound_frac"}) {
        list.SetNumericValue(name, 1e-8);
    }
    list.SetNumericValue("mu_init", 1e-5);
}

/// "Acceptable level" is no claim: it means that Ipopt stalled above its tolerance.
SolverAnswer::Claim claim_of(Ipopt::ApplicationReturnStatus status) {
    if (status == Ipopt::Solve_Succeeded) return SolverAnswer::Claim::optimum;
    if (status == Ipopt::Infeasible_Problem_Detected) return SolverAnswer::Claim::infeasible;
    return SolverAnswer::Claim::none;
}

std::string words_for(Ipopt::ApplicationReturnStatus status) {
    switch (status) {
        case Ipopt::Solve_Succeeded: return "optimum found";
        case Ipopt::Solved_To_Acceptable_Level: return "stalled at a less accurate point";
        case Ipopt::Infeasible_Problem_Detected: return "converged to a local minimum of infeasibility";
        case Ipopt::Search_Direction_Becomes_Too_Small: return "search direction becomes too small";
        case Ipopt::Diverging_Iterates: return "iterates diverge";
        case Ipopt::User_Requested_Stop: return "ended by request";
        case Ipopt::Maximum_Iterations_Exceeded: return "too many iterations";
        case Ipopt::Restoration_Failed: return "restoration of feasibility failed";
        case Ipopt::Error_In_Step_Computation: return "no step could be computed";
        case Ipopt::Not_Enough_Degrees_Of_Freedom: return "not enough degrees of freedom";
        case Ipopt::Invalid_Number_Detected: return "evaluation failed where Ipopt cannot do without";
        default: return "ended with status " + std::to_string(static_cast<int>(status));
    }
}

/// How one run of Ipopt ended.
struct Ending {
    Ipopt::ApplicationReturnStatus status;
    Vector x;
    int iterations;
};

Ending run_once(Guard& guard, const Vector& start, const Options& options, bool stay_put) {
    Lock lock(ipopt_mutex());  // outlives the objects of Ipopt
    const Ipopt::SmartPtr<Problem> problem = new Problem(guard, lock, start);
    const Ipopt::SmartPtr<Ipopt::IpoptApplication> application = IpoptApplicationFactory();
    configure(*application->Options(), options, guard.nlp().limits(), stay_put);
    Ipopt::ApplicationReturnStatus status = application->Initialize("");  // "": no ipopt.opt from the folder is read
    if (status == Ipopt::Solve_Succeeded) status = application->OptimizeTNLP(Ipopt::GetRawPtr(problem));
    return {status, problem->x(), problem->iterations()};
}

SolverAnswer run_ipopt(Guard& guard, const Vector& start, const Options& options) {
    Ending ending = run_once(guard, start, options, options.warm);
    // Ipopt pushes the start inwards; where that lands in a region that cannot be evaluated it ends before its first
    // iteration.
    const bool never_left = ending.status != Ipopt::Solve_Succeeded && ending.iterations == 0;
    if (never_left && !options.warm && !guard.halted()) ending = run_once(guard, start, options, true);
    return {claim_of(ending.status), ending.x, guard.last(), "Ipopt: " + words_for(ending.status)};
}

}  // namespace

std::vector<Method> ipopt_methods() {
    Capabilities local;
    local.gradient = true;
    return {{"ipopt", "Ipopt", local, run_ipopt}};
}

}  // namespace percuss::optimise
