#include "pareto/mesh.hpp"

#include "optimise/memoised_nlp.hpp"
#include "pareto/dominance.hpp"
#include "pareto/hypervolume.hpp"
#include "pareto/node.hpp"
#include "pareto/search_zones.hpp"

#include <algorithm>
#include <limits>
#include <optional>
#include <stdexcept>
#include <string>
#include <utility>

namespace percuss::pareto {
namespace {

/// The nearest of known points may be far at first; a target takes some steps then.
constexpr int most_corrections = 15;
/// Nearer than this to the corner of its zone a point is one of those that define it.
constexpr double inside = 1e-6;
/// As in trace.cpp: more searches than this mean that points cannot be certified.
constexpr int most_searches = 40;

class Mesher {
public:
    Mesher(MultiObjective& problem, const FrontOptions& options)
        : options_(options),
          problem_(problem, {options.max_evaluations, options.cancelled}),
          zones_(3) {
        corrector_.tolerance = options.certificate_tolerance;
        corrector_.feasibility_tolerance = options.search.feasibility_tolerance;
        corrector_.evaluations = most_corrections;
    }

    [[nodiscard]] bool find_anchors();
    [[nodiscard]] bool wants_refinement();
    void refine_loosest_zone();
    [[nodiscard]] Front result();
    void cut_short(const std::string& why) {
        cut_short_ = true;
        front_.message = why;
    }

private:
    [[nodiscard]] std::optional<Node> corrected_in(const SearchZone& zone);
    [[nodiscard]] std::optional<Node> searched_in(const SearchZone& zone);
    [[nodiscard]] const Node& nearest(const Vector& y) const;
    [[nodiscard]] bool lies_in(const SearchZone& zone, const Node& node) const;
    void add(Node node);
    [[nodiscard]] HypervolumeBounds bounds() const;

    const FrontOptions& options_;
    UnitProblem problem_;
    CorrectorOptions corrector_;
    std::vector<Node> nodes_;
    SearchZones zones_;
    bool single_ = false;
    bool cut_short_ = false;
    Front front_;
};

bool Mesher::find_anchors() {
    const Anchors anchors = pareto::find_anchors(problem_, options_.search);
    front_.anchor_evaluations = problem_.evaluations();
    front_.message = anchors.message;
    if (!anchors.found) return false;
    for (const Anchor& anchor : anchors.anchors) {
        Node node = node_at(problem_, anchor.u, Origin::anchor);
        node.evaluations = anchor.evaluations;
        add(std::move(node));
    }
    single_ = anchors.single;
    return !single_;
}

void Mesher::add(Node node) {
    zones_.add(node.here.objectives);
    std::erase_if(nodes_, [&](const Node& other) { return dominates(node.here.objectives, other.here.objectives); });
    nodes_.push_back(std::move(node));
}

HypervolumeBounds Mesher::bounds() const {
    std::vector<Vector> points;
    for (const Node& node : nodes_) points.push_back(node.here.objectives);
    return unknown_front_bounds(points, Vector::Zero(3), Vector::Ones(3));
}

bool Mesher::wants_refinement() {
    if (static_cast<int>(nodes_.size()) >= options_.points || zones_.loosest() == nullptr) return false;
    const HypervolumeBounds b = bounds();
    return !(b.upper - b.lower <= options_.tolerance * b.upper);
}

const Node& Mesher::nearest(const Vector& y) const {
    return *std::min_element(nodes_.begin(), nodes_.end(), [&](const Node& a, const Node& b) {
        return (a.here.objectives - y).squaredNorm() < (b.here.objectives - y).squaredNorm();
    });
}

/// Below the zone's corner and beaten by no known point.
bool Mesher::lies_in(const SearchZone& zone, const Node& node) const {
    const Vector& y = node.here.objectives;
    if (!((zone.upper - y).minCoeff() > inside)) return false;
    return std::none_of(nodes_.begin(), nodes_.end(),
                        [&](const Node& other) { return (other.here.objectives.array() <= y.array() + 1e-9).all(); });
}

std::optional<Node> Mesher::corrected_in(const SearchZone& zone) {
    const Vector lower = zone.lower();
    const Target ray{zone.upper, zone.upper - lower};
    std::optional<Node> node =
        solve_from(problem_, nearest(0.5 * (zone.upper + lower)), ray, Origin::traced, corrector_);
    return node && lies_in(zone, *node) ? std::move(node) : std::nullopt;
}

/// The objective with the widest side is minimised with the others at most in the middle of the box.
std::optional<Node> Mesher::searched_in(const SearchZone& zone) {
    if (front_.searches >= most_searches) return std::nullopt;
    ++front_.searches;
    const int before = problem_.evaluations();
    const Vector lower = zone.lower();
    const Vector middle = 0.5 * (zone.upper + lower);
    Eigen::Index widest = 0;
    (zone.upper - lower).maxCoeff(&widest);
    const optimise::MultiStartResult found =
        search(problem_, static_cast<int>(widest), middle, {nearest(middle).u}, options_.search);
    std::optional<Node> node;
    if (found.best.feasible) node = node_at(problem_, found.best.x, Origin::searched);
    const int spent = problem_.evaluations() - before;
    front_.search_evaluations += spent;
    if (!node || !lies_in(zone, *node)) return std::nullopt;
    node->evaluations = spent;
    return node;
}

void Mesher::refine_loosest_zone() {
    SearchZone& zone = *zones_.loosest();
    std::optional<Node> node = corrected_in(zone);
    if (!node) node = searched_in(zone);
    if (node) add(std::move(*node));
    else zone.closed = true;
}

Front Mesher::result() {
    front_.evaluations = problem_.evaluations();
    front_.failures = problem_.failures();
    front_.ideal = problem_.origin();
    front_.nadir = problem_.origin() + problem_.range();
    std::sort(nodes_.begin(), nodes_.end(), [](const Node& a, const Node& b) {
        return std::lexicographical_compare(a.here.objectives.begin(), a.here.objectives.end(),
                                            b.here.objectives.begin(), b.here.objectives.end());
    });
    for (const Node& node : nodes_) {
        front_.points.push_back(front_point(problem_, node.u, node.certificate, node.origin, node.evaluations));
        front_.points.back().certified =
            node.certificate.certified(options_.certificate_tolerance, corrector_.feasibility_tolerance);
    }
    using Status = Front::Status;
    if (!single_ && !nodes_.empty()) {
        const HypervolumeBounds b = bounds();
        front_.hypervolume = b.lower;
        front_.error_bound = b.upper > 0 ? (b.upper - b.lower) / b.upper : 0.0;
    }
    if (cut_short_ || problem_.halted()) front_.status = Status::budget;
    else if (nodes_.empty()) front_.status = Status::infeasible;
    else if (single_) front_.status = Status::single;
    else if (front_.error_bound <= options_.tolerance) front_.status = Status::converged;
    else if (static_cast<int>(nodes_.size()) >= options_.points) front_.status = Status::points;
    else front_.status = Status::unresolved;
    return std::move(front_);
}

}  // namespace

Front mesh_front(MultiObjective& problem, const FrontOptions& options) {
    check(options);
    if (problem.objectives() != 3) {
        throw std::invalid_argument("objectives = " + std::to_string(problem.objectives()) + ", must be 3 for a mesh");
    }
    Mesher mesher(problem, options);
    try {
        if (mesher.find_anchors()) {
            while (mesher.wants_refinement()) mesher.refine_loosest_zone();
        }
    } catch (const optimise::Halt& halt) { mesher.cut_short(halt.what()); }
    return mesher.result();
}

}  // namespace percuss::pareto
