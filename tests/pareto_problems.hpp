#pragma once
/// \file
/// Problems of several objectives with known fronts, for the tests of pareto/.

#include "pareto/multi_objective.hpp"

#include "optimise_problems.hpp"

#include <cmath>
#include <functional>
#include <utility>

namespace percuss::test {

using pareto::VectorEvaluation;

/// A problem from one function that fills all of a VectorEvaluation; counts its calls.
class FunctionObjectives final : public pareto::MultiObjective {
public:
    using Function = std::function<void(const Vector&, VectorEvaluation&)>;
    FunctionObjectives(Vector lower, Vector upper, int objectives, int constraints, Function function)
        : lower_(std::move(lower)),
          upper_(std::move(upper)),
          objectives_(objectives),
          constraints_(constraints),
          function_(std::move(function)) {}

    [[nodiscard]] int variables() const override { return static_cast<int>(lower_.size()); }
    [[nodiscard]] int objectives() const override { return objectives_; }
    [[nodiscard]] int constraints() const override { return constraints_; }
    [[nodiscard]] Vector lower() const override { return lower_; }
    [[nodiscard]] Vector upper() const override { return upper_; }

    VectorEvaluation evaluate(const Vector& x, bool want_gradient) override {
        ++calls;
        outside = outside || (x - lower_).minCoeff() < 0 || (upper_ - x).minCoeff() < 0;
        VectorEvaluation e;
        e.ok = true;
        e.objectives = Vector::Zero(objectives_);
        e.gradients = Matrix::Zero(objectives_, variables());
        e.constraints = Vector::Zero(constraints_);
        e.jacobian = Matrix::Zero(constraints_, variables());
        function_(x, e);
        if (!want_gradient) {
            e.gradients.resize(0, 0);
            e.jacobian.resize(0, 0);
        }
        return e;
    }

    int calls = 0;
    bool outside = false;  ///< whether it was ever asked outside its bounds

private:
    Vector lower_;
    Vector upper_;
    int objectives_;
    int constraints_;
    Function function_;
};

/// Squared distances from (0, 0) and (1, 1) with x_2 <= 0.4 as a limit, or as a bound. The front is x_1 = x_2 = s up to
/// 0.4, then x_2 = 0.4, x_1 = s up to 1; slope -(1 - s)/s on both parts; multiplier of the limit, the weights being (1
/// - s, s): 2 (s - 0.4) on the second.
inline void quadratic_pair(const Vector& x, VectorEvaluation& e) {
    e.objectives << x.squaredNorm(), (x - vec({1, 1})).squaredNorm();
    e.gradients.row(0) = 2 * x.transpose();
    e.gradients.row(1) = 2 * (x - vec({1, 1})).transpose();
}
inline FunctionObjectives limited_pair() {
    return {vec({-1, -1}), vec({2, 2}), 2, 1, [](const Vector& x, VectorEvaluation& e) {
                quadratic_pair(x, e);
                e.constraints << x[1] - 0.4;
                e.jacobian << 0, 1;
            }};
}
inline FunctionObjectives bounded_pair() { return {vec({-1, -1}), vec({2, 0.4}), 2, 0, quadratic_pair}; }
inline double limited_pair_front(double f1) {
    const double s = f1 <= 0.32 ? std::sqrt(f1 / 2) : std::sqrt(f1 - 0.16);
    return f1 <= 0.32 ? 2 * (1 - s) * (1 - s) : (1 - s) * (1 - s) + 0.36;
}

/// Binh and Korn (1997), "BNH": x_1 = x_2 = s up to 3, then x_2 = 3 on its bound, x_1 = s up to 5; slope (s - 5)/(4 s).
inline FunctionObjectives binh_korn() {
    return {vec({0, 0}), vec({5, 3}), 2, 2, [](const Vector& x, VectorEvaluation& e) {
                e.objectives << 4 * x.squaredNorm(), (x - vec({5, 5})).squaredNorm();
                e.gradients.row(0) = 8 * x.transpose();
                e.gradients.row(1) = 2 * (x - vec({5, 5})).transpose();
                e.constraints << ((x - vec({5, 0})).squaredNorm() - 25) / 25,
                    (7.7 - (x - vec({8, -3})).squaredNorm()) / 7.7;
                e.jacobian.row(0) = 2 * (x - vec({5, 0})).transpose() / 25;
                e.jacobian.row(1) = -2 * (x - vec({8, -3})).transpose() / 7.7;
            }};
}
inline double binh_korn_front(double f1) {
    const double s = f1 <= 72 ? std::sqrt(f1 / 8) : std::sqrt(f1 / 4 - 9);
    return f1 <= 72 ? 2 * (s - 5) * (s - 5) : (s - 5) * (s - 5) + 4;
}

/// Four variables that are not quadratic: f_1 = g(x)^2 ... with y = (x_1, ...) on a bent valley. With v_j = x_j - sin(j
/// x_1)/2 for j = 2..4: f_1 = exp(x_1) - 1 + |v|^2, f_2 = exp(-x_1) + |v|^2, x_1 in [0, 2]: the front is v = 0, f_2 =
/// 1/(1 + f_1), slope -exp(-2 x_1).
inline FunctionObjectives bent_valley() {
    return {vec({0, -2, -2, -2}), vec({2, 2, 2, 2}), 2, 0, [](const Vector& x, VectorEvaluation& e) {
                Vector v = Vector::Zero(4);
                Vector dv = Vector::Zero(4);
                for (int j = 1; j < 4; ++j) {
                    v[j] = x[j] - 0.5 * std::sin((j + 1) * x[0]);
                    dv[j] = -0.5 * (j + 1) * std::cos((j + 1) * x[0]);
                }
                e.objectives << std::exp(x[0]) - 1 + v.squaredNorm(), std::exp(-x[0]) + v.squaredNorm();
                e.gradients.row(0) = 2 * v.transpose();
                e.gradients.row(1) = 2 * v.transpose();
                e.gradients(0, 0) = std::exp(x[0]) + 2 * v.dot(dv);
                e.gradients(1, 0) = -std::exp(-x[0]) + 2 * v.dot(dv);
            }};
}

/// Tanaka (1995), "TNK": the front is made of three pieces of the curve r^2 = 1 + cos(16 angle)/10.
inline FunctionObjectives tanaka() {
    return {vec({1e-3, 1e-3}), vec({3, 3}), 2, 2, [](const Vector& x, VectorEvaluation& e) {
                e.objectives = x;
                e.gradients.setIdentity();
                const double angle = std::atan2(x[0], x[1]);
                const double r2 = x.squaredNorm();
                e.constraints << 1 + 0.1 * std::cos(16 * angle) - r2, (x - vec({0.5, 0.5})).squaredNorm() - 0.5;
                const double dangle = -1.6 * std::sin(16 * angle);
                e.jacobian.row(0) << dangle * x[1] / r2 - 2 * x[0], -dangle * x[0] / r2 - 2 * x[1];
                e.jacobian.row(1) = 2 * (x - vec({0.5, 0.5})).transpose();
            }};
}

/// f_1 = x_1, f_2 = wave(x_1) + (x_2 - x_1)^2 with a wave that falls, rises and falls again: several pieces, as in
/// ZDT3.
inline double wave(double x) { return 1 - x + 0.2 * std::sin(6 * std::acos(-1.0) * x); }
inline FunctionObjectives wavy() {
    return {vec({0, -1}), vec({1, 2}), 2, 0, [](const Vector& x, VectorEvaluation& e) {
                const double w = 6 * std::acos(-1.0);
                const double d = x[1] - x[0];
                e.objectives << x[0], wave(x[0]) + d * d;
                e.gradients.row(0) << 1, 0;
                e.gradients.row(1) << -1 + 0.2 * w * std::cos(w * x[0]) - 2 * d, 2 * d;
            }};
}

/// The octant of the unit sphere (as DTLZ2), with a smooth parametrisation: angles x_1, x_2 in [0, 1] quarter turns and
/// a distance 1 + (x_3 - 0.5)^2. The front is |f| = 1.
inline FunctionObjectives sphere() {
    return {vec({0, 0, 0}), vec({1, 1, 1}), 3, 0, [](const Vector& x, VectorEvaluation& e) {
                const double q = std::acos(0.0);
                const double d = x[2] - 0.5;
                const double r = 1 + d * d;
                const double ca = std::cos(q * x[0]), sa = std::sin(q * x[0]);
                const double cb = std::cos(q * x[1]), sb = std::sin(q * x[1]);
                e.objectives << r * ca * cb, r * ca * sb, r * sa;
                e.gradients.row(0) << -r * q * sa * cb, -r * q * ca * sb, 2 * d * ca * cb;
                e.gradients.row(1) << -r * q * sa * sb, r * q * ca * cb, 2 * d * ca * sb;
                e.gradients.row(2) << r * q * ca, 0, 2 * d * sa;
            }};
}

}  // namespace percuss::test
