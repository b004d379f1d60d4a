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
            if (mu.real() < best.real()) { best = mu; }
        } else if (mu.imag() > 0.0 && std::abs(std::abs(mu) - 1.0) < distance) {
            distance = std::abs(std::abs(mu) - 1.0);
            best = mu;
        }
    }
    return best;
}

double test_value(const Standing& at, Kind kind) {
    switch (kind) {
        case Kind::fold: return at.slope / lowest_speed(at.point.motion);
        case Kind::flip: return 1.0 + leading(at.point, kind).real();
        default: return std::abs(leading(at.point, kind)) - 1.0;
    }
}

/// Where a point lies between two others: share of the way, distance from the straight line in units of its length.
struct Place {
    double share = 0.0;
    double aside = 0.0;
    [[nodiscard]] bool between() const { return share > -0.1 && share < 1.1 && aside < 0.5; }
};

Place place_of(const Vector& u, const Vector& a, const Vector& b) {
    const Vector chord = b - a;
    const double length = chord.norm();
    Place place;
    place.share = chord.dot(u - a) / (length * length);
    place.aside = (u - a - place.share * chord).norm() / length;
    return place;
}

}  // namespace

double lowest_speed(const orbit::Motion& motion) {
    if (motion.form != orbit::Form::sequence) { return 1.0; }
    double lowest = 1e300;
    for (const auto& contact : motion.sequence.contacts) { lowest = std::min(lowest, std::abs(contact.speed)); }
    return lowest;
}

std::vector<Kind> boundaries_between(const Standing& a, const Standing& b) {
    std::vector<Kind> kinds;
    const bool fold = a.slope * b.slope < 0.0;
    const bool flip = (a.point.beyond_minus + b.point.beyond_minus) % 2 != 0;
    if (fold) { kinds.push_back(Kind::fold); }
    if (flip) { kinds.push_back(Kind::flip); }
    const int change = b.point.unstable_dimension() - a.point.unstable_dimension();
    const bool pair_crossed = std::abs(b.point.pairs_beyond - a.point.pairs_beyond) == 1 && std::abs(change) >= 1 &&
                              (std::abs(change) == 2) == (fold == flip);
    if (pair_crossed) { kinds.push_back(Kind::torus); }
    return kinds;
}

BoundaryPoint locate(const flow::Family& family, Piece& piece, Kind kind, const Standing& a, const Standing& b,
                     double size, long& solves) {
    BoundaryPoint found;
    found.kind = kind;
    found.of_half_cycle = kind == Kind::flip && b.point.motion.mirrored;
    Standing low = a;
    Standing high = b;
    double behind = 0.0;  // distance of `high` back along the piece
    for (int halving = 0; halving < 12; ++halving) {
        const double f_low = test_value(low, kind);
        const double f_high = test_value(high, kind);
        double share = f_low / (f_low - f_high);
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
                found.uncertainty = 1e-12 * std::abs(critical.parameter) + critical.residual * 1e-10;
                return found;
            }
        }
        const double half = 0.5 * (high.u - low.u).norm();
        const auto middle = piece.probe(-(behind + half));
        if (!middle) { break; }
        ++solves;
        Look seen = look(family, middle->motion, middle->parameter);
        if (!seen.ok()) { break; }
        Standing at{piece.scaled(middle->motion, middle->parameter), middle->slope, std::move(seen.point)};
        const auto kinds = boundaries_between(low, at);
        if (std::find(kinds.begin(), kinds.end(), kind) != kinds.end()) {
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

}  // namespace percuss::branch
