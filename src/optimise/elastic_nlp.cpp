#include "optimise/elastic_nlp.hpp"

namespace percuss::optimise {

Evaluation ElasticNlp::evaluate(const Vector& z, bool want_gradient) {
    const Eigen::Index n = z.size() - 1;
    const double t = z[n];
    const Evaluation inner = nlp_.evaluate(z.head(n), want_gradient);
    Evaluation elastic;
    elastic.ok = inner.ok;
    if (!inner.ok) return elastic;
    elastic.objective = t;
    elastic.constraints = inner.constraints.array() - t;
    if (!want_gradient) return elastic;
    // f = t, c_i - t <= 0: by (x, t) the gradient is (0, 1) and the Jacobian [J, -1].
    elastic.gradient = joined(Vector::Zero(n), 1.0);
    elastic.jacobian.resize(inner.jacobian.rows(), n + 1);
    elastic.jacobian << inner.jacobian, Vector::Constant(inner.jacobian.rows(), -1.0);
    return elastic;
}

Vector ElasticNlp::joined(const Vector& x, double t) {
    Vector z(x.size() + 1);
    z << x, t;
    return z;
}

}  // namespace percuss::optimise
