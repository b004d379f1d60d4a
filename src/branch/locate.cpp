#include "branch/locate.hpp"

#include "boundary/critical.hpp"

#include <algorithm>
#include <cmath>

namespace percuss::branch {
namespace {

using boundary::Kind;
using numerics::Vector;

/// The multiplier that the kind is about: real and nearest -1 from below or above; of a pair, nearest the circle.
std::complex<double> leading(const Point& point, Kind kind) {
    std::complex<double> best = kind == Kind::flip ? 1.0 : 0.0;
    double distance = 1e300;
    for (const auto& mu : point.map_multipliers) {
        if (kind == Kind::flip) {
            // The one furthest to the left is the one that crosses -1, unless two do in one step.
            if (mu.real() < best.real()) { best = mu; }
        } else if (mu.imag() > 0.0 && std::abs(std::abs(mu) - 1.0) < distance) {
            distance = std::abs(std::abs(mu) - 1.0);
            best = mu;
        }
    }
    return best;
}

/// A function that changes sign at the boundary. It places the first guess of a Newton's method and nothing else:
/// whether there is a boundary is told by counting multipliers, see lies_between(). The slope of a sequence vanishes at
/// grazing as its speed does; divided by it only the fold is left.
double test_value(const CurvePoint& at, Kind kind) {
    switch (kind) {
        case Kind::fold: return at.slope / lowest_speed(at.point.motion);
        case Kind::flip: return 1.0 + leading(at.point, kind).real();
        default: return std::abs(leading(at.point, kind)) - 1.0;
    }
}

/// Multipliers beyond the circle without the one that makes the boundary.
int unstable_besides(const CurvePoint& at) {
    // At a fold or flip rounding decides on which side of the circle its own multiplier lies: it is left out.
    if (at.on == Kind::none) { return at.point.unstable_dimension(); }
    const double critical = at.on == Kind::fold ? 1.0 : -1.0;
    const auto& all = at.point.map_multipliers;
    Eigen::Index skipped = 0;
    (all.array() - critical).abs().minCoeff(&skipped);
    int count = 0;
    for (Eigen::Index i = 0; i < all.size(); ++i) { count += i != skipped && std::abs(all[i]) > 1.0 ? 1 : 0; }
    return count;
}

}  // namespace

Place place_of(const Vector& u, const Vector& a, const Vector& b) {
    const Vector chord = b - a;
    const double length = chord.norm();
    Place place;
    place.share = chord.dot(u - a) / (length * length);
    place.aside = (u - a - place.share * chord).norm() / length;
    return place;
}

double lowest_speed(const orbit::Motion& motion) {
    if (motion.form != orbit::Form::sequence) { return 1.0; }
    double lowest = 1e300;
    for (const auto& contact : motion.sequence.contacts) { lowest = std::min(lowest, std::abs(contact.speed)); }
    return lowest;
}

bool lies_between(Kind kind, const CurvePoint& a, const CurvePoint& b) {
    switch (kind) {
        case Kind::fold: return a.slope * b.slope < 0.0;
        // An even number of them would go unnoticed, as would an even number of folds; steps that turn by 7 degrees
        // pass over one at a time as a rule.
        case Kind::flip: return (a.point.beyond_minus + b.point.beyond_minus) % 2 != 0;
        default: break;
    }
    // Without damping no pair can cross the circle alone.
    if (a.point.neutral && b.point.neutral) { return false; }
    const int change = unstable_besides(b) - unstable_besides(a);
    // A change by one is a fold or flip; a pair changes the count by two.
    if (a.on == Kind::none && b.on == Kind::none) { return std::abs(change) > 1; }
    // On a fold or flip the multiplier that makes it may count or not.
    return change < (b.on == Kind::none ? 0 : -1) || change > (a.on == Kind::none ? 0 : 1);
}

namespace {

/// Refines one boundary by Newton's method on the extended system, from an interpolation of its test function; when the
/// result does not lie between the two points, the bracket is halved along the piece and tried again. behind: distance
/// of b back along the piece from where it stands.
BoundaryPoint locate(const flow::ParameterFamily& family, Piece& piece, Kind kind, const CurvePoint& a,
                     const CurvePoint& b, double behind, double size, long& solves) {
    BoundaryPoint found;
    found.kind = kind;
    found.of_half_cycle = kind == Kind::flip && b.point.motion.mirrored;
    CurvePoint low = a;
    CurvePoint high = b;
    // Twelve halvings take the longest step, 0.25, to 6e-5: where Newton's method has not found the boundary from as
    // near, something besides disturbs it (a corner, another boundary), and the bracket is the answer. Of 60 random
    // designs five were left with a bracket (2e-9 to 1e-7) for a torus or flip beside a grazing point, one with 0.037
    // for a flip.
    for (int halving = 0; halving < 12; ++halving) {
        const double f_low = test_value(low, kind);
        const double f_high = test_value(high, kind);
        double share = f_low / (f_low - f_high);
        // The leading multipliers of both ends may be different ones, so that the values do not bracket zero.
        if (!(share > 0.0 && share < 1.0)) { share = 0.5; }
        const Vector guess = low.u + share * (high.u - low.u);
        const double angle = std::arg(leading(high.point, kind));
        const auto critical =
            boundary::solve_critical(family, kind, piece.motion_of(guess), piece.parameter_of(guess), 0, angle, size);
        ++solves;
        if (critical.ok()) {
            const Vector u = piece.scaled(critical.motion, critical.parameter);
            Look seen = look(family, critical.motion, critical.parameter);
            if (place_of(u, low.u, high.u).between() && seen.ok()) {
                found.point = std::move(seen.point);
                found.angle = critical.angle;
                // Set, not measured: Newton's method ends with a step below 1e-10 in scaled unknowns.
                found.uncertainty = 1e-12 * std::abs(critical.parameter) + critical.residual * 1e-10;
                return found;
            }
        }
        // Halved by arclength: near a fold there are two points at one parameter.
        const double half = 0.5 * (high.u - low.u).norm();
        const auto middle = piece.probe(-(behind + half));
        if (!middle) { break; }
        ++solves;
        Look seen = look(family, middle->motion, middle->parameter);
        if (!seen.ok()) { break; }
        CurvePoint at{piece.scaled(middle->motion, middle->parameter), middle->slope, std::move(seen.point)};
        if (lies_between(kind, low, at)) {
            behind += half;
            high = std::move(at);
        } else {
            low = std::move(at);
        }
    }
    found.point = high.point;
    found.uncertainty = std::abs(high.point.parameter - low.point.parameter);
    return found;
}

}  // namespace

std::vector<BoundaryPoint> boundaries_between(const flow::ParameterFamily& family, Piece& piece, const CurvePoint& a,
                                              const CurvePoint& b, double size, long& solves) {
    struct Found {
        BoundaryPoint boundary;
        CurvePoint at;
    };
    const auto behind = [&](const CurvePoint& at) { return (piece.point() - at.u).norm(); };
    std::vector<Found> found;
    // Folds and flips first: a torus point is what the count of multipliers still lacks between them.
    for (const Kind kind : {Kind::fold, Kind::flip}) {
        if (!lies_between(kind, a, b)) { continue; }
        BoundaryPoint boundary = locate(family, piece, kind, a, b, behind(b), size, solves);
        // Its slope is not asked for: only torus points are looked for from here to its neighbours.
        CurvePoint at{piece.scaled(boundary.point.motion, boundary.point.parameter), 0.0, boundary.point, kind};
        found.push_back({std::move(boundary), std::move(at)});
    }
    std::sort(found.begin(), found.end(), [&](const Found& x, const Found& y) {
        return place_of(x.at.u, a.u, b.u).share < place_of(y.at.u, a.u, b.u).share;
    });
    std::vector<BoundaryPoint> all;
    const CurvePoint* before = &a;
    for (std::size_t i = 0; i <= found.size(); ++i) {
        const CurvePoint& next = i < found.size() ? found[i].at : b;
        if (lies_between(Kind::torus, *before, next)) {
            all.push_back(locate(family, piece, Kind::torus, *before, next, behind(next), size, solves));
        }
        if (i < found.size()) { all.push_back(std::move(found[i].boundary)); }
        before = &next;
    }
    return all;
}

}  // namespace percuss::branch
