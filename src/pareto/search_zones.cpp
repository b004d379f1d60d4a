#include "pareto/search_zones.hpp"

#include "pareto/hypervolume.hpp"

#include <algorithm>
#include <utility>

namespace percuss::pareto {

Vector SearchZone::lower() const {
    Vector lower = upper;
    for (const Vector& point : defining) lower = lower.cwiseMin(point);
    return lower;
}

SearchZones::SearchZones(int objectives) {
    SearchZone all{Vector::Ones(objectives), {}, 1.0};
    for (int j = 0; j < objectives; ++j) all.defining.push_back(Vector::Unit(objectives, j));
    zones_.push_back(std::move(all));
}

void SearchZones::add(const Vector& point) {
    points_.push_back(point);
    std::vector<SearchZone> next;
    for (SearchZone& zone : zones_) {
        if (!(point.array() < zone.upper.array()).all()) {
            next.push_back(std::move(zone));
            continue;
        }
        for (Eigen::Index j = 0; j < point.size(); ++j) {
            bool redundant = false;  // covered by the zone of a neighbour
            for (Eigen::Index i = 0; i < point.size(); ++i) {
                redundant = redundant || (i != j && zone.defining[static_cast<std::size_t>(i)][j] >= point[j]);
            }
            if (redundant) continue;
            SearchZone part = zone;
            part.upper[j] = point[j];
            part.defining[static_cast<std::size_t>(j)] = point;
            part.closed = false;
            next.push_back(std::move(part));
        }
    }
    zones_ = std::move(next);
}

double SearchZones::open_volume(const Vector& upper) const {
    std::vector<Vector> mirrored;
    for (const Vector& point : points_) mirrored.push_back(-point.cwiseMax(0.0).cwiseMin(upper));
    return upper.prod() - hypervolume(mirrored, Vector::Zero(upper.size()));
}

SearchZone* SearchZones::loosest() {
    while (true) {
        SearchZone* loosest = nullptr;
        for (SearchZone& zone : zones_) {
            if (!zone.closed && zone.open > 0 && (loosest == nullptr || zone.open > loosest->open)) loosest = &zone;
        }
        if (loosest == nullptr) return nullptr;
        const double now = open_volume(loosest->upper);
        const bool up_to_date = now >= 0.999 * loosest->open;
        loosest->open = now > 1e-12 ? std::min(now, loosest->open) : 0.0;  // below that it is rounding
        if (up_to_date) return loosest;
    }
}

}  // namespace percuss::pareto
