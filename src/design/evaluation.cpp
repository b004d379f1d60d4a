#include "design/evaluation.hpp"

namespace percuss::design {

std::string_view to_string(EvaluationStatus status) {
    switch (status) {
        case EvaluationStatus::not_run: return "not-run";
        case EvaluationStatus::ok: return "ok";
        case EvaluationStatus::no_impact: return "no-impact";
        case EvaluationStatus::not_unique: return "not-unique";
        case EvaluationStatus::unstable: return "unstable";
        case EvaluationStatus::failed: return "failed";
    }
    return "unknown";
}

std::string_view to_string(EdgeKind kind) {
    switch (kind) {
        case EdgeKind::none: return "none";
        case EdgeKind::grazing: return "grazing";
        case EdgeKind::fold: return "fold";
        case EdgeKind::flip: return "flip";
        case EdgeKind::torus: return "torus";
        case EdgeKind::given: return "given";
    }
    return "unknown";
}

std::string_view to_string(Verdict verdict) {
    switch (verdict) {
        case Verdict::not_checked: return "not-checked";
        case Verdict::unique: return "unique";
        case Verdict::not_unique: return "not-unique";
    }
    return "unknown";
}

Evaluation::Evaluation() {
    quantities.fill(absent);
    error_estimates.fill(absent);
}

std::string reason_of_limit(const flow::Cost& cost) {
    switch (cost.allowance()) {
        case flow::Status::ok: return "";
        case flow::Status::cancelled: return "cancelled";
        default: return "the budget of " + std::to_string(cost.step_budget) + " integration steps is spent";
    }
}

}  // namespace percuss::design
