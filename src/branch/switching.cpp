#include "branch/switching.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace percuss::branch {
namespace {

using numerics::Matrix;
using numerics::Vector;
using orbit::Form;
using orbit::Motion;

/// The same motion as one of twice the period: its contacts, and again one period later.
Motion doubled(const Motion& motion) {
    Motion twice = motion;
    twice.period = 2 * motion.period;
    twice.sequence.period = twice.period;
    for (orbit::ContactUnknowns contact : motion.sequence.contacts) {
        contact.phase += 2.0 * std::numbers::pi * motion.period;
        twice.sequence.contacts.push_back(contact);
    }
    return twice;
}

/// The points of a branch with its folds in their places, so that every parameter it passes lies between neighbours.
std::vector<const Point*> points_and_turns(const Branch& branch) {
    std::vector<const Point*> way;
    for (std::size_t i = 0; i < branch.points.size(); ++i) {
        way.push_back(&branch.points[i]);
        for (const BoundaryPoint& found : branch.boundaries) {
            if (found.after == i && found.kind == boundary::Kind::fold) { way.push_back(&found.point); }
        }
    }
    return way;
}

}  // namespace

std::optional<Departure> departure_at_flip(const flow::ParameterFamily& family, const BoundaryPoint& flip,
                                           double size) {
    const Motion& motion = flip.point.motion;
    const flow::System system = family.at(flip.point.parameter);
    const auto r = orbit::shoot(system, motion, {});
    if (!r) { return std::nullopt; }
    const Vector units = orbit::unit_of_unknowns(family.base, motion, size);
    // The Floquet mode of multiplier -1 is the null vector of A(-1) = F_z - 2 F_closing (boundary/critical.hpp), in
    // scaled unknowns; by singular values, as A is singular to rounding only.
    const Matrix a = (r->by_unknowns - 2.0 * r->by_closing) * units.asDiagonal();
    const Eigen::JacobiSVD<Matrix> svd(a, Eigen::ComputeFullV);
    const Vector mode = svd.matrixV().col(a.cols() - 1);
    Departure departure;
    departure.parameter = flip.point.parameter;
    // Multiplier -1 of the half-cycle map, mirror image included: the motions that leave have lost the symmetry but
    // repeat after one cycle as before.
    if (motion.mirrored) {
        departure.motion = motion;
        departure.motion.mirrored = false;
        departure.off = mode;
        return departure;
    }
    departure.motion = doubled(motion);
    departure.off = mode;
    if (motion.form == Form::sequence) {
        // The mode changes sign from one period to the next.
        departure.off.resize(2 * mode.size());
        departure.off << mode, -mode;
    }
    return departure;
}

bool passes_through(const flow::ParameterFamily& family, const Branch& branch, const Point& motion, double size) {
    const double p = motion.parameter;
    const flow::System system = family.at(p);
    const auto is_it = [&](const Motion& guess) {
        const auto solved = orbit::solve(system, guess);
        if (!solved) { return false; }
        const Look seen = look(family, *solved, p);
        return seen.ok() && same_motion(seen.point, motion, size);
    };
    const std::vector<const Point*> way = points_and_turns(branch);
    // Where it joins another branch it goes on a little beyond its last point, at a flip it begins before its first.
    const auto beyond = [&](const Point& end, const Point& before) {
        const double step = end.parameter - before.parameter;
        return (p - end.parameter) * step > 0.0 && std::abs(p - end.parameter) < 2.0 * std::abs(step);
    };
    if (way.size() > 1) {
        if (beyond(*way.front(), *way[1]) && is_it(way.front()->motion)) { return true; }
        if (beyond(*way.back(), *way[way.size() - 2]) && is_it(way.back()->motion)) { return true; }
    }
    for (std::size_t i = 0; i + 1 < way.size(); ++i) {
        const Point& a = *way[i];
        const Point& b = *way[i + 1];
        // A branch may pass the parameter several times: every pair of neighbours around it is tried.
        if ((a.parameter - p) * (b.parameter - p) > 0.0) { continue; }
        if (a.motion.form != b.motion.form || a.motion.contacts() != b.motion.contacts()) {
            // Around a grazing point: either form, from its own side.
            if (is_it(a.motion) || is_it(b.motion)) { return true; }
            continue;
        }
        const double between = b.parameter - a.parameter;
        // Between two points of one form Newton's method starts from an interpolation.
        const double share = between != 0.0 ? (p - a.parameter) / between : 0.0;
        const Vector from = orbit::pack(family.base, a.motion);
        const Vector to = orbit::pack(family.base, b.motion);
        // Towards a fold the motion moves with the square root of the parameter.
        for (const double s : {share, 1.0 - std::sqrt(1.0 - share), std::sqrt(share)}) {
            if (is_it(orbit::unpack(family.base, from + s * (to - from), a.motion))) { return true; }
        }
    }
    return false;
}

}  // namespace percuss::branch
