#include "attractor/known.hpp"

#include "orbit/polish.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace percuss::attractor {
namespace {

/// Strobe points nearer than this, in units of the box, are of one orbit: well above the scout's error, and stable
/// orbits do not come so close to one another.
constexpr double same_point = 1e-5;
/// A recurrence this many times farther than the nearest one may still be that of the true, shorter period.
constexpr double nearly_as_close = 4.0;

/// How much closer than expected on the way to a known orbit a motion must recur to be on its way elsewhere.
constexpr double clearly_closer = 0.1;

std::size_t index(int i) { return static_cast<std::size_t>(i); }

double distance(const flow::State& a, const flow::State& b, int states, const flow::State& scale) {
    double sum = 0.0;
    for (int k = 0; k < states; ++k) {
        const double d = (a[index(k)] - b[index(k)]) / scale[index(k)];
        sum += d * d;
    }
    return std::sqrt(sum);
}

}  // namespace

std::shared_ptr<const KnownOrbit> make_known(const Systems& systems, const orbit::Orbit& orbit,
                                             const flow::State& scale) {
    const orbit::Orbit standard = orbit::start_with_longest_flight(systems.exact, orbit);
    return std::make_shared<const KnownOrbit>(KnownOrbit{standard, Trap(systems.scout, standard, scale)});
}

std::optional<orbit::Orbit> stable_orbit(const flow::System& system, const flow::State& from, int period) {
    orbit::Orbit found = orbit::polish_orbit(system, from, period);
    if (!found.ok() || !(orbit::max_multiplier(found) < 1.0)) { return std::nullopt; }
    // A motion that spirals in on an orbit of period 1 nearly recurs first after 2, 3, 6, 7 or 10 cycles: the period is
    // what the polished orbit has, not what the recurrence was.
    const int minimal = orbit::minimal_period(system, found);
    if (minimal < found.map.period) {
        orbit::ReturnMap map = found.map;
        map.period = minimal;
        orbit::Orbit shorter = orbit::find_orbit(system, map, found.state);
        if (!shorter.ok() || !(orbit::max_multiplier(shorter) < 1.0)) { return std::nullopt; }
        found = std::move(shorter);
    }
    return found;
}

bool same_orbit(const KnownOrbit& a, const KnownOrbit& b) {
    // The orbits may begin at different strobe points: the first of one is compared with all of the other.
    return a.trap.period() == b.trap.period() && b.trap.distance(a.trap.points().front()) < same_point;
}

std::optional<int> find_known(const KnownOrbits& known, const KnownOrbit& orbit) {
    const auto same = [&](const auto& other) { return same_orbit(*other, orbit); };
    const auto found = std::find_if(known.begin(), known.end(), same);
    return found == known.end() ? std::nullopt : std::optional<int>(static_cast<int>(found - known.begin()));
}

std::vector<int> merge_into(KnownOrbits& known, const KnownOrbits& more) {
    std::vector<int> numbers;
    for (const auto& orbit : more) {
        auto number = find_known(known, *orbit);
        if (!number) {
            number = static_cast<int>(known.size());
            known.push_back(orbit);
        }
        numbers.push_back(*number);
    }
    return numbers;
}

bool is_news(const KnownOrbits& known, const Recurrence& recurrence, const flow::State& z) {
    return std::all_of(known.begin(), known.end(), [&](const auto& orbit) {
        // With a multiplier of 1 within rounding the bound would be zero or negative and no recurrence news.
        const double lag = std::max(1.0 - orbit->trap.max_multiplier(), 1e-6);
        return recurrence.distance < clearly_closer * lag * orbit->trap.distance(z);
    });
}

Recurrence recurrence(std::span<const flow::State> history, int states, const flow::State& scale, int shortest,
                      int longest) {
    const int available = static_cast<int>(history.size()) - 2;
    longest = std::min(longest, available);
    if (longest < shortest) { return {}; }
    std::vector<double> distances;
    const flow::State& now = history[history.size() - 1];
    // Two consecutive states each: a chaotic motion comes close to one of its own states by chance more often than it
    // then stays close.
    const flow::State& before = history[history.size() - 2];
    for (int n = shortest; n <= longest; ++n) {
        const std::size_t back = history.size() - 1 - index(n);
        distances.push_back(
            std::max(distance(now, history[back], states, scale), distance(before, history[back - 1], states, scale)));
    }
    const double nearest = *std::min_element(distances.begin(), distances.end());
    const auto first =
        std::find_if(distances.begin(), distances.end(), [&](double d) { return d <= nearly_as_close * nearest; });
    if (first == distances.end()) { return {}; }  // NaN
    return {shortest + static_cast<int>(first - distances.begin()), *first};
}

bool is_creeping(const KnownOrbits& known, std::span<const flow::State> history, int states, const flow::State& scale) {
    // 12: as while following (FollowOptions). Moving by more than 1e-3 of the scale in a period, a motion does not
    // creep. Four windows: that three in a row are each nearer than the one before is unlikely by chance.
    constexpr int longest = 12;
    constexpr double slow = 1e-3;
    constexpr std::size_t windows = 4;
    const Recurrence r = recurrence(history, states, scale, 1, longest);
    if (r.period == 0 || !(r.distance < slow) || is_news(known, r, history.back())) { return false; }
    const std::size_t length = history.size() / windows;
    return std::any_of(known.begin(), known.end(), [&](const auto& orbit) {
        double before = std::numeric_limits<double>::infinity();
        for (std::size_t window = 0; window < windows; ++window) {
            double furthest = 0.0;
            for (std::size_t i = window * length; i < (window + 1) * length; ++i) {
                furthest = std::max(furthest, orbit->trap.distance(history[i]));
            }
            if (!(furthest < before)) { return false; }
            before = furthest;
        }
        return true;
    });
}

}  // namespace percuss::attractor
