#pragma once
/// \file
/// The evaluator as foreign solvers may call it: nothing is thrown through their frames.

#include "optimise/memoised_nlp.hpp"

#include <exception>

namespace percuss::optimise {

/// Evaluates for one run of a solver. The first exception, Halt or other, is kept, and from then on every call is a
/// failed evaluation, so that an adapter only has to look at halted() and leave its solver. A solver that goes in
/// circles over known points, which cost nothing, is halted after 10 max_evaluations + 1000 calls (NLopt 2.7.1's COBYLA
/// does that for ever on some problems without a feasible point).
class Guard {
public:
    explicit Guard(MemoisedNlp& nlp) : nlp_(nlp) {}
    Guard(const Guard&) = delete;
    Guard& operator=(const Guard&) = delete;

    const Evaluation& operator()(const Vector& x, bool want_gradient) noexcept;

    [[nodiscard]] const MemoisedNlp& nlp() const { return nlp_; }
    /// The last point that was evaluated with success; empty if none.
    [[nodiscard]] const Vector& last() const { return last_; }
    [[nodiscard]] bool halted() const noexcept { return error_ != nullptr; }

    /// Null if not halted, or the Halt that ended the run. An exception of the evaluator is thrown again.
    [[nodiscard]] std::optional<Halt> halt() const;

    /// Safety net for solvers' own counts of calls.
    [[nodiscard]] int max_calls() const;

private:
    MemoisedNlp& nlp_;
    int calls_ = 0;
    Vector last_;
    std::exception_ptr error_;
};

}  // namespace percuss::optimise
