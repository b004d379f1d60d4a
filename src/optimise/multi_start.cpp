#include "optimise/multi_start.hpp"

#include "optimise/elastic_nlp.hpp"
#include "optimise/halton.hpp"
#include "optimise/memoised_nlp.hpp"
#include "optimise/solve.hpp"

#include <algorithm>
#include <cmath>
#include <optional>
#include <sstream>
#include <stdexcept>
#include <utility>

namespace percuss::optimise {
namespace {

using Status = Outcome::Status;

void check(const MultiStartOptions& options, const MemoisedNlp& memo) {
    check(options.solver);
    std::ostringstream message;
    if (options.candidates < 0) {
        message << "candidates = " << options.candidates << ", must be >= 0";
    } else if (options.starts < 0) {
        message << "starts = " << options.starts << ", must be >= 0";
    } else if (options.polish_rounds < 0) {
        message << "polish_rounds = " << options.polish_rounds << ", must be >= 0";
    } else if (!(options.separation >= 0)) {
        message << "separation = " << options.separation << ", must be >= 0";
    } else if (!(options.certificate_tolerance > 0)) {
        message << "certificate_tolerance = " << options.certificate_tolerance << ", must be > 0";
    } else if (!(options.elastic_floor < 0)) {
        message << "elastic_floor = " << options.elastic_floor << ", must be < 0";
    } else if (options.warm_starts.empty() && (options.candidates == 0 || options.starts == 0)) {
        message << "candidates = " << options.candidates << ", starts = " << options.starts
                << ": must both be > 0 when there are no warm starts";
    } else if (options.candidates > 0 && !(memo.lower().allFinite() && memo.upper().allFinite())) {
        message << "candidates = " << options.candidates << ": must be 0 where bounds are infinite";
    }
    for (const Vector& start : options.warm_starts) {
        if (start.size() == memo.variables() && start.allFinite()) continue;
        message << "warm start = (" << start.transpose() << "), must be " << memo.variables() << " finite numbers";
        break;
    }
    if (!message.str().empty()) throw std::invalid_argument(message.str());
}

Visited visited(const Outcome& outcome) {
    return {outcome.x, outcome.objective, outcome.constraints, outcome.infeasibility};
}

/// What is seen as equal: objectives, or violations, that differ by no more than constraints may be off.
/// The factor stands for multipliers above 1: a constraint that is off by the tolerance moves the objective by its
/// multiplier times that.
double tie(double value, double feasibility_tolerance) {
    return 10 * feasibility_tolerance * std::max(1.0, std::abs(value));
}

/// A point and how good it is proved to be.
struct Best {
    Visited point;
    Certificate certificate;
};

class Search {
public:
    Search(Nlp& nlp, const MultiStartOptions& options)
        : options_(options),
          memo_(nlp, {options.solver.max_evaluations, options.solver.feasibility_tolerance, options.solver.cancelled}) {
        check(options_, memo_);
    }

    void look_around();
    void solve_from_starts();
    [[nodiscard]] bool found_feasible() const { return memo_.best_feasible().has_value(); }
    void relax();
    void solve_from_best();
    [[nodiscard]] bool wants_polish() const;
    void polish();
    [[nodiscard]] MultiStartResult result();

private:
    [[nodiscard]] std::vector<Vector> separated_starts() const;
    [[nodiscard]] Options share(int solves_left) const;
    [[nodiscard]] std::string polish_method(int round) const;
    [[nodiscard]] bool proved(const std::optional<Best>& best) const {
        return best && best->certificate.certified(options_.certificate_tolerance);
    }
    [[nodiscard]] Best uncertified(const Visited& point) const;
    Outcome solve(Nlp& nlp, const Vector& start, const Options& options);
    void relax_from(const Vector& start, const Options& options);
    void consider(const Visited& point);
    void consider_elastic(const Visited& point);
    template <class Function>
    void until_halted(Function&& function);

    const MultiStartOptions& options_;
    MemoisedNlp memo_;
    std::vector<Visited> ranked_;  ///< candidates that could be evaluated, best first
    std::optional<Best> best_;     ///< feasible
    std::optional<Best> elastic_;  ///< least infeasible, with the certificate of the elastic problem
    std::string halted_;           ///< why nothing more may be evaluated; empty: it may
    int polished_ = 0;
    int in_vain_ = 0;  ///< polishes in a row that improved nothing
    MultiStartResult result_;
};

template <class Function>
void Search::until_halted(Function&& function) {
    try {
        function();
    } catch (const Halt& halt) { halted_ = halt.what(); }
}

void Search::look_around() {
    if (options_.candidates == 0) return;
    const Halton sequence(memo_.variables(), options_.solver.seed);
    const Vector lower = memo_.lower();
    const Vector width = memo_.upper() - lower;
    until_halted([&] {
        // In a box where most designs fail, all the candidates asked for may: the sequence then goes on for a while.
        for (int k = 0; k < options_.candidates || (ranked_.empty() && k < 8 * options_.candidates); ++k) {
            const Vector x = lower + width.cwiseProduct(sequence.point(static_cast<std::uint64_t>(k)));
            const Evaluation here = memo_.evaluate(x, false);
            ++result_.candidates_evaluated;
            if (here.ok) ranked_.push_back({x, here.objective, here.constraints, infeasibility_of(here.constraints)});
            else ++result_.candidates_failed;
        }
    });
    const double tolerance = options_.solver.feasibility_tolerance;
    const auto rank = [&](const Visited& v) {
        const bool feasible = v.infeasibility <= tolerance;
        return std::pair(!feasible, feasible ? v.objective : v.infeasibility);
    };
    // Feasible ones first, by objective; the others by violation. Stable: equals stay in the order of the sequence.
    std::stable_sort(ranked_.begin(), ranked_.end(),
                     [&](const Visited& a, const Visited& b) { return rank(a) < rank(b); });
}

/// The warm starts, then candidates in the order of their rank that are not too close to an earlier start.
std::vector<Vector> Search::separated_starts() const {
    const Vector width = memo_.upper() - memo_.lower();
    std::vector<Vector> starts = options_.warm_starts;
    const std::size_t wanted = starts.size() + static_cast<std::size_t>(options_.starts);
    for (const Visited& candidate : ranked_) {
        if (starts.size() >= wanted) break;
        const bool apart = std::all_of(starts.begin(), starts.end(), [&](const Vector& start) {
            return (start - candidate.x).cwiseQuotient(width).lpNorm<Eigen::Infinity>() >= options_.separation;
        });
        if (apart) starts.push_back(candidate.x);
    }
    // A global method searches the whole box each time, wherever it starts.
    if (is_global(options_.solver.method) && starts.size() > 1) starts.resize(1);
    return starts;
}

/// The caller's options with an equal part of the evaluations that are left, one part kept back, but no useless part.
Options Search::share(int solves_left) const {
    Options options = options_.solver;
    options.warm = false;
    // One part more than solves are left: what the last of them leaves is for the polish.
    options.max_evaluations = std::min(memo_.remaining(), std::max(50, memo_.remaining() / (solves_left + 1)));
    return options;
}

/// minimise, noticing when the whole budget (and not just a share) is at its end.
Outcome Search::solve(Nlp& nlp, const Vector& start, const Options& options) {
    Outcome outcome = minimise(nlp, start, options);
    if (outcome.status == Status::budget && (memo_.remaining() == 0 || (options.cancelled && options.cancelled()))) {
        halted_ = outcome.message;
    }
    return outcome;
}

void Search::solve_from_starts() {
    const std::vector<Vector> starts = separated_starts();
    for (std::size_t k = 0; k < starts.size() && halted_.empty(); ++k) {
        Options options = share(static_cast<int>(starts.size() - k));
        options.warm = options_.solver.warm && k < options_.warm_starts.size();
        result_.locals.push_back(solve(memo_, starts[k], options));
        if (result_.locals.back().feasible) consider(visited(result_.locals.back()));
    }
    // Also a candidate or a point on the way, which no solver ended on.
    if (found_feasible()) consider(*memo_.best_feasible());
}

Best Search::uncertified(const Visited& point) const {
    Best best{point, {}};
    best.certificate.multipliers = Vector::Zero(memo_.constraints());
    best.certificate.bound_multipliers = Vector::Zero(memo_.variables());
    return best;
}

/// A clearly lower objective wins; between equals the smaller KKT residual.
void Search::consider(const Visited& point) {
    Best candidate = uncertified(point);
    until_halted([&] {
        candidate.certificate =
            certify(memo_.look_up(point.x, true), point.x, memo_.lower(), memo_.upper(), options_.certificate);
    });
    if (best_) {
        const double gain = best_->point.objective - point.objective;
        const double equal = tie(point.objective, options_.solver.feasibility_tolerance);
        const bool closer = candidate.certificate.residual < best_->certificate.residual;
        if (gain < -equal || (gain <= equal && !closer)) return;
    }
    best_ = std::move(candidate);
}

/// The same for points outside the feasible set, by their largest violation.
void Search::consider_elastic(const Visited& point) {
    Best candidate = uncertified(point);
    // A ceiling well above t, or its bound would count as active in the certificate.
    ElasticNlp elastic(memo_, options_.elastic_floor, 2 * point.infeasibility + 1);
    const Vector z = ElasticNlp::joined(point.x, point.infeasibility);
    until_halted([&] {
        candidate.certificate =
            certify(elastic.evaluate(z, true), z, elastic.lower(), elastic.upper(), options_.certificate);
        // Without that of t, which is no variable of the caller.
        candidate.certificate.bound_multipliers.conservativeResize(memo_.variables());
    });
    if (elastic_) {
        const double gain = elastic_->point.infeasibility - point.infeasibility;
        const double equal = tie(point.infeasibility, options_.solver.feasibility_tolerance);
        const bool closer = candidate.certificate.residual < elastic_->certificate.residual;
        if (gain < -equal || (gain <= equal && !closer)) return;
    }
    elastic_ = std::move(candidate);
}

void Search::relax_from(const Vector& start, const Options& options) {
    double t = 0;
    until_halted([&] { t = infeasibility_of(memo_.look_up(start, false).constraints); });
    ElasticNlp elastic(memo_, options_.elastic_floor, 2 * t + 1);
    // With t above the largest violation the start is strictly feasible for the relaxed problem.
    const Outcome outcome = solve(elastic, ElasticNlp::joined(start, 1.1 * t + 1e-3), options);
    if (outcome.constraints.size() == 0) return;
    const Vector x = memo_.clip(outcome.x.head(memo_.variables()));
    until_halted([&] {
        const Evaluation& here = memo_.look_up(x, false);
        if (here.ok) consider_elastic({x, here.objective, here.constraints, infeasibility_of(here.constraints)});
    });
}

/// The elastic phase: ends at a feasible point, or at a least infeasible one and its certificate.
void Search::relax() {
    if (!memo_.least_infeasible()) return;
    consider_elastic(*memo_.least_infeasible());
    std::vector<Vector> starts = separated_starts();
    // The least infeasible point of the local solves lies nearest to a way in.
    starts.insert(starts.begin(), memo_.least_infeasible()->x);
    const auto unfinished = [&] { return !found_feasible() && halted_.empty(); };
    for (std::size_t k = 0; k < starts.size() && unfinished(); ++k) {
        Options options = share(static_cast<int>(starts.size() - k));
        // From a point, not over the box once more.
        if (is_global(options.method)) options.method = "slsqp";
        relax_from(starts[k], options);
    }
    if (unfinished()) consider_elastic(*memo_.least_infeasible());
    for (int round = 0; round < options_.polish_rounds && unfinished() && !proved(elastic_); ++round) {
        Options options = share(options_.polish_rounds - round);
        options.method = polish_method(round);
        relax_from(elastic_->point.x, options);
    }
}

void Search::solve_from_best() {
    if (halted_.empty()) {
        result_.locals.push_back(solve(memo_, memo_.best_feasible()->x, share(1)));
        if (result_.locals.back().feasible) consider(visited(result_.locals.back()));
    }
    consider(*memo_.best_feasible());
}

bool Search::wants_polish() const {
    return best_ && halted_.empty() && polished_ < options_.polish_rounds && in_vain_ < 2 && !proved(best_);
}

/// slsqp and ipopt in turn, not beginning with the one that has just been at work.
std::string Search::polish_method(int round) const {
    // What one of them cannot improve the other may: their models, steps and tests differ. Global methods end with a
    // polish by slsqp.
    const bool was_slsqp = options_.solver.method == "slsqp" || is_global(options_.solver.method);
    return was_slsqp == (round % 2 == 0) ? "ipopt" : "slsqp";
}

void Search::polish() {
    Options options = share(options_.polish_rounds - polished_);
    options.method = polish_method(polished_);
    // Solvers scale their tests in other ways than the certificate: they are asked for a tenth of it.
    options.tolerance = std::min(options.tolerance, 0.1 * options_.certificate_tolerance);
    // Each method begins where the point is; should neither certify it so, Ipopt takes its usual way through the
    // interior.
    options.warm = polished_ < 2;
    ++polished_;
    const Best before = *best_;
    const Outcome outcome = solve(memo_, before.point.x, options);
    if (outcome.feasible) consider(visited(outcome));
    const double gain = before.point.objective - best_->point.objective;
    // A polish counts if it lowers the objective for certain or halves the residual; two in a row that do not, one by
    // each method, end it: kinks and edges of what can be evaluated have no certificate.
    const bool improved = gain > tie(before.point.objective, options.feasibility_tolerance) ||
                          best_->certificate.residual < 0.5 * before.certificate.residual;
    in_vain_ = improved ? 0 : in_vain_ + 1;
}

MultiStartResult Search::result() {
    Outcome& best = result_.best;
    best.evaluations = memo_.evaluations();
    const std::optional<Best>& shown = best_ ? best_ : elastic_;
    if (shown) {
        best.x = shown->point.x;
        best.objective = shown->point.objective;
        best.constraints = shown->point.constraints;
        best.infeasibility = shown->point.infeasibility;
        best.feasible = best_.has_value();
        result_.certificate = shown->certificate;
    }
    if (!halted_.empty()) {
        best.status = Status::budget;
        best.message = halted_;
    } else if (proved(best_)) {
        best.status = Status::converged;
        best.message = "certified";
    } else if (best_) {
        std::ostringstream message;
        message << "not certified: KKT residual " << best_->certificate.residual << ", complementarity "
                << best_->certificate.complementarity << ", tolerance " << options_.certificate_tolerance;
        best.status = Status::failed;
        best.message = message.str();
    } else if (elastic_) {
        best.status = Status::infeasible;
        best.message = proved(elastic_) ? "no small change reduces the largest violation"
                                        : "no feasible point found, nor a proved minimum of the largest violation";
    } else {
        best.status = Status::failed;
        best.message = "no start could be evaluated";
    }
    return std::move(result_);
}

}  // namespace

MultiStartResult multi_start(Nlp& nlp, const MultiStartOptions& options) {
    Search search(nlp, options);
    search.look_around();
    search.solve_from_starts();
    if (!search.found_feasible()) {
        search.relax();
        if (search.found_feasible()) search.solve_from_best();
    }
    while (search.wants_polish()) search.polish();
    return search.result();
}

}  // namespace percuss::optimise
