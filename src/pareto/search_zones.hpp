#pragma once
/// \file
/// Where, beside known points, a front of three objectives may still have others.

#include "numerics/linear.hpp"

#include <vector>

namespace percuss::pareto {

using numerics::Vector;

/// All points y < upper that no known point dominates and that are not known to be empty. Objective j of its j-th
/// defining point is upper_j.
struct SearchZone {
    Vector upper;
    std::vector<Vector> defining;
    bool closed = false;

    /// lower_j = max of objective j over the other defining points: the box [lower, upper] neither dominates a defining
    /// point nor is dominated by one.
    [[nodiscard]] Vector lower() const;
    [[nodiscard]] double volume() const { return (upper - lower()).prod(); }
};

/// Search zones as local upper bounds, kept up to date point by point (Klamroth, Lacour and Vanderpooten, Eur. J. Oper.
/// Res. 245, 2015, algorithm 3, redundancy elimination). O(zones) for each point; about two zones a point.
class SearchZones {
public:
    /// One zone: the box [0, 1]^objectives.
    explicit SearchZones(int objectives);

    void add(const Vector& point);
    /// The open zone of largest volume; null if none.
    [[nodiscard]] SearchZone* loosest();

private:
    std::vector<SearchZone> zones_;
};

}  // namespace percuss::pareto
