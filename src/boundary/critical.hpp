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
///   grazing: the entry speed of one contact is zero; of a motion of free form, max x = stop (by the envelope theorem
///       the derivative of a maximum needs no derivative of its time), which is smooth from that side.

#include "boundary/boundary.hpp"
#include "flow/parameter_family.hpp"
#include "numerics/newton.hpp"
#include "orbit/motion.hpp"

#include <span>
#include <vector>

namespace percuss::boundary {

/// The equations at one point.
struct CriticalResidual {
    numerics::Vector value;      ///< one less than unknowns with two parameters, as many with one
    numerics::Matrix jacobian;   ///< by the unknowns, then by the extra directions
    double theta_contact = 0.0;  ///< grazing of a motion of free form: phase of the largest displacement
};

class CriticalEquations {
public:
    /// like: form of the motion. contact: grazing only, which contact of the sequence touches. size: of the motion, for
    /// the scaling of the unknowns; none: every unknown as it is.
    CriticalEquations(const flow::ParameterFamily& family, Kind kind, orbit::Motion like, int contact,
                      std::optional<double> size);

    /// Unknowns u = (z, [phi], p), each in its unit.
    [[nodiscard]] numerics::Vector pack(const orbit::Motion& motion, double angle, std::span<const double> p) const;
    [[nodiscard]] orbit::Motion motion(const numerics::Vector& u) const;
    [[nodiscard]] double angle(const numerics::Vector& u) const;
    [[nodiscard]] std::vector<double> parameters(const numerics::Vector& u) const;

    /// Empty when the flow failed.
    [[nodiscard]] std::optional<CriticalResidual> evaluate(const numerics::Vector& u,
                                                           std::span<const flow::ParameterVector> extra) const;

    /// Of the motion, the angle and the parameters.
    [[nodiscard]] const numerics::Vector& units() const { return units_; }
    [[nodiscard]] int unknowns_of_motion() const { return n_; }

private:
    using Directions = std::span<const flow::ParameterVector>;
    std::optional<CriticalResidual> touching(const flow::System& system, const orbit::Motion& motion,
                                             Directions directions) const;
    std::optional<CriticalResidual> on_circle(const flow::System& system, const orbit::Motion& motion, double angle,
                                              Directions directions) const;
    std::optional<CriticalResidual> at_no_speed(const flow::System& system, const orbit::Motion& motion,
                                                Directions directions) const;
    [[nodiscard]] CriticalResidual with_room(const orbit::SequenceResidual& r) const;

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
    double angle = 0.0;          ///< torus: argument of the multiplier
    double theta_contact = 0.0;  ///< grazing of a motion of free form: phase of the largest displacement
    double residual = 0.0;
    int iterations = 0;
    std::vector<double> d_parameter;  ///< along each direction asked for
    numerics::Matrix d_unknowns;      ///< of the motion, following the boundary: a column per direction
    [[nodiscard]] bool ok() const { return status == SolveStatus::converged; }
};

struct CriticalOptions {
    bool scaled = true;  ///< unknowns in orbit::unit_of_unknowns
    /// In scaled unknowns 0.2 is a fifth of the motion, whatever their number. The residual is not looked at: it mixes
    /// displacements with test functions that can be of any size (a fold's is divided by the entry speed), and a step
    /// of 1e-10 in scaled unknowns settles it.
    numerics::NewtonOptions newton{.max_iterations = 25,
                                   .max_halvings = 0,
                                   .residual_tolerance = numerics::unlimited,
                                   .step_tolerance = 1e-10,
                                   .max_step = 0.2,
                                   .residual_is_relative = false,
                                   .max_step_is_relative = false};
    /// Directions join the evaluations when a step has become this short, relative, and the derivatives are those of
    /// the last iterate. 0: they are taken at the solution, by an evaluation of its own.
    double directions_join_below = 0.0;
    double lowest = -numerics::unlimited;  ///< of the parameter: an iterate beyond is no convergence
    double highest = numerics::unlimited;
};

/// Newton on the equations with one parameter free. angle: torus only, a guess for the multiplier's argument. size: of
/// the motion, not looked at unless scaled.
CriticalPoint solve_critical(const flow::ParameterFamily& family, Kind kind, const orbit::Motion& guess,
                             double parameter, int contact, double angle, double size,
                             std::span<const flow::ParameterVector> directions = {},
                             const CriticalOptions& options = {});

}  // namespace percuss::boundary
