#include "optimise/guard.hpp"

namespace percuss::optimise {
namespace {

const Evaluation failed_evaluation{};

}  // namespace

const Evaluation& Guard::operator()(const Vector& x, bool want_gradient) noexcept {
    if (halted()) return failed_evaluation;
    try {
        if (++calls_ > max_calls()) throw Halt(Halt::Reason::circling, "the method goes in circles over known points");
        const Evaluation& evaluation = nlp_.look_up(x, want_gradient);
        if (evaluation.ok) last_ = nlp_.clip(x);
        return evaluation;
    } catch (...) {
        error_ = std::current_exception();
        return failed_evaluation;
    }
}

std::optional<Halt> Guard::halt() const {
    if (!halted()) return std::nullopt;
    try {
        std::rethrow_exception(error_);
    } catch (const Halt& halt) { return halt; }
}

int Guard::max_calls() const {
    // Counts of NLopt are ints: hence at most 1e9.
    return static_cast<int>(std::min(10LL * nlp_.limits().max_evaluations + 1000, 1'000'000'000LL));
}

}  // namespace percuss::optimise
