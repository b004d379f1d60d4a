#include "numerics/arclength.hpp"

#include "numerics/bordered.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

namespace percuss::numerics {
namespace {

using Linear = Linearised<Vector, Matrix>;

}  // namespace

ArclengthWalker::ArclengthWalker(CurveFunction function, ArclengthOptions options)
    : function_(std::move(function)),
      options_(options) {}

// F' t = 0 and orientation . t = 1, scaled to length 1: the tangent on the side that `orientation` points to. Bordering
// by the last tangent keeps the matrix regular through folds, where F' without the parameter's column is singular.
bool ArclengthWalker::solve_tangent(const Vector& orientation) {
    Vector right = Vector::Zero(orientation.size());
    right[right.size() - 1] = 1.0;
    const Vector t = bordered_below(jacobian_, orientation).partialPivLu().solve(right);
    if (!t.allFinite()) { return false; }
    tangent_ = t.normalized();
    return true;
}

bool ArclengthWalker::start(const Vector& u, double direction) {
    Vector along = Vector::Zero(u.size());
    along[u.size() - 1] = direction;
    return start_along(u, along);
}

bool ArclengthWalker::on_plane(const Vector& u, const Vector& through, const Vector& normal, Matrix& jacobian,
                               Vector& residual, Matrix& bordered) {
    if (!function_(u, f_, jacobian)) { return false; }
    residual.resize(u.size());
    residual.head(f_.size()) = f_;
    residual[residual.size() - 1] = normal.dot(u - through);
    bordered = bordered_below(jacobian, normal);
    return true;
}

NewtonOptions ArclengthWalker::newton_options() const {
    // Predictions are close and a bad one is answered by a shorter step along the curve: the plain method.
    return {.max_iterations = options_.newton_iterations,
            .max_halvings = 0,
            .residual_tolerance = options_.tolerance,
            .step_tolerance = options_.step_tolerance,
            .max_step = unlimited};
}

bool ArclengthWalker::start_along(const Vector& u, const Vector& direction) {
    const Vector along = direction.normalized();
    NewtonOptions newton_at_start = newton_options();
    // The first guess is not a prediction: three times the iterations. The point is to be on the curve as exactly as
    // rounding allows, with the Jacobian of that very point for its tangent.
    newton_at_start.max_iterations *= 3;
    newton_at_start.step_tolerance = 1e-9;
    newton_at_start.take_last_step = false;
    // Every step is at right angles to `along`: the plane through the iterate is the one through u, without rounding.
    const auto across = [&](const Vector& x, Linear& at) {
        return on_plane(x, x, along, jacobian_, at.residual, at.jacobian);
    };
    const auto found = newton<Linear>(u, across, newton_at_start);
    u_ = found.x;
    if (!found.ok()) { return false; }
    step_ = options_.first_step;
    has_previous_ = false;
    return solve_tangent(along);
}

bool ArclengthWalker::probe(double step, Vector& u, Vector& tangent) {
    const Vector predicted = u_ + step * tangent_;
    Matrix jacobian;
    const auto across = [&](const Vector& x, Linear& at) {
        return on_plane(x, predicted, tangent_, jacobian, at.residual, at.jacobian);
    };
    NewtonOptions options = newton_options();
    options.take_last_step = false;  // the tangent belongs to the point where the Jacobian was taken
    const auto found = newton<Linear>(predicted, across, options);
    u = found.x;
    if (!found.ok()) { return false; }
    Vector unit = Vector::Zero(u.size());
    unit[unit.size() - 1] = 1.0;
    tangent = found.factors.solve(unit).normalized();
    return tangent.allFinite();
}

void ArclengthWalker::predict() {
    // On a nearly straight curve the angle lets the step grow until peaks and boundaries are leapt over: the parameter
    // has a limit of its own.
    const double along = std::abs(tangent_[tangent_.size() - 1]);
    if (step_ * along > options_.largest_parameter_step) { step_ = options_.largest_parameter_step / along; }
    predicted_ = u_ + step_ * tangent_;
    if (has_previous_) { predicted_ += bend(); }
}

Vector ArclengthWalker::bend() const {
    // c(r) = u + r t + r^2 second + r^3 third with c(-s) and c'(-s) the previous point and tangent, s the chord. Two
    // conditions: second - s third = by_points, 2 second - 3 s third = by_tangents.
    const Vector chord = u_ - previous_u_;
    const double s = chord.norm();
    const Vector by_points = (s * tangent_ - chord) / (s * s);
    const Vector by_tangents = (tangent_ - previous_tangent_) / s;
    const Vector second = 3.0 * by_points - by_tangents;
    const Vector third = (2.0 * by_points - by_tangents) / s;
    Vector bent = step_ * step_ * (second + step_ * third);
    // At right angles to the tangent the plane of the corrector stays the one at distance step_, as without the bend.
    bent -= tangent_.dot(bent) * tangent_;
    // A curve that bends by more turns its tangent beyond the largest angle: the step would be rejected.
    const double furthest = options_.largest_angle * step_;
    return bent.norm() <= furthest ? bent : Vector::Zero(u_.size());
}

ArclengthWalker::Correction ArclengthWalker::correct() {
    // A corrector that moves far against the step has left for another branch.
    // Without this, a plain corrector beside the upper grazing point of an impact oscillator lands on the far side of
    // the S that the branch makes there.
    const double furthest = options_.largest_correction * step_;
    const auto across = [&](const Vector& x, Linear& at) {
        return (x - predicted_).norm() <= furthest &&
               on_plane(x, predicted_, tangent_, candidate_jacobian_, at.residual, at.jacobian);
    };
    const auto found = newton<Linear>(predicted_, across, newton_options());
    candidate_ = found.x;
    return found.ok() ? Correction::converged : Correction::rejected;
}

void ArclengthWalker::adapt(double angle) {
    // The angle is proportional to the step where the curvature is constant. Not more than doubled or halved at once:
    // one measured angle says little about the curvature a long way ahead.
    const double factor = angle > 0.0 ? std::clamp(options_.target_angle / angle, 0.5, 2.0) : 2.0;
    last_step_ = step_;
    step_ = std::min(step_ * factor, options_.largest_step);
}

bool ArclengthWalker::advance() {
    while (can_continue()) {
        predict();
        if (correct() == Correction::rejected) {
            step_ *= 0.5;
            continue;
        }
        // The tangent needs the Jacobian at the new point; from here the candidate holds the old one, to go back to.
        std::swap(jacobian_, candidate_jacobian_);
        const Vector old_tangent = tangent_;
        const bool sound = solve_tangent(old_tangent);
        // 10 rad is beyond any angle allowed: a tangent that cannot be solved for rejects the step.
        const double angle = sound ? std::acos(std::clamp(old_tangent.dot(tangent_), -1.0, 1.0)) : 10.0;
        if (!sound || angle > options_.largest_angle) {
            std::swap(jacobian_, candidate_jacobian_);
            tangent_ = old_tangent;
            step_ *= 0.5;
            continue;
        }
        previous_u_ = u_;
        previous_tangent_ = old_tangent;
        previous_jacobian_ = candidate_jacobian_;
        has_previous_ = true;
        u_ = candidate_;
        adapt(angle);
        return true;
    }
    return false;
}

bool ArclengthWalker::retreat() {
    if (!has_previous_) { return false; }
    u_ = previous_u_;
    tangent_ = previous_tangent_;
    jacobian_ = previous_jacobian_;
    // The full step would lead to the same point again. After one retreat there is nothing further back to return to.
    step_ = 0.5 * last_step_;
    has_previous_ = false;
    return can_continue();
}

}  // namespace percuss::numerics
