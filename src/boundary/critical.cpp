#include "boundary/critical.hpp"

#include <algorithm>
#include <cmath>
#include <complex>

namespace percuss::boundary {
namespace {

using numerics::Matrix;
using numerics::Vector;
using orbit::Motion;
using orbit::SequenceResidual;
using Complex = std::complex<double>;
using ComplexMatrix = Eigen::MatrixXcd;
using ComplexVector = Eigen::VectorXcd;

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

/// Null vectors of a nearly singular matrix from its bordered system, and the test g.
struct Bordered {
    Complex g;
    ComplexVector v;
    ComplexVector w;
};

Bordered solve_bordered(const ComplexMatrix& a) {
    const auto n = a.rows();
    const Eigen::JacobiSVD<ComplexMatrix> svd(a, Eigen::ComputeFullU | Eigen::ComputeFullV);
    ComplexMatrix border = ComplexMatrix::Zero(n + 1, n + 1);
    border.topLeftCorner(n, n) = a;
    border.topRightCorner(n, 1) = svd.matrixU().col(n - 1);
    border.bottomLeftCorner(1, n) = svd.matrixV().col(n - 1).adjoint();
    ComplexVector unit = ComplexVector::Zero(n + 1);
    unit[n] = 1.0;
    const ComplexVector right = border.partialPivLu().solve(unit);
    const ComplexVector left = border.adjoint().partialPivLu().solve(unit);
    return {right[n], right.head(n), left.head(n)};
}

/// Second derivatives of F along a displacement of beginning and end: the columns for the unknowns and directions.
std::optional<Matrix> along(const flow::System& system, const Motion& motion, const Vector& beginning,
                            const Vector& end, std::span<const flow::ParameterVector> directions) {
    const Vector z = orbit::pack(system, motion);
    const auto columns = z.size() + static_cast<Eigen::Index>(directions.size());
    const double length = std::max(beginning.norm(), end.norm());
    if (!(length > 0.0)) { return Matrix::Zero(z.size(), columns); }
    // Central differences of exact derivatives: error h^2, rounding 1e-14/h. It slows Newton's method, no more.
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
                                     double size)
    : family_(family),
      kind_(kind),
      like_(std::move(like)),
      contact_(contact),
      n_(like_.unknowns(family.base)) {
    const int angles = kind == Kind::torus ? 1 : 0;
    units_.setOnes(n_ + angles + family.dimension());
    units_.head(n_) = orbit::unit_of_unknowns(family.base, like_, size);
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

bool CriticalEquations::evaluate(const Vector& u, std::span<const flow::ParameterVector> extra, Vector& f,
                                 Matrix& jacobian) const {
    const std::vector<double> p = parameters(u);
    const flow::System system = family_.at(p);
    if (!(system.omega() > 0.0)) { return false; }
    std::vector<flow::ParameterVector> directions = family_.directions(p);
    directions.insert(directions.end(), extra.begin(), extra.end());
    const Motion here = motion(u);
    const auto r = orbit::shoot(system, here, directions);
    if (!r) { return false; }
    const int tests = kind_ == Kind::torus ? 2 : 1;
    const int angles = tests - 1;
    const auto given = static_cast<Eigen::Index>(directions.size());
    f.setZero(n_ + tests);
    f.head(n_) = r->value;
    jacobian.setZero(n_ + tests, n_ + angles + given);
    jacobian.topLeftCorner(n_, n_) = r->by_unknowns;
    jacobian.topRightCorner(n_, given) = r->by_directions;
    if (kind_ == Kind::grazing) {
        const int at = contact_ * here.sequence.unknowns_per_contact(system);
        f[n_] = here.sequence.contacts[static_cast<std::size_t>(contact_)].speed;
        jacobian(n_, at) = 1.0;
    } else if (!add_multiplier_test(u, system, here, directions, *r, f, jacobian)) {
        return false;
    }
    for (Eigen::Index c = 0; c < units_.size(); ++c) { jacobian.col(c) *= units_[c]; }
    return f.allFinite() && jacobian.allFinite();
}

bool CriticalEquations::add_multiplier_test(const Vector& u, const flow::System& system, const Motion& motion,
                                            std::span<const flow::ParameterVector> directions,
                                            const SequenceResidual& r, Vector& f, Matrix& jacobian) const {
    const bool torus = kind_ == Kind::torus;
    const Complex mu = torus ? std::polar(1.0, angle(u)) : Complex(kind_ == Kind::flip ? -1.0 : 1.0);
    const Bordered b = solve_bordered(r.by_unknowns.cast<Complex>() + (mu - 1.0) * r.by_closing.cast<Complex>());
    const ComplexVector end = mu * b.v;
    const auto real = along(system, motion, b.v.real(), end.real(), directions);
    if (!real) { return false; }
    ComplexMatrix second = real->cast<Complex>();
    if (torus) {
        const auto imaginary = along(system, motion, b.v.imag(), end.imag(), directions);
        if (!imaginary) { return false; }
        second += Complex(0.0, 1.0) * imaginary->cast<Complex>();
    }
    const Eigen::RowVectorXcd slope = -b.w.adjoint() * second;
    const auto given = static_cast<Eigen::Index>(directions.size());
    Eigen::RowVectorXcd row(jacobian.cols());
    row.head(n_) = slope.head(n_);
    row.tail(given) = slope.tail(given);
    Complex g = b.g;
    if (torus) { row[n_] = -(b.w.adjoint() * (Complex(0.0, 1.0) * mu * r.by_closing.cast<Complex>()) * b.v)(0); }
    if (kind_ == Kind::fold && motion.form == orbit::Form::sequence) {
        // At grazing the sequence is stationary in its speed, which makes A singular too: that root is divided out.
        const int slowest = slowest_contact(motion);
        const double speed = motion.sequence.contacts[static_cast<std::size_t>(slowest)].speed;
        if (speed == 0.0) { return false; }
        row[slowest * motion.sequence.unknowns_per_contact(system)] -= g / speed;
        row /= speed;
        g /= speed;
    }
    f[n_] = g.real();
    jacobian.row(n_) = row.real();
    if (torus) {
        f[n_ + 1] = g.imag();
        jacobian.row(n_ + 1) = row.imag();
    }
    return true;
}

CriticalPoint solve_critical(const flow::ParameterFamily& family, Kind kind, const Motion& guess, double parameter,
                             int contact, double angle, double size,
                             std::span<const flow::ParameterVector> directions) {
    CriticalPoint point;
    point.kind = kind;
    point.status = SolveStatus::no_convergence;
    const CriticalEquations equations(family, kind, guess, contact, size);
    Vector u = equations.pack(guess, angle, {&parameter, 1});
    const auto unknowns = u.size();
    Vector f;
    Matrix jacobian;
    for (int iteration = 0; iteration < 25; ++iteration) {
        if (!equations.evaluate(u, {}, f, jacobian)) {
            point.status = SolveStatus::flow_failed;
            return point;
        }
        Vector step = jacobian.partialPivLu().solve(-f);
        if (!step.allFinite()) { return point; }
        const double length = step.norm();
        if (length > 0.2) { step *= 0.2 / length; }
        u += step;
        point.residual = f.norm();
        if (length <= 1e-10 * (1.0 + u.norm())) {
            // Folds and flips solve the equations of a torus as well.
            const bool of_kind = kind != Kind::torus || std::abs(std::sin(equations.angle(u))) > least_sine;
            if (!of_kind) { return point; }
            point.status = SolveStatus::converged;
            break;
        }
    }
    point.motion = equations.motion(u);
    point.parameter = equations.parameters(u).front();
    point.angle = equations.angle(u);
    if (!point.ok() || directions.empty()) { return point; }
    if (!equations.evaluate(u, directions, f, jacobian)) {
        point.status = SolveStatus::flow_failed;
        return point;
    }
    const Matrix d = jacobian.leftCols(unknowns).partialPivLu().solve(-jacobian.rightCols(jacobian.cols() - unknowns));
    for (Eigen::Index c = 0; c < d.cols(); ++c) {
        point.d_parameter.push_back(d(unknowns - 1, c) * family.units.front());
    }
    return point;
}

}  // namespace percuss::boundary
