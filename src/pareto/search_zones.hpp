#pragma once
/// \file
/// Where, beside known points, a front of three objectives may still have others.

#include "numerics/linear.hpp"

#include <vector>

namespace percuss::pareto {

using numerics::Vector;

/// All points y < upper that no known point dominates. Objective j of its j-th defining point is upper_j.
struct SearchZone {
    Vector upper;
    std::vector<Vector> defining;
    double open = 0.0;    ///< at least the volume in which the front may still pass
    bool closed = false;  ///< given up

    /// The smallest of each objective over the defining points: the front that they enclose is about on the way from
    /// the upper to this corner.
    [[nodiscard]] Vector lower() const;
};

/// Search zones as local upper bounds, kept up to date point by point (Klamroth, Lacour and Vanderpooten, Eur. J. Oper.
/// Res. 245, 2015, algorithm 3, redundancy elimination). O(zones) for each point; about two zones a point.
class SearchZones {
public:
    /// One zone: the box [0, 1]^objectives.
    explicit SearchZones(int objectives);

    void add(const Vector& point);
    /// Of the zones that are not closed, the one in which most is open: the volume of the box [0, upper] without the
    /// boxes [0, p] of the known points, which nothing can reach. Null if none. It can only fall when points are added,
    /// so old values are bounds, and only the largest need be brought up to date.
    [[nodiscard]] SearchZone* loosest();

private:
    [[nodiscard]] double open_volume(const Vector& upper) const;

    std::vector<Vector> points_;
    std::vector<SearchZone> zones_;
};

}  // namespace percuss::pareto
