#pragma once
/// \file
/// Damped Newton's method for F(x) = 0 with an exact Jacobian (P. Deuflhard, Newton Methods for Nonlinear Problems,
/// Springer 2004), the one used everywhere:
///
///     while (can_continue()) {
///         F'(x) s = -F(x);
///         if (|F| and |s| are both small) { x += s; converged; }
///         s is shortened to the longest step allowed;
///         x += s, or with backtracking the first of s, s/2, s/4... that lowers |F|
///     }
///
/// A small residual alone says nothing where F' is nearly singular, a small step alone nothing where it is huge: hence
/// both. Norms are Euclidean; the caller scales its unknowns and equations.

#include "numerics/linear.hpp"

#include <cmath>
#include <cstdint>
#include <limits>
#include <optional>
#include <string_view>
#include <utility>

namespace percuss::numerics {

inline constexpr double unlimited = std::numeric_limits<double>::infinity();

/// The defaults are those of stroboscopic shooting; see the callers for what differs and why.
/// Steps are cut at half the size of the state: a longer one, from a far guess, may lead to a motion with other
/// contacts, of which the linear model knows nothing.
struct NewtonOptions {
    int max_iterations = 25;
    int min_iterations = 1;  ///< convergence is not looked for before
    int max_halvings = 8;    ///< of a step that does not lower the residual; 0: every step is taken whatever it brings
    double residual_tolerance = 1e-11;  ///< on |F|, relative to 1 + |x|
    double step_tolerance = 1e-9;       ///< on the last step, relative to 1 + |x|
    double max_step = 0.5;              ///< longest step, relative to 1 + |x|; `unlimited` for none
    bool residual_is_relative = true;   ///< otherwise residual_tolerance is absolute
    bool max_step_is_relative = true;   ///< otherwise max_step is absolute
    /// The scale 1 + |x| is taken from the first so many unknowns, all when absent: the state without a parameter.
    std::optional<int> unknowns_in_scale{};
    bool take_last_step = true;  ///< otherwise x stays where F and F' were evaluated last
};

enum class NewtonStatus : std::uint8_t {
    not_run,
    converged,
    evaluation_failed,  ///< F could not be evaluated at the start or, without backtracking, where a step led
    singular,           ///< the step is not finite
    no_progress,        ///< no part of the step lowers the residual
    iteration_limit,
};

std::string_view to_string(NewtonStatus status);

/// Throws std::invalid_argument naming the field, its value and the allowed range.
void check(const NewtonOptions& options);

/// What relative tolerances and limits are relative to.
template <class V>
double scale_of(const V& x, const NewtonOptions& options) {
    return 1.0 + x.head(options.unknowns_in_scale.value_or(static_cast<int>(x.size()))).norm();
}

/// F and F' at a point. Types that carry more (what the flow saw on the way) derive from it.
template <class V, class M>
struct Linearised {
    using VectorType = V;
    using MatrixType = M;
    V residual;
    M jacobian;
};

/// What came of it. `at`, `factors`, `residual` and `last_step` belong to the last point evaluated and accepted, x to
/// that point or, converged with take_last_step, to the point one step on.
template <class L>
struct NewtonOutcome {
    NewtonStatus status = NewtonStatus::not_run;
    typename L::VectorType x;
    L at;
    Eigen::PartialPivLU<typename L::MatrixType> factors;  ///< of F' there
    double residual = 0.0;                                ///< |F| there
    double last_step = 0.0;                               ///< |s|, not shortened
    int iterations = 0;                                   ///< linear systems solved
    [[nodiscard]] bool ok() const { return status == NewtonStatus::converged; }
};

/// One run of the method; `newton()` below is the way to call it.
template <class L, class Evaluate>
class NewtonIteration {
public:
    using V = typename L::VectorType;

    NewtonIteration(V start, Evaluate& evaluate, const NewtonOptions& options)
        : evaluate_(evaluate),
          options_(options) {
        check(options);
        out_.x = std::move(start);
    }

    NewtonOutcome<L> run() {
        while (can_continue()) {
            if (!linearise() || !solve_for_step()) { break; }
            if (converged()) { return finish(); }
            limit_step();
            if (!(options_.max_halvings > 0 ? backtrack() : take_step())) { break; }
        }
        return std::move(out_);
    }

private:
    [[nodiscard]] bool can_continue() {
        if (out_.iterations < options_.max_iterations) { return true; }
        out_.status = NewtonStatus::iteration_limit;
        return false;
    }

    /// F and F' at x, where backtracking has not seen them already.
    bool linearise() {
        if (!evaluated_ && !evaluate_(std::as_const(out_.x), out_.at)) {
            out_.status = NewtonStatus::evaluation_failed;
            return false;
        }
        evaluated_ = true;
        out_.residual = out_.at.residual.norm();
        scale_ = scale_of(out_.x, options_);
        return true;
    }

    bool solve_for_step() {
        ++out_.iterations;
        out_.factors.compute(out_.at.jacobian);
        step_ = out_.factors.solve(-out_.at.residual);
        out_.last_step = step_.norm();
        if (step_.allFinite()) { return true; }
        out_.status = NewtonStatus::singular;
        return false;
    }

    [[nodiscard]] double residual_limit() const {
        return options_.residual_tolerance * (options_.residual_is_relative ? scale_ : 1.0);
    }

    [[nodiscard]] bool converged() const {
        return out_.iterations >= options_.min_iterations && out_.residual <= residual_limit() &&
               out_.last_step <= options_.step_tolerance * scale_;
    }

    NewtonOutcome<L> finish() {
        if (options_.take_last_step) { out_.x += step_; }
        out_.status = NewtonStatus::converged;
        return std::move(out_);
    }

    void limit_step() {
        // Only the length is cut, not the direction: it stays a direction of descent of |F|.
        const double longest = options_.max_step * (options_.max_step_is_relative ? scale_ : 1.0);
        if (out_.last_step > longest) { step_ *= longest / out_.last_step; }
    }

    bool take_step() {
        out_.x += step_;
        evaluated_ = false;
        return true;
    }

    /// Armijo's rule on |F|, whose slope along the full step is -|F|: a tenth of what that promises is enough. When
    /// none of the fractions gets so far, a last one that lowers the residual at all is taken.
    bool backtrack() {
        V x = out_.x;
        double norm = 0.0;
        bool evaluated = false;
        double fraction = 1.0;
        for (int halving = 0; halving <= options_.max_halvings; ++halving, fraction *= 0.5) {
            x = out_.x + fraction * step_;
            evaluated = evaluate_(std::as_const(x), trial_);
            norm = evaluated ? trial_.residual.norm() : unlimited;
            if (norm < (1.0 - 0.1 * fraction) * out_.residual) { break; }
        }
        if (!(norm < out_.residual)) {
            // The rounding floor of a badly conditioned orbit: within ten times the tolerance the root is as good as
            // it gets.
            const bool at_floor = out_.residual <= 10.0 * residual_limit();
            out_.status = at_floor ? NewtonStatus::converged : NewtonStatus::no_progress;
            return false;
        }
        out_.x = std::move(x);
        std::swap(out_.at, trial_);
        return true;
    }

    Evaluate& evaluate_;
    const NewtonOptions& options_;
    NewtonOutcome<L> out_;
    L trial_;
    V step_;
    double scale_ = 1.0;
    bool evaluated_ = false;
};

/// Newton's method from `start`. evaluate(const V& x, L& at) -> bool fills in residual (n), jacobian (n x n) and
/// whatever else L carries; false where it cannot, which fails the run or, with backtracking, shortens the step.
/// Throws std::invalid_argument for options that make no sense.
template <class L, class Evaluate>
NewtonOutcome<L> newton(typename L::VectorType start, Evaluate&& evaluate, const NewtonOptions& options) {
    return NewtonIteration<L, std::remove_reference_t<Evaluate>>(std::move(start), evaluate, options).run();
}

}  // namespace percuss::numerics
