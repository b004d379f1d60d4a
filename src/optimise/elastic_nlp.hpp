#pragma once
/// \file
/// A problem relaxed until it has a solution.

#include "optimise/nlp.hpp"

namespace percuss::optimise {

/// For finding the point that violates the constraints of another problem least:
///
///     minimise t   subject to   c_i(x) - t <= 0,   l <= x <= u,   floor <= t <= ceiling
///
/// over z = (x, t). At a solution with t > 0 the multipliers add up to 1, and those above 0 name the constraints that
/// contradict each other (or one that cannot be met within the bounds).
class ElasticNlp final : public Nlp {
public:
    /// `floor` < 0 ends the search a little inside the feasible set, if there is one.
    ElasticNlp(Nlp& nlp, double floor, double ceiling) : nlp_(nlp), floor_(floor), ceiling_(ceiling) {}

    [[nodiscard]] int variables() const override { return nlp_.variables() + 1; }
    [[nodiscard]] int constraints() const override { return nlp_.constraints(); }
    [[nodiscard]] Vector lower() const override { return joined(nlp_.lower(), floor_); }
    [[nodiscard]] Vector upper() const override { return joined(nlp_.upper(), ceiling_); }

    Evaluation evaluate(const Vector& z, bool want_gradient) override;

    /// z of a point x and its t.
    [[nodiscard]] static Vector joined(const Vector& x, double t);

private:
    Nlp& nlp_;
    double floor_;
    double ceiling_;
};

}  // namespace percuss::optimise
