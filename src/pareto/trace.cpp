#include "pareto/trace.hpp"

#include "optimise/memoised_nlp.hpp"
#include "pareto/active_changes.hpp"
#include "pareto/trace_nodes.hpp"

#include <algorithm>
#include <cmath>
#include <optional>
#include <stdexcept>
#include <utility>

namespace percuss::pareto {
namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();

/// A failed step is halved this often before tracing ends: an eighth of the spacing is as near as is of use.
constexpr int halvings = 3;
/// A corrected step must have gone on by this part of its length, and by no more than so many lengths; what has not is
/// at an end of its piece, or on another one.
constexpr double least_progress = 0.2;
constexpr double most_progress = 3.0;
/// A neighbour within so many steps, and this near to the direction of the tangent, is where the piece leads.
constexpr double near_enough = 1.3;
constexpr double in_line = 0.5;
/// A point that leaves more than this part of a gap's area did not divide it.
constexpr double divided = 0.95;
/// A search looks this far (of the spacing, or of the gap if that is less) below a gap's upper end: near enough to find
/// a piece that goes on from there, and that an empty answer settles most of the gap.
constexpr double below_end = 0.1;
constexpr double below_end_of_gap = 0.25;
/// Searches cost some hundred evaluations each. A front needs one or two a jump; more mean that its points cannot be
/// certified (kinks, or the border of what can be evaluated), and then searching on does not end.
constexpr int most_searches = 40;
/// A cubic through the last four points tells the next to the fourth power of the spacing; more points would carry
/// their own errors on.
constexpr std::size_t nodes_of_guess = 4;
/// A point of the archive must beat a point of the front by this much: more than corrections can be off.
constexpr double clearly = 1e-6;

class Tracer {
public:
    Tracer(MultiObjective& problem, const FrontOptions& options)
        : options_(options),
          problem_(problem, {options.max_evaluations, options.cancelled}),
          // The curve is at most 2 long, so that 2/points cannot use up all points on the way; half of the bound's
          // tolerance is about the spacing that it needs on a straight front.
          spacing_(std::max(2.0 / options.points, options.tolerance)) {
        corrector_.tolerance = options.certificate_tolerance;
        corrector_.feasibility_tolerance = options.search.feasibility_tolerance;
    }

    [[nodiscard]] bool find_anchors();
    void trace_from_anchors();
    void locate_changes();
    [[nodiscard]] bool wants_refinement() const;
    void refine_loosest_gap();
    [[nodiscard]] bool replace_beaten_piece();
    [[nodiscard]] Front result();
    void cut_short(const std::string& why) {
        cut_short_ = true;
        front_.message = why;
    }

private:
    [[nodiscard]] bool may_add() const { return static_cast<int>(nodes_.size()) < options_.points; }
    [[nodiscard]] std::optional<Node> solve(const Node& from, const Target& target, Origin origin,
                                            const Vector& guess = {}) {
        return solve_from(problem_, from, target, origin, corrector_, guess);
    }
    [[nodiscard]] std::optional<Node> step_ahead(const std::vector<Node>& walked, int direction, double length);
    [[nodiscard]] bool arrived(const Node& from, int direction, double length) const;
    void trace(const Node& start, int direction);
    void trace_both_ways(const Node& from);
    [[nodiscard]] bool divide(std::size_t gap);
    void search_in(std::size_t gap);
    [[nodiscard]] std::optional<Node> best_below(double y2, const std::vector<Vector>& warm_starts);
    [[nodiscard]] std::vector<Vector> archived_in(std::size_t gap, double y2) const;
    void mark_jump_before(const Vector& u);
    [[nodiscard]] int beaten_node(const Vector& y) const;
    [[nodiscard]] bool feasible(const VectorEvaluation& e) const {
        return e.ok && optimise::infeasibility_of(e.constraints) <= options_.search.feasibility_tolerance;
    }
    void fill_status();

    const FrontOptions& options_;
    UnitProblem problem_;
    CorrectorOptions corrector_;
    double spacing_;
    NodeList nodes_;
    std::vector<LocatedChange> changes_;
    bool single_ = false;
    bool cut_short_ = false;
    int challenges_ = 0;
    Front front_;
};

bool Tracer::find_anchors() {
    const Anchors anchors = pareto::find_anchors(problem_, options_.search);
    front_.anchor_evaluations = problem_.evaluations();
    front_.message = anchors.message;
    if (!anchors.found) return false;
    for (const Anchor& anchor : anchors.anchors) {
        Node node = node_at(problem_, anchor.u, Origin::anchor);
        node.evaluations = anchor.evaluations;
        nodes_.insert(std::move(node));
    }
    single_ = anchors.single || nodes_.size() < 2;
    return !single_;
}

/// Unit tangent of the front at a node, towards larger y_1 (direction 1) or smaller.
Vector tangent_at(const Node& node, int direction) {
    const Vector& w = node.certificate.weights;
    Vector tangent(2);
    tangent << w[1], -w[0];
    return direction * tangent / w.norm();
}

/// The point at `length` on the tangent, corrected along the normal.
std::optional<Node> Tracer::step_ahead(const std::vector<Node>& walked, int direction, double length) {
    const Node& from = walked.back();
    const Vector tangent = tangent_at(from, direction);
    Vector normal = from.certificate.weights / from.certificate.weights.norm();
    for (double& v : normal) v = v < 1e-6 ? 0.0 : v;  // an end of the front: the other objective is a limit
    const Vector target = from.here.objectives + length * tangent;
    std::vector<const Node*> last;
    for (std::size_t k = walked.size(); k-- > 0 && last.size() < nodes_of_guess;) last.push_back(&walked[k]);
    const Vector guess = expected_at(target, tangent, last);
    std::optional<Node> node = solve(from, {target, normal}, Origin::traced, guess);
    if (!node) return std::nullopt;
    const Vector moved = node->here.objectives - from.here.objectives;
    const double progress = moved.dot(tangent);
    const bool onwards = direction * moved[0] > 0 && direction * moved[1] < 0;
    const bool fits = progress >= least_progress * length && moved.norm() <= most_progress * length;
    if (!onwards || !fits) return std::nullopt;
    return node;
}

/// Whether the next node on that side continues the piece within a step, or there is none.
bool Tracer::arrived(const Node& from, int direction, double length) const {
    int next = -1;
    for (std::size_t i = 0; i < nodes_.size(); ++i) {
        if (direction * (nodes_[i].y1() - from.y1()) <= 0) continue;
        next = static_cast<int>(i);
        if (direction > 0) break;
    }
    if (next < 0) return true;
    const Vector way = nodes_[static_cast<std::size_t>(next)].here.objectives - from.here.objectives;
    const double distance = way.norm();
    return distance <= near_enough * length &&
           (way - distance * tangent_at(from, direction)).norm() <= in_line * distance;
}

void Tracer::trace(const Node& start, int direction) {
    std::vector<Node> walked = {start};
    double length = spacing_;
    int spent = 0;  // on steps that failed
    while (may_add() && length > std::ldexp(spacing_, -halvings) * 0.99 && !arrived(walked.back(), direction, length)) {
        const int before = problem_.evaluations();
        std::optional<Node> next = step_ahead(walked, direction, length);
        spent += problem_.evaluations() - before;
        if (next) next->evaluations = spent;
        if (next && nodes_.insert(*next) >= 0) {
            walked.push_back(std::move(*next));
            length = std::min(2.0 * length, spacing_);
            spent = 0;
        } else {
            length *= 0.5;
        }
    }
}

void Tracer::trace_both_ways(const Node& from) {
    trace(from, 1);
    trace(from, -1);
}

void Tracer::trace_from_anchors() {
    const Node left = nodes_[0];
    const Node right = nodes_[nodes_.size() - 1];
    trace(left, 1);
    trace(right, -1);
}

void Tracer::locate_changes() {
    if (!options_.locate_changes) return;
    for (std::size_t i = 0; i + 1 < nodes_.size() && may_add(); ++i) {
        if ((nodes_[i + 1].here.objectives - nodes_[i].here.objectives).norm() > most_progress * spacing_) continue;
        const auto corrected = [&](const Node& from, const Target& target) {
            return solve(from, target, Origin::change);
        };
        const std::optional<LocatedChange> change = locate_change(nodes_[i], nodes_[i + 1], corrected);
        if (!change || nodes_.insert(change->node) < 0) continue;
        changes_.push_back(*change);
        ++i;  // what is left of this one's bracket lies beyond it
    }
}

bool Tracer::wants_refinement() const {
    return may_add() && nodes_.loosest_gap() >= 0 && !(nodes_.error_bound() <= options_.tolerance);
}

void Tracer::refine_loosest_gap() {
    const auto gap = static_cast<std::size_t>(nodes_.loosest_gap());
    if (!nodes_[gap].local_failed && !nodes_[gap].jump && divide(gap)) return;
    nodes_[gap].local_failed = true;
    search_in(gap);
}

/// The middle of the gap's chord, by the corrector, from the left end or else from the right one.
bool Tracer::divide(std::size_t gap) {
    const Node left = nodes_[gap];
    const Node right = nodes_[gap + 1];
    const double area = nodes_.gap_area(gap);
    const Vector chord = right.here.objectives - left.here.objectives;
    Vector normal(2);
    normal << -chord[1], chord[0];
    const Target middle{0.5 * (left.here.objectives + right.here.objectives), normal / normal.norm()};
    const int before = problem_.evaluations();
    std::vector<const Node*> around;
    for (std::size_t i = gap > 0 ? gap - 1 : 0; i < std::min(gap + 3, nodes_.size()); ++i) around.push_back(&nodes_[i]);
    const Vector guess = expected_at(middle.anchor, chord / chord.norm(), around);
    for (const Node* from : {&left, &right}) {
        std::optional<Node> node = solve(*from, middle, Origin::bisected, from == &left ? guess : Vector{});
        if (!node) continue;
        const double y1 = node->y1();
        const double y2 = node->y2();
        if (!(y1 > left.y1() && y1 < right.y1() && y2 < left.y2() && y2 > right.y2())) continue;
        const double after = (y1 - left.y1()) * (left.y2() - y2) + (right.y1() - y1) * (y2 - right.y2());
        if (after > divided * area) continue;
        node->evaluations = problem_.evaluations() - before;
        if (nodes_.insert(std::move(*node)) >= 0) return true;
    }
    return false;
}

/// Feasible points of the archive left of the gap's right end and below y2, the one of smallest y_1 and the one of
/// smallest sum: from where a search is likely to find a piece inside the gap.
std::vector<Vector> Tracer::archived_in(std::size_t gap, double y2) const {
    const UnitProblem::Visited* leftmost = nullptr;
    const UnitProblem::Visited* lowest = nullptr;
    double smallest = nodes_[gap + 1].y1();
    double smallest_sum = infinity;
    for (const UnitProblem::Visited& visited : problem_.archive()) {
        if (!feasible(visited.raw)) continue;
        const Vector y = problem_.scaled(visited.raw).objectives;
        if (y[1] > y2 || y[0] >= nodes_[gap + 1].y1() - clearly) continue;
        if (y[0] < smallest) {
            smallest = y[0];
            leftmost = &visited;
        }
        if (y.sum() < smallest_sum) {
            smallest_sum = y.sum();
            lowest = &visited;
        }
    }
    std::vector<Vector> points;
    if (leftmost != nullptr) points.push_back(leftmost->u);
    if (lowest != nullptr && lowest != leftmost) points.push_back(lowest->u);
    return points;
}

/// The feasible point of smallest y_1 with y_2 at most the given, by a global search; then brought onto the front.
std::optional<Node> Tracer::best_below(double y2, const std::vector<Vector>& warm_starts) {
    const int before = problem_.evaluations();
    Vector limits(2);
    limits << infinity, y2;
    const optimise::MultiStartResult found = search(problem_, 0, limits, warm_starts, options_.search);
    ++front_.searches;
    std::optional<Node> node;
    if (found.best.feasible) node = node_at(problem_, found.best.x, Origin::searched);
    if (node && !node->certificate.certified(options_.certificate_tolerance, corrector_.feasibility_tolerance)) {
        // Of the epsilon-constraint problem the optimum may still be rough: correct it where it is.
        std::optional<Node> better = solve(*node, {node->here.objectives, Vector::Ones(2)}, Origin::searched);
        if (better && (better->here.objectives - node->here.objectives).norm() <= spacing_) node = std::move(better);
    }
    const int spent = problem_.evaluations() - before;
    front_.search_evaluations += spent;
    if (node) node->evaluations = spent;
    return node;
}

void Tracer::search_in(std::size_t gap) {
    const double height = nodes_[gap].y2() - nodes_[gap].explored;
    const double y2 = nodes_[gap].y2() - std::min(below_end * spacing_, below_end_of_gap * height);
    if (front_.searches >= most_searches) {
        nodes_[gap].given_up = true;
        return;
    }
    std::vector<Vector> warm = archived_in(gap, y2);
    warm.push_back(nodes_[gap + 1].u);
    std::optional<Node> found = best_below(y2, warm);
    const double right = nodes_[gap + 1].y1();
    if (!found) {
        nodes_[gap].given_up = true;
    } else if (found->y1() >= right - clearly) {  // nothing left of the right end: the front jumps
        nodes_[gap].explored = y2;
        nodes_[gap].jump = true;
    } else if (const int place = nodes_.insert(*found); place < 0) {
        nodes_[gap].given_up = true;
    } else {
        // Nothing lies left of what was found below y2.
        if (place > 0) {
            Node& left = nodes_[static_cast<std::size_t>(place) - 1];
            left.explored = std::max(left.explored, std::min(y2, left.y2()));
        }
        trace_both_ways(*found);
        mark_jump_before(found->u);
    }
}

/// What tracing back from a point found by search does not reach is a jump.
void Tracer::mark_jump_before(const Vector& u) {
    for (std::size_t i = 1; i < nodes_.size(); ++i) {
        if (nodes_[i].u != u) continue;
        nodes_[i - 1].jump =
            (nodes_[i].here.objectives - nodes_[i - 1].here.objectives).norm() > most_progress * spacing_;
    }
}

/// Index of a node that y beats clearly; -1 if none.
int Tracer::beaten_node(const Vector& y) const {
    for (std::size_t i = 0; i < nodes_.size(); ++i) {
        const Vector gain = nodes_[i].here.objectives - y;
        if (gain.minCoeff() >= 0 && gain.maxCoeff() > clearly) return static_cast<int>(i);
    }
    return -1;
}

/// True when a piece that was optimal only locally has been replaced.
bool Tracer::replace_beaten_piece() {
    front_.compared = 0;
    if (challenges_ >= most_searches) return false;
    const UnitProblem::Visited* challenger = nullptr;
    double largest = 0.0;
    for (const UnitProblem::Visited& visited : problem_.archive()) {
        if (!feasible(visited.raw)) continue;
        const Vector y = problem_.scaled(visited.raw).objectives;
        const int beaten = beaten_node(y);
        if (beaten < 0) {
            ++front_.compared;
            continue;
        }
        const double gain = (nodes_[static_cast<std::size_t>(beaten)].here.objectives - y).sum();
        if (gain <= largest) continue;
        largest = gain;
        challenger = &visited;
    }
    if (challenger == nullptr) return false;
    ++challenges_;
    const Vector start = challenger->u;  // the archive moves while it grows
    std::optional<Node> better = best_below(problem_.scaled(challenger->raw).objectives[1], {start});
    if (!better || nodes_.insert(*better) < 0) return false;
    trace_both_ways(*better);
    return true;
}

void Tracer::fill_status() {
    using Status = Front::Status;
    if (cut_short_ || problem_.halted()) front_.status = Status::budget;
    else if (nodes_.size() == 0) front_.status = Status::infeasible;
    else if (single_) front_.status = Status::single;
    else if (front_.error_bound <= options_.tolerance) front_.status = Status::converged;
    else if (!may_add()) front_.status = Status::points;
    else front_.status = Status::unresolved;
}

Front Tracer::result() {
    front_.evaluations = problem_.evaluations();
    front_.failures = problem_.failures();
    front_.ideal = problem_.origin();
    front_.nadir = problem_.origin() + problem_.range();
    if (!single_ && nodes_.size() > 1) {
        front_.hypervolume = nodes_.hypervolume();
        front_.error_bound = nodes_.error_bound();
    } else if (single_) {
        front_.error_bound = 0.0;
    }
    for (std::size_t i = 0; i < nodes_.size(); ++i) {
        const Node& node = nodes_[i];
        front_.points.push_back(front_point(problem_, node.u, node.certificate, node.origin, node.evaluations));
        front_.points.back().certified =
            node.certificate.certified(options_.certificate_tolerance, corrector_.feasibility_tolerance);
        if (i + 1 < nodes_.size()) front_.gaps.push_back({i, nodes_.gap_area(i), node.jump, node.given_up});
        for (const LocatedChange& change : changes_) {
            if (change.node.u != node.u) continue;
            front_.changes.push_back({change.is_bound, change.index, change.begins, i, change.width});
        }
    }
    fill_status();
    return std::move(front_);
}

}  // namespace

Front trace_front(MultiObjective& problem, const FrontOptions& options) {
    check(options);
    if (problem.objectives() != 2) {
        throw std::invalid_argument("objectives = " + std::to_string(problem.objectives()) +
                                    ", must be 2 to be traced");
    }
    Tracer tracer(problem, options);
    try {
        if (tracer.find_anchors()) {
            tracer.trace_from_anchors();
            do {
                tracer.locate_changes();
                while (tracer.wants_refinement()) tracer.refine_loosest_gap();
            } while (tracer.replace_beaten_piece());
        }
    } catch (const optimise::Halt& halt) { tracer.cut_short(halt.what()); }
    return tracer.result();
}

}  // namespace percuss::pareto
