#pragma once
/// \file
/// Boundaries of any periodic motion, striking or clear, in whatever parameter: {F(z, p) = 0, test = 0} in the smooth
/// unknowns of orbit/motion.hpp. The equations can be solved with one free parameter or followed with two.
///
///   fold, flip, torus: a Floquet multiplier mu = +1, -1, exp(i phi).
///       A(mu) = F_z + (mu - 1) F_closing is singular; the test is g of the bordered system
///           [ A    b ] [v]   [0]
///           [ c^H  0 ] [g] = [1],     g_* = -w^H A_* v, w from the adjoint system
///       (W. Govaerts, Numerical Methods for Bifurcations of Dynamical Equilibria, SIAM 2000; complex for a torus, with
///       phi as one more unknown). A_* v is taken along the Floquet mode, beginning moved by v and end by mu v, as a
///       central difference of exact Jacobians.
///   grazing: the entry speed of one contact is zero.

#include "boundary/boundary.hpp"
#include "flow/parameter_family.hpp"
#include "orbit/motion.hpp"

#include <span>
#include <vector>

namespace percuss::boundary {

class CriticalEquations {
public:
    /// like: form of the motion. contact: grazing only, which contact of the sequence touches. size: of the motion, for
    /// the scaling of the unknowns.
    CriticalEquations(const flow::ParameterFamily& family, Kind kind, orbit::Motion like, int contact, double size);

    /// Unknowns u = (z, [phi], p), each in its unit.
    [[nodiscard]] numerics::Vector pack(const orbit::Motion& motion, double angle, std::span<const double> p) const;
    [[nodiscard]] orbit::Motion motion(const numerics::Vector& u) const;
    [[nodiscard]] double angle(const numerics::Vector& u) const;
    [[nodiscard]] std::vector<double> parameters(const numerics::Vector& u) const;

    /// Residual (one less than unknowns with two parameters, as many with one) and Jacobian; `extra` directions add
    /// columns on the right. False when the flow failed.
    bool evaluate(const numerics::Vector& u, std::span<const flow::ParameterVector> extra, numerics::Vector& f,
                  numerics::Matrix& jacobian) const;

private:
    bool add_multiplier_test(const numerics::Vector& u, const flow::System& system, const orbit::Motion& motion,
                             std::span<const flow::ParameterVector> directions, const orbit::SequenceResidual& r,
                             numerics::Vector& f, numerics::Matrix& jacobian) const;

    const flow::ParameterFamily& family_;
    Kind kind_;
    orbit::Motion like_;
    int contact_;
    numerics::Vector units_;
    int n_;  ///< unknowns of the motion
};

struct CriticalPoint {
    SolveStatus status = SolveStatus::not_run;
    Kind kind = Kind::none;
    orbit::Motion motion;
    double parameter = 0.0;
    double angle = 0.0;  ///< torus: argument of the multiplier
    double residual = 0.0;
    std::vector<double> d_parameter;  ///< along each direction asked for
    [[nodiscard]] bool ok() const { return status == SolveStatus::converged; }
};

/// Newton on the equations with one parameter free. angle: torus only, a guess for the multiplier's argument.
CriticalPoint solve_critical(const flow::ParameterFamily& family, Kind kind, const orbit::Motion& guess,
                             double parameter, int contact, double angle, double size,
                             std::span<const flow::ParameterVector> directions = {});

}  // namespace percuss::boundary
