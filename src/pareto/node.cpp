#include "pareto/node.hpp"

namespace percuss::pareto {
namespace {

/// Points of the archive that teach the first models their curvature: within a quarter of the box, and no more than
/// determine the Hessians of ten variables several times over.
constexpr double archive_radius = 0.25;
constexpr int archive_points = 40;

bool bind_the_same(const Node& a, const Node& b) {
    const auto same = [](const Vector& x, const Vector& y) { return ((x.array() != 0) == (y.array() != 0)).all(); };
    return same(a.certificate.multipliers, b.certificate.multipliers) &&
           same(a.certificate.bound_multipliers, b.certificate.bound_multipliers);
}

}  // namespace

Node node_at(UnitProblem& problem, const Vector& u, Origin origin) {
    Node node{
        u, problem.evaluate(u, true), {}, {problem.variables(), problem.objectives() + problem.constraints()}, origin};
    node.certificate = certify_front(node.here, u);
    learn_from_archive(node.models, problem, u, archive_radius, archive_points);
    if (node.here.ok) node.models.move_to(u, node.here);
    else node.here = problem.evaluate(u, false);  // only the derivatives are missing
    return node;
}

std::optional<Node> solve_from(UnitProblem& problem, const Node& from, const Target& target, Origin origin,
                               const CorrectorOptions& options, const Vector& guess) {
    if (!from.models.has_base()) return std::nullopt;
    Node node{{}, {}, {}, from.models, origin};
    const Correction correction = correct(problem, node.models, target, from.certificate, options, guess);
    if (!correction.converged) return std::nullopt;
    node.u = correction.u;
    node.here = correction.here;
    node.certificate = correction.certificate;
    node.evaluations = correction.evaluations;
    return node;
}

Vector expected_at(const Vector& y, const Vector& direction, const std::vector<const Node*>& nodes) {
    if (nodes.size() < 3) return {};
    const double s = y.dot(direction);
    Vector sum = Vector::Zero(nodes.front()->u.size());
    for (const Node* node : nodes) {
        if (!bind_the_same(*node, *nodes.front())) return {};
        const double here = node->here.objectives.dot(direction);
        double factor = 1.0;  // Lagrange's
        for (const Node* other : nodes) {
            if (other == node) continue;
            const double there = other->here.objectives.dot(direction);
            factor *= (s - there) / (here - there);
        }
        sum += factor * node->u;
    }
    return sum.allFinite() ? sum : Vector{};
}

}  // namespace percuss::pareto
