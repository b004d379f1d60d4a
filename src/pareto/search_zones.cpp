#include "pareto/search_zones.hpp"

#include <algorithm>
#include <utility>

namespace percuss::pareto {

Vector SearchZone::lower() const {
    Vector lower = Vector::Zero(upper.size());
    for (Eigen::Index j = 0; j < upper.size(); ++j) {
        for (std::size_t i = 0; i < defining.size(); ++i) {
            if (static_cast<Eigen::Index>(i) != j) lower[j] = std::max(lower[j], defining[i][j]);
        }
    }
    return lower.cwiseMin(upper);
}

SearchZones::SearchZones(int objectives) {
    SearchZone all{Vector::Ones(objectives), {}};
    for (int j = 0; j < objectives; ++j) all.defining.push_back(Vector::Unit(objectives, j));
    zones_.push_back(std::move(all));
}

void SearchZones::add(const Vector& point) {
    std::vector<SearchZone> next;
    for (SearchZone& zone : zones_) {
        if (!(point.array() < zone.upper.array()).all()) {
            next.push_back(std::move(zone));
            continue;
        }
        const Vector lower = zone.lower();
        for (Eigen::Index j = 0; j < point.size(); ++j) {
            if (!(point[j] > lower[j])) continue;  // covered by the zone of a neighbour
            SearchZone part = zone;
            part.upper[j] = point[j];
            part.defining[static_cast<std::size_t>(j)] = point;
            part.closed = false;
            next.push_back(std::move(part));
        }
    }
    zones_ = std::move(next);
}

SearchZone* SearchZones::loosest() {
    SearchZone* loosest = nullptr;
    double largest = 0.0;
    for (SearchZone& zone : zones_) {
        if (zone.closed || zone.volume() <= largest) continue;
        largest = zone.volume();
        loosest = &zone;
    }
    return loosest;
}

}  // namespace percuss::pareto
