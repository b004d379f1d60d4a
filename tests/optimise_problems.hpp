#pragma once
/// \file
/// Small nonlinear programs with known answers, for the tests of optimise/.

#include "optimise/certificate.hpp"
#include "optimise/nlp.hpp"

#include <cmath>
#include <functional>
#include <memory>
#include <utility>
#include <vector>

namespace percuss::test {

using numerics::Matrix;
using numerics::Vector;
using optimise::Evaluation;

inline Vector vec(std::initializer_list<double> values) {
    Vector v(static_cast<Eigen::Index>(values.size()));
    std::copy(values.begin(), values.end(), v.begin());
    return v;
}

inline optimise::Certificate certificate_at(optimise::Nlp& nlp, const Vector& x) {
    return optimise::certify(nlp.evaluate(x, true), x, nlp.lower(), nlp.upper());
}

inline bool same_bits(const Vector& a, const Vector& b) {
    return a.size() == b.size() && std::equal(a.begin(), a.end(), b.begin());
}

/// A problem from one function that fills all of an Evaluation; counts its calls.
class FunctionNlp : public optimise::Nlp {
public:
    using Function = std::function<void(const Vector&, Evaluation&)>;
    FunctionNlp(Vector lower, Vector upper, int constraints, Function function)
        : lower_(std::move(lower)),
          upper_(std::move(upper)),
          constraints_(constraints),
          function_(std::move(function)) {}

    [[nodiscard]] int variables() const override { return static_cast<int>(lower_.size()); }
    [[nodiscard]] int constraints() const override { return constraints_; }
    [[nodiscard]] Vector lower() const override { return lower_; }
    [[nodiscard]] Vector upper() const override { return upper_; }

    Evaluation evaluate(const Vector& x, bool want_gradient) override {
        ++calls;
        gradients += want_gradient ? 1 : 0;
        outside = outside || (x - lower_).minCoeff() < 0 || (upper_ - x).minCoeff() < 0;
        Evaluation e;
        e.ok = true;
        e.gradient = Vector::Zero(variables());
        e.constraints = Vector::Zero(constraints_);
        e.jacobian = Matrix::Zero(constraints_, variables());
        function_(x, e);
        if (!want_gradient) {
            e.gradient.resize(0);
            e.jacobian.resize(0, 0);
        }
        return e;
    }

    int calls = 0;
    int gradients = 0;
    bool outside = false;  ///< whether it was ever asked outside its bounds

private:
    Vector lower_;
    Vector upper_;
    int constraints_;
    Function function_;
};

/// A problem, its start and its solution.
struct Known {
    std::unique_ptr<FunctionNlp> nlp;
    Vector start;
    Vector x;
    double objective;
};

/// Rosenbrock in the unit disc. The solution is the root of the KKT system, by Newton in 50 digits elsewhere.
inline Known rosenbrock_disc() {
    auto f = [](const Vector& x, Evaluation& e) {
        const double a = 1 - x[0];
        const double b = x[1] - x[0] * x[0];
        e.objective = a * a + 100 * b * b;
        e.gradient << -2 * a - 400 * x[0] * b, 200 * b;
        e.constraints << x.squaredNorm() - 1;
        e.jacobian.row(0) = 2 * x.transpose();
    };
    return {std::make_unique<FunctionNlp>(vec({-1.5, -1.5}), vec({1.5, 1.5}), 1, f), vec({-0.5, 0.3}),
            vec({0.786415154, 0.617698316}), 0.0456748088};
}

/// Hock and Schittkowski 35 (Test Examples for Nonlinear Programming Codes, 1981).
inline Known hs35() {
    auto f = [](const Vector& x, Evaluation& e) {
        e.objective = 9 - 8 * x[0] - 6 * x[1] - 4 * x[2] + 2 * x[0] * x[0] + 2 * x[1] * x[1] + x[2] * x[2] +
                      2 * x[0] * x[1] + 2 * x[0] * x[2];
        e.gradient << -8 + 4 * x[0] + 2 * x[1] + 2 * x[2], -6 + 4 * x[1] + 2 * x[0], -4 + 2 * x[2] + 2 * x[0];
        e.constraints << x[0] + x[1] + 2 * x[2] - 3;
        e.jacobian << 1, 1, 2;
    };
    return {std::make_unique<FunctionNlp>(vec({0, 0, 0}), vec({3, 3, 3}), 1, f), vec({0.5, 0.5, 0.5}),
            vec({4.0 / 3, 7.0 / 9, 4.0 / 9}), 1.0 / 9};
}

/// Hock and Schittkowski 43 (Rosen and Suzuki); multipliers 1, 0, 2.
inline Known hs43() {
    auto f = [](const Vector& x, Evaluation& e) {
        e.objective =
            x[0] * x[0] + x[1] * x[1] + 2 * x[2] * x[2] + x[3] * x[3] - 5 * x[0] - 5 * x[1] - 21 * x[2] + 7 * x[3];
        e.gradient << 2 * x[0] - 5, 2 * x[1] - 5, 4 * x[2] - 21, 2 * x[3] + 7;
        e.constraints << x.squaredNorm() + x[0] - x[1] + x[2] - x[3] - 8,
            x[0] * x[0] + 2 * x[1] * x[1] + x[2] * x[2] + 2 * x[3] * x[3] - x[0] - x[3] - 10,
            2 * x[0] * x[0] + x[1] * x[1] + x[2] * x[2] + 2 * x[0] - x[1] - x[3] - 5;
        e.jacobian.row(0) << 2 * x[0] + 1, 2 * x[1] - 1, 2 * x[2] + 1, 2 * x[3] - 1;
        e.jacobian.row(1) << 2 * x[0] - 1, 4 * x[1], 2 * x[2], 4 * x[3] - 1;
        e.jacobian.row(2) << 4 * x[0] + 2, 2 * x[1] - 1, 2 * x[2], -1;
    };
    return {std::make_unique<FunctionNlp>(vec({-5, -5, -5, -5}), vec({5, 5, 5, 5}), 3, f), vec({0, 0, 0, 0}),
            vec({0, 1, 2, -1}), -44};
}

/// Hock and Schittkowski 71 with its equation as the inequality that binds; x_1 ends on its lower bound.
/// Multipliers as printed by the example that comes with Ipopt: 0.55229366, 0.16146857, bound 1.0878712.
inline Known hs71() {
    auto f = [](const Vector& x, Evaluation& e) {
        const double s = x[0] + x[1] + x[2];
        e.objective = x[0] * x[3] * s + x[2];
        e.gradient << x[3] * s + x[0] * x[3], x[0] * x[3], x[0] * x[3] + 1, x[0] * s;
        e.constraints << 25 - x.prod(), x.squaredNorm() - 40;
        for (int j = 0; j < 4; ++j) {
            e.jacobian(0, j) = -1;
            for (int k = 0; k < 4; ++k) e.jacobian(0, j) *= k == j ? 1 : x[k];
        }
        e.jacobian.row(1) = 2 * x.transpose();
    };
    return {std::make_unique<FunctionNlp>(vec({1, 1, 1, 1}), vec({5, 5, 5, 5}), 2, f), vec({1, 5, 5, 1}),
            vec({1, 4.74299963, 3.82114998, 1.37940829}), 17.0140173};
}

/// Hock and Schittkowski 100, seven variables, divided by 100.
inline Known hs100() {
    auto f = [](const Vector& x, Evaluation& e) {
        const auto sq = [](double v) { return v * v; };
        e.objective = sq(x[0] - 10) + 5 * sq(x[1] - 12) + std::pow(x[2], 4) + 3 * sq(x[3] - 11) +
                      10 * std::pow(x[4], 6) + 7 * sq(x[5]) + std::pow(x[6], 4) - 4 * x[5] * x[6] - 10 * x[5] -
                      8 * x[6];
        e.gradient << 2 * (x[0] - 10), 10 * (x[1] - 12), 4 * std::pow(x[2], 3), 6 * (x[3] - 11), 60 * std::pow(x[4], 5),
            14 * x[5] - 4 * x[6] - 10, 4 * std::pow(x[6], 3) - 4 * x[5] - 8;
        e.constraints << 2 * sq(x[0]) + 3 * std::pow(x[1], 4) + x[2] + 4 * sq(x[3]) + 5 * x[4] - 127,
            7 * x[0] + 3 * x[1] + 10 * sq(x[2]) + x[3] - x[4] - 282,
            23 * x[0] + sq(x[1]) + 6 * sq(x[5]) - 8 * x[6] - 196,
            4 * sq(x[0]) + sq(x[1]) - 3 * x[0] * x[1] + 2 * sq(x[2]) + 5 * x[5] - 11 * x[6];
        e.jacobian.row(0) << 4 * x[0], 12 * std::pow(x[1], 3), 1, 8 * x[3], 5, 0, 0;
        e.jacobian.row(1) << 7, 3, 20 * x[2], 1, -1, 0, 0;
        e.jacobian.row(2) << 23, 2 * x[1], 0, 0, 0, 12 * x[5], -8;
        e.jacobian.row(3) << 8 * x[0] - 3 * x[1], 2 * x[1] - 3 * x[0], 4 * x[2], 0, 0, 5, -11;
        e.objective /= 100;
        e.gradient /= 100;
        e.constraints /= 100;
        e.jacobian /= 100;
    };
    return {std::make_unique<FunctionNlp>(Vector::Constant(7, -5), Vector::Constant(7, 5), 4, f),
            vec({1, 2, 0, 4, 0, 1, 1}), vec({2.330499, 1.951372, -0.4775414, 4.365726, -0.6244870, 1.038131, 1.594227}),
            6.806300573};
}

/// min (x - 2)^2 on [0, 3] subject to x <= 1.5: the smallest problem there is.
inline Known one_variable() {
    auto f = [](const Vector& x, Evaluation& e) {
        e.objective = (x[0] - 2) * (x[0] - 2);
        e.gradient << 2 * (x[0] - 2);
        e.constraints << x[0] - 1.5;
        e.jacobian << 1;
    };
    return {std::make_unique<FunctionNlp>(vec({0}), vec({3}), 1, f), vec({0.4}), vec({1.5}), 0.25};
}

/// Rosenbrock in the disc with an evaluator that fails where x_0 < -0.55 and in a ball around (0.2, 0.75), beside the
/// way from the start to the solution.
inline Known rosenbrock_with_holes() {
    Known whole = rosenbrock_disc();
    const std::shared_ptr<FunctionNlp> inner = std::move(whole.nlp);
    auto f = [inner](const Vector& x, Evaluation& e) {
        e = inner->evaluate(x, true);
        e.ok = x[0] >= -0.55 && (x - vec({0.2, 0.75})).norm() > 0.5;
    };
    return {std::make_unique<FunctionNlp>(inner->lower(), inner->upper(), 1, f), whole.start, whole.x, whole.objective};
}

/// No point has |x|^2 <= 1 and x_0 + x_1 >= 3: both are missed by 1 at (1, 1). With multipliers mu, 1 - mu of the two,
/// 2 mu = 1 - mu. The third constraint is easy.
inline std::unique_ptr<FunctionNlp> contradiction() {
    auto f = [](const Vector& x, Evaluation& e) {
        e.objective = x[0];
        e.gradient << 1, 0;
        e.constraints << x.squaredNorm() - 1, 3 - x[0] - x[1], x[0] - 1.9;
        e.jacobian << 2 * x[0], 2 * x[1], -1, -1, 1, 0;
    };
    return std::make_unique<FunctionNlp>(vec({0, 0}), vec({2, 2}), 3, f);
}

}  // namespace percuss::test
