#include "attractor/leftovers.hpp"

namespace percuss::attractor {
namespace {

/// A long period is believed only when the motion recurs as nearly as this, in units of the box: the more periods are
/// compared, the nearer a chaotic motion recurs to one of them by chance, and a try costs Newton steps over all of it.
constexpr double long_recurrence = 1e-3;
/// Shorter histories say little about where a motion goes.
constexpr std::size_t shortest_history = 32;

std::vector<const Trap*> traps_of(const KnownOrbits& known) {
    std::vector<const Trap*> traps;
    for (const auto& orbit : known) { traps.push_back(&orbit->trap); }
    return traps;
}

}  // namespace

LeftoverJudge::Verdict LeftoverJudge::judge(const std::vector<flow::State>& history) {
    if (const auto orbit = settling_on(history)) { return {*orbit, -1}; }
    if (const auto orbit = long_period(history)) { return {*orbit, -1}; }
    if (history.size() < shortest_history) { return {}; }
    if (is_creeping(known_, history, systems_.exact.states(), scale_)) { return {}; }
    if (const auto verdict = on_a_path(history)) { return *verdict; }
    return follow_on(history);
}

std::optional<int> LeftoverJudge::settling_on(const std::vector<flow::State>& history) const {
    // The orbit may have become known after the start had come near it: its last strobes are watched again.
    const auto traps = traps_of(known_);
    Watch watch;
    for (const flow::State& z : history) {
        if (const auto trap = watch.see(z, traps)) { return trap; }
    }
    return std::nullopt;
}

std::optional<int> LeftoverJudge::long_period(const std::vector<flow::State>& history) {
    const Recurrence r = recurrence(history, systems_.exact.states(), scale_, 1, options_.longest_period);
    if (r.period == 0 || !(r.distance < long_recurrence) || !is_news(known_, r, history.back())) {
        return std::nullopt;
    }
    const auto orbit = stable_orbit(systems_.exact, history.back(), r.period);
    if (!orbit) { return std::nullopt; }
    auto learnt = make_known(systems_, *orbit, scale_);
    if (!find_known(known_, *learnt)) { known_.push_back(std::move(learnt)); }
    // Newton's method may have jumped to an orbit that the motion is not on its way to: only capture counts.
    return settling_on(history);
}

std::optional<LeftoverJudge::Verdict> LeftoverJudge::on_a_path(const std::vector<flow::State>& strobes) const {
    for (const Path& path : paths_) {
        if (path.cloud.holds(strobes)) { return path.verdict; }
    }
    return std::nullopt;
}

LeftoverJudge::Verdict LeftoverJudge::follow_on(const std::vector<flow::State>& history) {
    // A run is 4160 cycles by default, where a start that is captured takes a few dozen: unlimited, a set that is not
    // recognised again would cost far more than the ensemble.
    if (runs_ >= options_.most_runs) { return {}; }
    ++runs_;
    const auto traps = traps_of(known_);
    Watch watch;
    std::optional<int> captured;
    const auto leave = [&](const flow::State& z) {
        captured = watch.see(z, traps);
        return captured.has_value();
    };
    const Wander seen = wander(systems_.exact, history.back(), options_.exponent, leave);
    if (captured) { return {*captured, -1}; }  // where others like it go is not known: transients may be chaotic
    return recognise(seen);
}

LeftoverJudge::Verdict LeftoverJudge::recognise(const Wander& seen) {
    if (seen.status != WanderStatus::ok) { return {}; }
    if (const auto verdict = on_a_path(seen.strobes)) { return *verdict; }
    const auto motion = measure(seen);
    if (!motion) { return {}; }
    const Verdict verdict{-1, static_cast<int>(aperiodic_.size())};
    aperiodic_.push_back(*motion);
    paths_.push_back({Cloud(seen.strobes, scale_, systems_.exact.states()), verdict});
    return verdict;
}

}  // namespace percuss::attractor
