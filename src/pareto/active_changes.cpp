#include "pareto/active_changes.hpp"

#include <cmath>

namespace percuss::pareto {
namespace {

constexpr int most_targets = 8;
constexpr double at_the_change = 1e-6;   // of multiplier or slack: the activity of certificates
constexpr double narrow_bracket = 1e-3;  // of the chord

struct Restriction {
    bool is_bound = false;
    int index = 0;
};

/// > 0: it binds, with this multiplier. < 0: minus the slack.
double binding(const Node& node, const Restriction& r) {
    if (r.is_bound) {
        const double multiplier = std::abs(node.certificate.bound_multipliers[r.index]);
        const double u = node.u[r.index];
        return multiplier > 0 ? multiplier : -std::min(u, 1.0 - u);
    }
    const double multiplier = node.certificate.multipliers[r.index];
    return multiplier > 0 ? multiplier : node.here.constraints[r.index];
}

bool changes(const Node& left, const Node& right, const Restriction& r) {
    const double a = binding(left, r);
    const double b = binding(right, r);
    // An end that is at a change already needs none.
    return std::abs(a) > at_the_change && std::abs(b) > at_the_change && (a > 0) != (b > 0);
}

std::optional<Restriction> first_change(const Node& left, const Node& right) {
    for (int i = 0; i < left.certificate.multipliers.size(); ++i) {
        if (changes(left, right, {false, i})) return Restriction{false, i};
    }
    for (int j = 0; j < left.u.size(); ++j) {
        if (changes(left, right, {true, j})) return Restriction{true, j};
    }
    return std::nullopt;
}

}  // namespace

std::optional<LocatedChange> locate_change(const Node& left, const Node& right, const CorrectFrom& correct_from) {
    const std::optional<Restriction> restriction = first_change(left, right);
    if (!restriction) return std::nullopt;
    const Vector chord = right.here.objectives - left.here.objectives;
    Vector normal(2);
    normal << -chord[1], chord[0];
    normal /= normal.norm();

    Node low = left;  // ends of the bracket, s = 0 and 1 along the chord at first
    Node high = right;
    double s_low = 0.0;
    double s_high = 1.0;
    double f_low = binding(low, *restriction);
    double f_high = binding(high, *restriction);
    const bool begins = f_low < 0;
    std::optional<Node> best;
    double smallest = std::min(std::abs(f_low), std::abs(f_high));
    int evaluations = 0;
    int side = 0;
    for (int k = 0; k < most_targets && s_high - s_low > narrow_bracket && smallest > at_the_change; ++k) {
        const double s = s_low + (s_high - s_low) * f_low / (f_low - f_high);
        const Node& nearer = s - s_low < s_high - s ? low : high;
        std::optional<Node> node = correct_from(nearer, {left.here.objectives + s * chord, normal});
        if (!node || !(node->y1() > low.y1() && node->y1() < high.y1())) break;
        evaluations += node->evaluations;
        const double f = binding(*node, *restriction);
        if (std::abs(f) < smallest) {
            smallest = std::abs(f);
            best = node;
        }
        // Illinois: an end kept twice in a row counts half.
        if ((f > 0) == (f_low > 0)) {
            low = *node;
            s_low = s;
            f_low = f;
            if (side == -1) f_high *= 0.5;
            side = -1;
        } else {
            high = *node;
            s_high = s;
            f_high = f;
            if (side == 1) f_low *= 0.5;
            side = 1;
        }
    }
    if (!best) return std::nullopt;
    best->evaluations = evaluations;
    const double width = smallest <= at_the_change ? 0.0 : (s_high - s_low) * chord.norm();
    return LocatedChange{*best, restriction->is_bound, restriction->index, begins, width};
}

}  // namespace percuss::pareto
