#pragma once
/// \file
/// Pseudo-arclength continuation of a smooth curve F(u) = 0, F: R^(n+1) -> R^n, for small n
/// (H. B. Keller, "Numerical solution of bifurcation and nonlinear eigenvalue problems", 1977).

#include "numerics/linear.hpp"
#include "numerics/newton.hpp"

#include <functional>

namespace percuss::numerics {

/// F and its n x (n+1) Jacobian at u; false when it cannot be evaluated there.
using CurveFunction = std::function<bool(const Vector& u, Vector& f, Matrix& jacobian)>;

struct ArclengthOptions {
    double first_step = 0.05;
    double smallest_step = 1e-10;
    double largest_step = 0.3;
    double largest_parameter_step = 1e300;  ///< of the last entry of u alone
    double target_angle = 0.12;             ///< between consecutive tangents, rad (about 7 degrees)
    double largest_angle = 0.35;            ///< beyond this the step is repeated with half the length
    double largest_correction = 0.3;  ///< the corrector may move this share of the step: more means another branch
    double tolerance = 1e-10;         ///< on |F|, relative to 1 + |u|
    double step_tolerance =
        1e-6;  ///< on the corrector's last step, after which F is not evaluated again, relative likewise
    int newton_iterations = 8;
};

/// Walks along the curve: `while (walker.can_continue()) { walker.predict(); walker.correct(); walker.adapt(); }`, or
/// `advance()` for one accepted step.
class ArclengthWalker {
public:
    ArclengthWalker(CurveFunction function, ArclengthOptions options);

    /// Starts from a point near the curve; the parameter is the last entry of u. `direction` is the sign of its first
    /// change. False when Newton does not converge.
    bool start(const Vector& u, double direction);
    /// The same with any direction to set out in: the point is sought at right angles to it from u, and the curve then
    /// followed to the side it points to. With a unit vector that entry of u is held.
    bool start_along(const Vector& u, const Vector& direction);

    /// A point of the curve at this arclength (predicted; of either sign) from the current one, and the tangent there.
    /// The walker itself stays. False when the corrector does not converge.
    [[nodiscard]] bool probe(double step, Vector& u, Vector& tangent);

    /// One accepted step; false when the step length has collapsed.
    bool advance();

    /// Goes back to the previous point and will try again with half the step. False when there is nothing to go back
    /// to or the step has become too small.
    bool retreat();

    [[nodiscard]] const Vector& point() const { return u_; }
    [[nodiscard]] const Vector& tangent() const { return tangent_; }
    [[nodiscard]] const Matrix& jacobian() const { return jacobian_; }
    [[nodiscard]] double step() const { return step_; }
    void set_step(double step) { step_ = step; }
    void limit_step(double largest) { step_ = std::min(step_, largest); }

private:
    enum class Correction : std::uint8_t { converged, rejected };
    [[nodiscard]] bool can_continue() const { return step_ >= options_.smallest_step; }
    void predict();
    /// What the cubic through the last two points with their tangents departs from the tangent at the end of the step,
    /// at right angles to it; nothing where that is too much to trust.
    [[nodiscard]] Vector bend() const;
    Correction correct();
    void adapt(double angle);
    bool solve_tangent(const Vector& orientation);
    /// F and the plane through a point across `normal`: residual and square Jacobian; F's own Jacobian in `jacobian`.
    bool on_plane(const Vector& u, const Vector& through, const Vector& normal, Matrix& jacobian, Vector& residual,
                  Matrix& bordered);
    [[nodiscard]] NewtonOptions newton_options() const;

    CurveFunction function_;
    ArclengthOptions options_;
    Vector u_, tangent_, predicted_, candidate_;
    Vector f_;
    Matrix jacobian_, candidate_jacobian_;
    Vector previous_u_, previous_tangent_;
    Matrix previous_jacobian_;
    double step_ = 0.0;
    double last_step_ = 0.0;
    bool has_previous_ = false;
};

}  // namespace percuss::numerics
