#include "boundary/critical.hpp"

#include "numerics/bordered.hpp"

#include <algorithm>
#include <cmath>
#include <complex>

namespace percuss::boundary {
namespace {

using numerics::Complex;
using numerics::ComplexMatrix;
using numerics::ComplexVector;
using numerics::Matrix;
using numerics::Vector;
using orbit::Motion;
using orbit::SequenceResidual;

/// Of a torus' angle: beneath it the pair of multipliers is no pair.
constexpr double least_sine = 1e-6;

/// The contact that enters slowest.
int slowest_contact(const Motion& motion) {
    int slowest = 0;
    for (std::size_t i = 1; i < motion.contacts(); ++i) {
        if (std::abs(motion.sequence.contacts[i].speed) <
            std::abs(motion.sequence.contacts[static_cast<std::size_t>(slowest)].speed)) {
            slowest = static_cast<int>(i);
        }
    }
    return slowest;
}

/// Second derivatives of F along a displacement of beginning and end: the columns for the unknowns and directions.
std::optional<Matrix> along(const flow::System& system, const Motion& motion, const Vector& beginning,
                            const Vector& end, std::span<const flow::ParameterVector> directions) {
    const Vector z = orbit::pack(system, motion);
    const auto columns = z.size() + static_cast<Eigen::Index>(directions.size());
    const double length = std::max(beginning.norm(), end.norm());
    // The imaginary part of a real mode.
    if (!(length > 0.0)) { return Matrix::Zero(z.size(), columns); }
    // Central differences of exact derivatives: error h^2, rounding 1e-14/h. It slows Newton's method, no more.
    // Both are of one size near h = 1e-14^(1/3) = 2e-5.
    const double h = 1e-5 / length;
    Matrix sum = Matrix::Zero(z.size(), columns);
    for (double sign : {1.0, -1.0}) {
        const Motion moved = orbit::unpack(system, z + sign * h * beginning, motion);
        const Motion closing = orbit::unpack(system, z + sign * h * end, motion);
        const auto r = orbit::shoot(system, moved, directions, &closing);
        if (!r) { return std::nullopt; }
        sum.leftCols(z.size()) += sign * r->by_unknowns;
        sum.rightCols(static_cast<Eigen::Index>(directions.size())) += sign * r->by_directions;
    }
    return sum / (2.0 * h);
}

}  // namespace

CriticalEquations::CriticalEquations(const flow::ParameterFamily& family, Kind kind, Motion like, int contact,
                                     std::optional<double> size)
    : family_(family),
      kind_(kind),
      like_(std::move(like)),
      contact_(contact),
      n_(like_.unknowns(family.base)) {
    const int angles = kind == Kind::torus ? 1 : 0;
    units_.setOnes(n_ + angles + family.dimension());
    if (size) { units_.head(n_) = orbit::unit_of_unknowns(family.base, like_, *size); }
    for (int i = 0; i < family.dimension(); ++i) {
        units_[n_ + angles + i] = family.units[static_cast<std::size_t>(i)];
    }
}

Vector CriticalEquations::pack(const Motion& motion, double angle, std::span<const double> p) const {
    Vector u(units_.size());
    u.head(n_) = orbit::pack(family_.base, motion);
    if (kind_ == Kind::torus) { u[n_] = angle; }
    for (std::size_t i = 0; i < p.size(); ++i) { u[u.size() - static_cast<Eigen::Index>(p.size() - i)] = p[i]; }
    return u.cwiseQuotient(units_);
}

Motion CriticalEquations::motion(const Vector& u) const {
    return orbit::unpack(family_.base, u.head(n_).cwiseProduct(units_.head(n_)), like_);
}

double CriticalEquations::angle(const Vector& u) const { return kind_ == Kind::torus ? u[n_] : 0.0; }

std::vector<double> CriticalEquations::parameters(const Vector& u) const {
    std::vector<double> p;
    for (Eigen::Index i = u.size() - family_.dimension(); i < u.size(); ++i) { p.push_back(u[i] * units_[i]); }
    return p;
}

std::optional<CriticalResidual> CriticalEquations::evaluate(const Vector& u, Directions extra) const {
    const std::vector<double> p = parameters(u);
    const flow::System system = family_.at(p);
    if (!(system.omega() > 0.0)) { return std::nullopt; }
    std::vector<flow::ParameterVector> directions = family_.directions(p);
    directions.insert(directions.end(), extra.begin(), extra.end());
    const Motion here = motion(u);
    auto r = kind_ != Kind::grazing             ? on_circle(system, here, angle(u), directions)
           : here.form == orbit::Form::sequence ? at_no_speed(system, here, directions)
                                                : touching(system, here, directions);
    if (!r) { return std::nullopt; }
    for (Eigen::Index c = 0; c < units_.size(); ++c) { r->jacobian.col(c) *= units_[c]; }
    if (!r->value.allFinite() || !r->jacobian.allFinite()) { return std::nullopt; }
    return r;
}

/// The shooting equations, with rows for the tests and columns for the angle left at zero.
CriticalResidual CriticalEquations::with_room(const SequenceResidual& r) const {
    const int angles = kind_ == Kind::torus ? 1 : 0;
    const int tests = angles + 1;
    const auto given = r.by_directions.cols();
    CriticalResidual out;
    out.value.setZero(n_ + tests);
    out.value.head(n_) = r.value;
    out.jacobian.setZero(n_ + tests, n_ + angles + given);
    out.jacobian.topLeftCorner(n_, n_) = r.by_unknowns;
    out.jacobian.topRightCorner(n_, given) = r.by_directions;
    return out;
}

/// Grazing of a contact of the sequence.
std::optional<CriticalResidual> CriticalEquations::at_no_speed(const flow::System& system, const Motion& motion,
                                                               Directions directions) const {
    const auto r = orbit::shoot(system, motion, directions);
    if (!r) { return std::nullopt; }
    CriticalResidual out = with_room(*r);
    out.value[n_] = motion.sequence.contacts[static_cast<std::size_t>(contact_)].speed;
    out.jacobian(n_, contact_ * motion.sequence.unknowns_per_contact(system)) = 1.0;
    return out;
}

/// Grazing of a motion of free form: the flow that shoots also tells its largest displacement.
std::optional<CriticalResidual> CriticalEquations::touching(const flow::System& system, const Motion& motion,
                                                            Directions directions) const {
    const orbit::ReturnMap map = orbit::map_of(motion);
    const orbit::Image image =
        orbit::apply(system, map, motion.state, orbit::Differentiate::all, directions, flow::observe_extrema);
    if (!image.ok()) { return std::nullopt; }
    const orbit::Observed test = clearance(system, map, image, directions);
    CriticalResidual out;
    out.theta_contact = phase_of_clearance(system, map, image);
    out.value.resize(n_ + 1);
    out.value.head(n_) = orbit::to_vector(system, image.state) - orbit::to_vector(system, motion.state);
    out.value[n_] = test.value;
    out.jacobian.resize(n_ + 1, image.derivative.cols());
    out.jacobian.topRows(n_) = image.derivative;
    out.jacobian.topLeftCorner(n_, n_) -= Matrix::Identity(n_, n_);
    for (Eigen::Index c = 0; c < out.jacobian.cols(); ++c) {
        out.jacobian(n_, c) = test.d[static_cast<std::size_t>(c)];
    }
    return out;
}

/// Fold, flip, torus: a multiplier on the unit circle.
std::optional<CriticalResidual> CriticalEquations::on_circle(const flow::System& system, const Motion& motion,
                                                             double angle, Directions directions) const {
    const auto r = orbit::shoot(system, motion, directions);
    if (!r) { return std::nullopt; }
    CriticalResidual out = with_room(*r);
    const bool torus = kind_ == Kind::torus;
    // The bordered system of the header: A(mu) v + b g = 0, c^H v = 1; g is zero where A is singular.
    const Complex mu = torus ? std::polar(1.0, angle) : Complex(kind_ == Kind::flip ? -1.0 : 1.0);
    const auto b =
        numerics::solve_bordered<Complex>(r->by_unknowns.cast<Complex>() + (mu - 1.0) * r->by_closing.cast<Complex>());
    // A period after a beginning moved by v the mode is moved by mu v. shoot() is real: a complex mode is taken in its
    // real and its imaginary part, in which the derivative is linear.
    const ComplexVector end = mu * b.v;
    const auto real = along(system, motion, b.v.real(), end.real(), directions);
    if (!real) { return std::nullopt; }
    ComplexMatrix second = real->cast<Complex>();
    if (torus) {
        const auto imaginary = along(system, motion, b.v.imag(), end.imag(), directions);
        if (!imaginary) { return std::nullopt; }
        second += Complex(0.0, 1.0) * imaginary->cast<Complex>();
    }
    const Eigen::RowVectorXcd slope = -b.w.adjoint() * second;
    const auto given = static_cast<Eigen::Index>(directions.size());
    Eigen::RowVectorXcd row(out.jacobian.cols());
    row.head(n_) = slope.head(n_);
    row.tail(given) = slope.tail(given);
    Complex g = b.g;
    // By the angle: A_phi = i mu F_closing.
    if (torus) { row[n_] = -(b.w.adjoint() * (Complex(0.0, 1.0) * mu * r->by_closing.cast<Complex>()) * b.v)(0); }
    if (kind_ == Kind::fold && motion.form == orbit::Form::sequence) {
        // At grazing the sequence is stationary in its speed, which makes A singular too: that root is divided out.
        const int slowest = slowest_contact(motion);
        const double speed = motion.sequence.contacts[static_cast<std::size_t>(slowest)].speed;
        if (speed == 0.0) { return std::nullopt; }
        // d(g/v) = (dg - (g/v) dv)/v.
        row[slowest * motion.sequence.unknowns_per_contact(system)] -= g / speed;
        row /= speed;
        g /= speed;
    }
    out.value[n_] = g.real();
    out.jacobian.row(n_) = row.real();
    if (torus) {
        out.value[n_ + 1] = g.imag();
        out.jacobian.row(n_ + 1) = row.imag();
    }
    return out;
}

namespace {

/// The equations as Newton's method asks for them: bounds on the parameter, and directions that join late.
class CriticalProblem {
public:
    struct Shot : numerics::Linearised<Vector, Matrix> {
        Matrix by_directions;  ///< no columns unless they have joined
        double theta_contact = 0.0;
    };

    CriticalProblem(const CriticalEquations& equations, std::span<const flow::ParameterVector> directions,
                    const CriticalOptions& options)
        : equations_(equations),
          directions_(directions),
          options_(options) {}

    bool operator()(const Vector& u, Shot& at) {
        const double p = equations_.parameters(u).front();
        left_bounds_ = !(p > options_.lowest && p < options_.highest);
        if (left_bounds_) { return false; }
        // Directions cost their columns in every flow: they are left out until the iteration is about to end.
        const bool joined = before_.size() > 0 && (u - before_).norm() < options_.directions_join_below * scale_before_;
        scale_before_ = numerics::scale_of(u, options_.newton);
        before_ = u;
        return evaluate(u, joined ? directions_ : std::span<const flow::ParameterVector>{}, at);
    }

    bool evaluate(const Vector& u, std::span<const flow::ParameterVector> directions, Shot& at) const {
        auto r = equations_.evaluate(u, directions);
        if (!r) { return false; }
        at.residual = std::move(r->value);
        at.jacobian = r->jacobian.leftCols(u.size());
        at.by_directions = r->jacobian.rightCols(r->jacobian.cols() - u.size());
        at.theta_contact = r->theta_contact;
        return true;
    }

    [[nodiscard]] bool left_bounds() const { return left_bounds_; }

private:
    const CriticalEquations& equations_;
    std::span<const flow::ParameterVector> directions_;
    const CriticalOptions& options_;
    Vector before_;
    double scale_before_ = 1.0;
    bool left_bounds_ = false;
};

/// -F_u^-1 F_direction, one direction after the other or all at once. They differ in the last digit: an edge's shall
/// not depend on how many directions ride along.
Matrix implicit_derivatives(const Eigen::PartialPivLU<Matrix>& factors, const Matrix& by_directions, bool one_by_one) {
    if (!one_by_one) { return factors.solve(-by_directions); }
    Matrix d(by_directions.rows(), by_directions.cols());
    for (Eigen::Index c = 0; c < d.cols(); ++c) { d.col(c) = factors.solve(Vector(-by_directions.col(c))); }
    return d;
}

/// An iterate that left the bounds is not evaluated, which is no failure of the flow.
SolveStatus to_status(numerics::NewtonStatus status, bool left_bounds) {
    if (status == numerics::NewtonStatus::converged) { return SolveStatus::converged; }
    const bool flow_failed = status == numerics::NewtonStatus::evaluation_failed && !left_bounds;
    return flow_failed ? SolveStatus::flow_failed : SolveStatus::no_convergence;
}

}  // namespace

CriticalPoint solve_critical(const flow::ParameterFamily& family, Kind kind, const Motion& guess, double parameter,
                             int contact, double angle, double size, std::span<const flow::ParameterVector> directions,
                             const CriticalOptions& options) {
    CriticalPoint point;
    point.kind = kind;
    const CriticalEquations equations(family, kind, guess, contact,
                                      options.scaled ? std::optional<double>(size) : std::nullopt);
    CriticalProblem problem(equations, directions, options);
    auto found =
        numerics::newton<CriticalProblem::Shot>(equations.pack(guess, angle, {&parameter, 1}), problem, options.newton);
    point.status = to_status(found.status, problem.left_bounds());
    point.residual = found.residual;
    point.iterations = found.iterations;
    // Folds and flips solve the equations of a torus as well.
    if (point.ok() && kind == Kind::torus && !(std::abs(std::sin(equations.angle(found.x))) > least_sine)) {
        point.status = SolveStatus::no_convergence;
    }
    if (found.status == numerics::NewtonStatus::evaluation_failed) { return point; }
    point.motion = equations.motion(found.x);
    point.parameter = equations.parameters(found.x).front();
    point.angle = equations.angle(found.x);
    point.theta_contact = found.at.theta_contact;
    if (!point.ok() || directions.empty()) { return point; }
    const bool joined = found.at.by_directions.cols() > 0;
    if (!joined) {
        if (!problem.evaluate(found.x, directions, found.at)) {
            point.status = SolveStatus::flow_failed;
            return point;
        }
        found.factors.compute(found.at.jacobian);
    }
    const Matrix d =
        equations.units().asDiagonal() * implicit_derivatives(found.factors, found.at.by_directions, joined);
    point.d_unknowns = d.topRows(equations.unknowns_of_motion());
    for (Eigen::Index c = 0; c < d.cols(); ++c) { point.d_parameter.push_back(d(d.rows() - 1, c)); }
    return point;
}

}  // namespace percuss::boundary
