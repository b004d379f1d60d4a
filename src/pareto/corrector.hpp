#pragma once
/// \file
/// From a point near the front to the point of the front that lies in a given direction.

#include "pareto/front.hpp"
#include "pareto/quadratic_models.hpp"

#include <optional>

namespace percuss::pareto {

/// The scalarised problem of Pascoletti and Serafini (J. Optim. Theory Appl. 42, 1984):
///
///     minimise t   subject to   y_k(u) <= anchor_k + t direction_k,   c(u) <= 0,   0 <= u <= 1
///
/// direction >= 0, not 0. Its multipliers of the first rows, w with w . direction = 1, are the weights of the front's
/// certificate. direction_k = 0 makes objective k a limit: the epsilon-constraint problem is direction = e_j.
struct Target {
    Vector anchor;
    Vector direction;
};

struct CorrectorOptions {
    double tolerance = 1e-7;              ///< on the certificate's residual and complementarity
    double feasibility_tolerance = 1e-9;  ///< on the constraints
    int evaluations = 8;                  ///< at most, for one target
    double radius = 0.2;                  ///< largest step, infinity norm in u
};

struct Correction {
    bool converged = false;
    Vector u;
    VectorEvaluation here;  ///< scaled
    FrontCertificate certificate;
    int evaluations = 0;
};

/// Predictor and corrector in one: solves the target on the quadratic models (sequential quadratic programming without
/// any evaluation, in which limits and bounds begin and cease to bind), evaluates there, updates the models, and so on,
/// until the certificate holds. The models' base must be the point to start from; afterwards it is the last point that
/// could be evaluated. Local: it may fail where the target is far away; nothing is lost then but evaluations.
/// `from`: certificate at the base, for the first estimate of the multipliers. `guess`: where the target is expected to
/// be, evaluated first; empty if there is nothing better than the models.
[[nodiscard]] Correction correct(UnitProblem& problem, QuadraticModels& models, const Target& target,
                                 const FrontCertificate& from, const CorrectorOptions& options,
                                 const Vector& guess = {});

}  // namespace percuss::pareto
