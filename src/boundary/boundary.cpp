#include "boundary/boundary.hpp"

#include <algorithm>
#include <cmath>
#include <complex>

namespace percuss::boundary {
namespace {

using numerics::SmallMatrix;
using numerics::SmallVector;
using orbit::Image;
using orbit::Observed;
using Complex = std::complex<double>;
using ComplexVector = numerics::SmallComplexVector;

/// The test function of a boundary and its gradient, in the columns of Observed: state, omega, then directions.
struct Test {
    bool ok = false;
    Observed value;
};

struct Problem {
    const flow::System& system;
    const orbit::ReturnMap& map;
    Kind kind;
    std::vector<flow::ParameterVector> directions;  ///< omega first

    [[nodiscard]] int states() const { return system.states(); }
    [[nodiscard]] int columns() const { return states() + static_cast<int>(directions.size()); }
    [[nodiscard]] Image image(const SmallVector& y, double omega) const {
        return orbit::apply(system.at_omega(omega), map, orbit::to_state(y), orbit::Differentiate::all, directions,
                            kind == Kind::grazing ? flow::observe_extrema : flow::observe_nothing);
    }
};

/// Derivative matrices P_z(y + h v) - P_z(y - h v) over 2 h: the second derivative along v, all columns at once.
bool along(const Problem& problem, const SmallVector& y, double omega, const SmallVector& v,
           Eigen::MatrixXd& derivative) {
    const double length = v.norm();
    if (!(length > 0.0)) {
        derivative.setZero(problem.states(), problem.columns());
        return true;
    }
    // Central differences of exact derivatives: error h^2, rounding 1e-14/h; balanced near 1e-4.
    const double h = 1e-4 / length;
    const Image forward = problem.image(y + h * v, omega);
    const Image backward = problem.image(y - h * v, omega);
    if (!forward.ok() || !backward.ok()) { return false; }
    derivative = (forward.derivative - backward.derivative) / (2.0 * h);
    return true;
}

/// Fold (sign +1) or flip (sign -1): [P_y -+ I, b; c^T, 0] [v; g] = [0; 1], and the same transposed for w;
/// g_z = -w^T (d P_y / dz) v. The borders b, c are the current singular vectors, so the system is well conditioned.
Test bordered_test(const Problem& problem, const SmallVector& y, double omega, const Image& image, double sign) {
    Test test;
    const int n = problem.states();
    const SmallMatrix a = SmallMatrix(image.derivative.leftCols(n)) - sign * SmallMatrix::Identity(n, n);
    const Eigen::JacobiSVD<Eigen::MatrixXd> svd(a, Eigen::ComputeFullU | Eigen::ComputeFullV);
    SmallMatrix border(n + 1, n + 1);
    border.setZero();
    border.topLeftCorner(n, n) = a;
    border.topRightCorner(n, 1) = svd.matrixU().col(n - 1);
    border.bottomLeftCorner(1, n) = svd.matrixV().col(n - 1).transpose();
    SmallVector unit = SmallVector::Zero(n + 1);
    unit[n] = 1.0;
    const SmallVector right = border.partialPivLu().solve(unit);
    const SmallVector left = border.transpose().partialPivLu().solve(unit);
    const SmallVector v = right.head(n);
    const SmallVector w = left.head(n);
    Eigen::MatrixXd second;
    if (!right.allFinite() || !along(problem, y, omega, v, second)) { return test; }
    test.value.value = right[n];
    for (int c = 0; c < problem.columns(); ++c) { test.value.d[static_cast<std::size_t>(c)] = -w.dot(second.col(c)); }
    test.ok = true;
    return test;
}

/// Torus: |mu|^2 - 1 for the complex multiplier nearest the unit circle; d mu = w^H (dP_y) v / (w^H v).
Test torus_test(const Problem& problem, const SmallVector& y, double omega, const Image& image) {
    Test test;
    const int n = problem.states();
    const Eigen::MatrixXd m = image.derivative.leftCols(n);
    const Eigen::EigenSolver<Eigen::MatrixXd> right(m);
    int best = -1;
    for (int k = 0; k < n; ++k) {
        const Complex mu = right.eigenvalues()[k];
        if (mu.imag() <= 1e-12) { continue; }
        if (best < 0 || std::abs(std::abs(mu) - 1.0) < std::abs(std::abs(right.eigenvalues()[best]) - 1.0)) {
            best = k;
        }
    }
    if (best < 0) { return test; }
    const Complex mu = right.eigenvalues()[best];
    const Eigen::VectorXcd v = right.eigenvectors().col(best);
    const Eigen::VectorXcd w = right.eigenvectors().inverse().row(best).transpose();  // w^T v = 1
    Eigen::MatrixXd real;
    Eigen::MatrixXd imaginary;
    if (!along(problem, y, omega, v.real(), real) || !along(problem, y, omega, v.imag(), imaginary)) { return test; }
    test.value.value = std::norm(mu) - 1.0;
    for (int c = 0; c < problem.columns(); ++c) {
        const Complex dmu = (w.transpose() * (real.col(c) + Complex(0.0, 1.0) * imaginary.col(c)))(0);
        test.value.d[static_cast<std::size_t>(c)] = 2.0 * (std::conj(mu) * dmu).real();
    }
    test.ok = true;
    return test;
}

Test evaluate(const Problem& problem, const SmallVector& y, double omega, const Image& image) {
    switch (problem.kind) {
        case Kind::grazing: {
            Test test;
            test.ok = true;
            test.value = clearance(problem.system.at_omega(omega), problem.map, image, problem.directions);
            return test;
        }
        case Kind::fold: return bordered_test(problem, y, omega, image, 1.0);
        case Kind::flip: return bordered_test(problem, y, omega, image, -1.0);
        case Kind::torus: return torus_test(problem, y, omega, image);
        case Kind::none: break;
    }
    return {};
}

}  // namespace

std::string_view to_string(Kind kind) {
    switch (kind) {
        case Kind::none: return "none";
        case Kind::grazing: return "grazing";
        case Kind::fold: return "fold";
        case Kind::flip: return "flip";
        case Kind::torus: return "torus";
    }
    return "none";
}

orbit::Observed clearance(const flow::System& system, const orbit::ReturnMap& map, const orbit::Image& image,
                          std::span<const flow::ParameterVector> directions) {
    const double centre = system.integrator->centre(system.parameters);
    const double above = image.observed[orbit::x_max].value - centre;
    const double below = centre - image.observed[orbit::x_min].value;
    const bool use_maximum = !map.mirrored || above >= below;  // of half a cycle, one side belongs to the other half
    const double sign = use_maximum ? 1.0 : -1.0;
    const Observed& extreme = image.observed[use_maximum ? orbit::x_max : orbit::x_min];
    Observed result;
    result.value = sign * (extreme.value - centre) - (system.stop_position() - centre);
    for (std::size_t c = 0; c < extreme.d.size(); ++c) { result.d[c] = sign * extreme.d[c]; }
    for (std::size_t i = 0; i < directions.size(); ++i) {
        const double dc = system.integrator->centre_derivative(system.parameters, directions[i]);
        const double ds = system.integrator->stop_position_derivative(system.parameters, directions[i]);
        result.d[static_cast<std::size_t>(system.states()) + i] += -sign * dc - (ds - dc);
    }
    return result;
}

Boundary solve_boundary(const flow::System& system, const orbit::ReturnMap& map, Kind kind, const flow::State& guess,
                        double omega, std::span<const flow::ParameterVector> directions) {
    Boundary boundary;
    boundary.kind = kind;
    boundary.status = SolveStatus::no_convergence;
    Problem problem{system, map, kind, {orbit::unit_direction(system.integrator->info().omega)}};
    const int n = system.states();
    SmallVector y = orbit::to_vector(system, guess);
    const double start = omega;
    // Directions other than omega are only needed at the end; they join when the iteration is close.
    double last_move = 1.0;
    for (boundary.iterations = 1; boundary.iterations <= 20; ++boundary.iterations) {
        const bool close = last_move < 1e-3;
        if (close && problem.directions.size() == 1) {
            problem.directions.insert(problem.directions.end(), directions.begin(), directions.end());
        }
        const Image image = problem.image(y, omega);
        if (!image.ok()) {
            boundary.status = SolveStatus::flow_failed;
            return boundary;
        }
        const Test test = evaluate(problem, y, omega, image);
        if (!test.ok) { return boundary; }
        SmallMatrix jacobian(n + 1, n + 1);
        jacobian.topRows(n) = image.derivative.leftCols(n + 1);
        jacobian.topLeftCorner(n, n) -= SmallMatrix::Identity(n, n);
        for (int c = 0; c <= n; ++c) { jacobian(n, c) = test.value.d[static_cast<std::size_t>(c)]; }
        SmallVector residual(n + 1);
        residual.head(n) = orbit::to_vector(system, image.state) - y;
        residual[n] = test.value.value;
        const auto lu = jacobian.partialPivLu();
        SmallVector step = lu.solve(-residual);
        if (!step.allFinite()) { return boundary; }
        boundary.residual = residual.norm();
        last_move = step.norm() / (1.0 + y.norm());
        const double limit = 0.2 * (1.0 + y.norm());
        if (step.norm() > limit) { step *= limit / step.norm(); }
        y += step.head(n);
        omega += step[n];
        if (!(omega > 0.2 * start && omega < 5.0 * start)) { return boundary; }
        // After a step of 1e-9 the next would be of rounding size; the fold's differences leave 1e-8 in the Jacobian.
        if (close && last_move < 1e-9 && boundary.residual < 1e-8) {
            boundary.status = SolveStatus::converged;
            boundary.monodromy = image.derivative.leftCols(n);
            boundary.theta_contact = image.theta_x_max;
            if (map.mirrored) {
                const double centre = system.integrator->centre(system.parameters);
                const bool upper =
                    image.observed[orbit::x_max].value - centre >= centre - image.observed[orbit::x_min].value;
                boundary.theta_contact = upper ? image.theta_x_max : image.theta_x_min + map.duration();
            }
            for (std::size_t i = 0; i < directions.size(); ++i) {
                SmallVector right(n + 1);
                right.head(n) = image.derivative.col(n + 1 + static_cast<int>(i));
                right[n] = test.value.d[static_cast<std::size_t>(n) + 1 + i];
                const SmallVector d = lu.solve(-right);
                boundary.d_omega.push_back(d[n]);
                boundary.d_state.push_back(orbit::to_state(d.head(n)));
            }
            break;
        }
    }
    boundary.omega = omega;
    boundary.state = orbit::to_state(y);
    return boundary;
}

}  // namespace percuss::boundary
