#include "numerics/arclength.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

namespace percuss::numerics {
namespace {

/// The square matrix with the Jacobian above and one more row below.
Matrix bordered(const Matrix& jacobian, const Vector& row) {
    Matrix m(row.size(), row.size());
    m.topRows(jacobian.rows()) = jacobian;
    m.bottomRows(1) = row.transpose();
    return m;
}

}  // namespace

ArclengthWalker::ArclengthWalker(CurveFunction function, ArclengthOptions options)
    : function_(std::move(function)),
      options_(options) {}

bool ArclengthWalker::solve_tangent(const Vector& orientation) {
    Vector right = Vector::Zero(orientation.size());
    right[right.size() - 1] = 1.0;
    const Vector t = bordered(jacobian_, orientation).partialPivLu().solve(right);
    if (!t.allFinite()) { return false; }
    tangent_ = t.normalized();
    return true;
}

bool ArclengthWalker::start(const Vector& u, double direction) {
    Vector along = Vector::Zero(u.size());
    along[u.size() - 1] = direction;
    return start_along(u, along);
}

bool ArclengthWalker::start_along(const Vector& u, const Vector& direction) {
    const Vector along = direction.normalized();
    u_ = u;
    for (int iteration = 0; iteration < 3 * options_.newton_iterations; ++iteration) {
        if (!function_(u_, f_, jacobian_)) { return false; }
        Vector right = Vector::Zero(u.size());
        right.head(f_.size()) = -f_;
        const Vector du = bordered(jacobian_, along).partialPivLu().solve(right);
        if (!du.allFinite()) { return false; }
        const double scale = 1.0 + u_.norm();
        if (f_.norm() <= options_.tolerance * scale && du.norm() <= 1e-9 * scale) {
            step_ = options_.first_step;
            has_previous_ = false;
            return solve_tangent(along);
        }
        u_ += du;
    }
    return false;
}

bool ArclengthWalker::probe(double step, Vector& u, Vector& tangent) {
    u = u_ + step * tangent_;
    const Vector predicted = u;
    Matrix jacobian;
    for (int iteration = 0; iteration < options_.newton_iterations; ++iteration) {
        if (!function_(u, f_, jacobian)) { return false; }
        Vector right(u.size());
        right.head(f_.size()) = -f_;
        right[right.size() - 1] = -tangent_.dot(u - predicted);
        const auto lu = bordered(jacobian, tangent_).partialPivLu();
        const Vector du = lu.solve(right);
        if (!du.allFinite()) { return false; }
        const double scale = 1.0 + u.norm();
        if (f_.norm() <= options_.tolerance * scale && du.norm() <= options_.step_tolerance * scale) {
            Vector unit = Vector::Zero(u.size());
            unit[unit.size() - 1] = 1.0;
            tangent = lu.solve(unit).normalized();
            return tangent.allFinite();
        }
        u += du;
    }
    return false;
}

void ArclengthWalker::predict() {
    const double along = std::abs(tangent_[tangent_.size() - 1]);
    if (step_ * along > options_.largest_parameter_step) { step_ = options_.largest_parameter_step / along; }
    predicted_ = u_ + step_ * tangent_;
    if (has_previous_) { predicted_ += bend(); }
}

Vector ArclengthWalker::bend() const {
    const Vector chord = u_ - previous_u_;
    const double s = chord.norm();
    const Vector by_points = (s * tangent_ - chord) / (s * s);
    const Vector by_tangents = (tangent_ - previous_tangent_) / s;
    const Vector second = 3.0 * by_points - by_tangents;
    const Vector third = (2.0 * by_points - by_tangents) / s;
    Vector bent = step_ * step_ * (second + step_ * third);
    bent -= tangent_.dot(bent) * tangent_;
    const double furthest = options_.largest_angle * step_;
    return bent.norm() <= furthest ? bent : Vector::Zero(u_.size());
}

ArclengthWalker::Correction ArclengthWalker::correct() {
    candidate_ = predicted_;
    for (int iteration = 0; iteration < options_.newton_iterations; ++iteration) {
        if (!function_(candidate_, f_, candidate_jacobian_)) { return Correction::rejected; }
        Vector right(candidate_.size());
        right.head(f_.size()) = -f_;
        right[right.size() - 1] = -tangent_.dot(candidate_ - predicted_);
        const Vector du = bordered(candidate_jacobian_, tangent_).partialPivLu().solve(right);
        if (!du.allFinite()) { return Correction::rejected; }
        const double scale = 1.0 + candidate_.norm();
        if ((candidate_ - predicted_).norm() > options_.largest_correction * step_) { return Correction::rejected; }
        if (f_.norm() <= options_.tolerance * scale && du.norm() <= options_.step_tolerance * scale) {
            candidate_ += du;  // too small to be worth looking at again
            return Correction::converged;
        }
        candidate_ += du;
    }
    return Correction::rejected;
}

void ArclengthWalker::adapt(double angle) {
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
        std::swap(jacobian_, candidate_jacobian_);
        const Vector old_tangent = tangent_;
        const bool sound = solve_tangent(old_tangent);
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
    step_ = 0.5 * last_step_;
    has_previous_ = false;
    return can_continue();
}

}  // namespace percuss::numerics
