#include "pareto/node.hpp"

namespace percuss::pareto {
namespace {

/// Points of the archive that teach the first models their curvature: within a quarter of the box, and no more than
/// determine the Hessians of ten variables several times over.
constexpr double archive_radius = 0.25;
constexpr int archive_points = 40;

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
                               const CorrectorOptions& options) {
    if (!from.models.has_base()) return std::nullopt;
    Node node{{}, {}, {}, from.models, origin};
    const Correction correction = correct(problem, node.models, target, from.certificate, options);
    if (!correction.converged) return std::nullopt;
    node.u = correction.u;
    node.here = correction.here;
    node.certificate = correction.certificate;
    node.evaluations = correction.evaluations;
    return node;
}

}  // namespace percuss::pareto
