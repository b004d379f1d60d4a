#include "branch/branch.hpp"

#include <algorithm>

namespace percuss::branch {

std::string_view to_string(End end) {
    switch (end) {
        case End::not_run: return "not run";
        case End::range: return "range";
        case End::joined: return "joined";
        case End::closed: return "closed";
        case End::lost: return "lost";
        case End::budget: return "budget";
    }
    return "not run";
}

bool Branch::neutral() const {
    return !points.empty() &&
           std::all_of(points.begin(), points.end(), [](const Point& point) { return point.neutral; });
}

}  // namespace percuss::branch
