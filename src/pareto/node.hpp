#pragma once
/// \file
/// A point of the front while the front is being built.

#include "pareto/corrector.hpp"

#include <optional>

namespace percuss::pareto {

/// A point, with the models that were in use there.
struct Node {
    Vector u;
    VectorEvaluation here;  ///< scaled
    FrontCertificate certificate;
    QuadraticModels models;  ///< their base is u
    Origin origin = Origin::searched;
    int evaluations = 0;

    /// The gap to the right: no point of the front left of the right neighbour has y_2 <= explored.
    double explored = 0.0;
    bool local_failed = false;  ///< the corrector could not divide the gap
    bool jump = false;          ///< a search found nothing in it
    bool given_up = false;      ///< nothing could divide it

    [[nodiscard]] double y1() const { return here.objectives[0]; }
    [[nodiscard]] double y2() const { return here.objectives[1]; }
};

/// A node at a point that can be evaluated, with models that know what the archive tells about its neighbourhood.
[[nodiscard]] Node node_at(UnitProblem& problem, const Vector& u, Origin origin);

/// The node on the front that corrects the target from another node (corrector.hpp); nothing where that fails.
[[nodiscard]] std::optional<Node> solve_from(UnitProblem& problem, const Node& from, const Target& target,
                                             Origin origin, const CorrectorOptions& options, const Vector& guess = {});

/// Where the front, known at some nodes of one piece, passes the line across `direction` through y: the polynomial
/// through the nodes' u over their place along `direction` (of degree one less than the nodes). Empty for fewer than
/// three nodes, or where two of them do not bind the same limits and bounds.
[[nodiscard]] Vector expected_at(const Vector& y, const Vector& direction, const std::vector<const Node*>& nodes);

}  // namespace percuss::pareto
