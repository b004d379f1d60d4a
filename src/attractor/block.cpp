#include "attractor/block.hpp"

#include "attractor/box.hpp"
#include "attractor/counted_systems.hpp"

#include <algorithm>
#include <limits>
#include <numbers>
#include <utility>

namespace percuss::attractor {
namespace {

using std::numbers::pi;

/// Newton's method is tried at these cycles and then each half as many cycles later.
/// Evenly at first, as most motions settle soon and an orbit found early captures all the others; then ever more
/// rarely, as what has not settled by then does so slowly and each look costs Newton steps.
constexpr int first_look = 16;
constexpr int evenly_until = 64;
/// Near a fold or flip the distance shrinks by the multiplier each cycle and no faster: at 0.997 it takes 3000 cycles
/// to fall to 1e-4 of itself. Four thousand are enough there; closer to 1 a start may stay unclassified.
constexpr int more_for_creeping = 4;
/// Recurrences farther than this, in units of the box, are not worth a try.
constexpr double near_recurrence = 1e-2;
/// After a failure a start must recur this much closer before it is tried again.
constexpr double closer_again = 0.25;
/// Failures allowed at one look: chaos recurs often, and the most settled motions come first.
constexpr int failures_per_look = 6;

std::size_t index(int i) { return static_cast<std::size_t>(i); }

/// Cycle of the next try of Newton's method: 16, 32, 48, 64, 96, 144, 216, ...
int next_look(int cycle) { return cycle < evenly_until ? cycle + first_look : cycle + cycle / 2; }

class BlockFollower {
public:
    BlockFollower(const Systems& systems, const Box& box, std::span<const flow::State> starts, const KnownOrbits& known,
                  const FollowOptions& options)
        : counted_(systems),
          options_(options),
          scale_(distance_scale(systems.exact, box)),
          known_before_(known.size()),
          known_(known) {
        for (const auto& orbit : known_) { traps_.push_back(&orbit->trap); }
        result_.followers.resize(starts.size());
        tracks_.resize(starts.size());
        for (std::size_t i = 0; i < starts.size(); ++i) {
            live_.push_back(i);
            states_.push_back(starts[i]);
            tracks_[i].history.push_back(starts[i]);
        }
    }

    BlockResult follow() {
        int look = first_look;
        int cycle = 0;
        while (!live_.empty() && cycle < more_for_creeping * options_.max_cycles) {
            advance();
            if (cut_short()) { break; }
            ++cycle;
            // Once per memory: is_creeping() is asked of strobed states that it has not seen yet.
            if (cycle >= options_.max_cycles && (cycle - options_.max_cycles) % options_.memory == 0) { retire(); }
            if (cycle < look) { continue; }
            search();
            if (cut_short()) { break; }
            if (options_.end_at_new && known_.size() > known_before_) { break; }
            look = next_look(cycle);
        }
        return finish();
    }

private:
    struct Track {
        std::vector<flow::State> history;  ///< up to twice the memory, the oldest half dropped when full
        Watch watch;
        double tried = std::numeric_limits<double>::infinity();  ///< recurrence distance of the last failure
    };
    struct Candidate {
        Recurrence recurrence;
        std::size_t start = 0;
    };

    /// Whether the limits end the block: what failed since then failed because of them and says nothing of a motion.
    bool cut_short() {
        result_.limit = counted_.cost.allowance();
        return result_.limit != flow::Status::ok;
    }

    /// One cycle of all live starts; captured and failed ones leave.
    void advance() {
        flow::EnsembleRequest request;
        request.states = states_;
        request.duration = 2.0 * pi;
        request.max_events = most_contact_events;
        members_.assign(states_.size(), {});
        counted_.scout.run_ensemble(request, members_);
        std::size_t kept = 0;
        for (std::size_t slot = 0; slot < live_.size(); ++slot) {
            const std::size_t i = live_[slot];
            Follower& follower = result_.followers[i];
            take(members_[slot], follower, tracks_[i]);
            if (follower.fate != Fate::pending) { continue; }
            live_[kept] = i;
            states_[kept] = members_[slot].state;
            ++kept;
        }
        live_.resize(kept);
        states_.resize(kept);
    }

    void take(const flow::EnsembleMember& member, Follower& follower, Track& track) const {
        if (member.status != flow::Status::ok) {
            follower.fate = Fate::failed;
            return;
        }
        if (const auto trap = track.watch.see(member.state, traps_)) {
            follower.fate = Fate::captured;
            follower.orbit = *trap;
            return;
        }
        auto& history = track.history;
        const std::size_t memory = index(options_.memory);
        // Half is dropped at once, so that a state is moved once on average and not at every strobe.
        if (history.size() >= 2 * memory) {
            history.erase(history.begin(), history.end() - static_cast<std::ptrdiff_t>(memory));
        }
        history.push_back(member.state);
    }

    /// Newton's method on the motions that nearly recur, the most settled ones first.
    void search() {
        std::vector<Candidate> candidates;
        for (const std::size_t i : live_) {
            const Recurrence r =
                recurrence(tracks_[i].history, counted_.scout.states(), scale_, 1, options_.longest_period);
            if (r.period > 0 && r.distance < near_recurrence) { candidates.push_back({r, i}); }
        }
        std::stable_sort(candidates.begin(), candidates.end(), [](const Candidate& a, const Candidate& b) {
            return a.recurrence.distance < b.recurrence.distance;
        });
        int failures = 0;
        for (const Candidate& candidate : candidates) {
            if (failures >= failures_per_look) { return; }
            Track& track = tracks_[candidate.start];
            const Recurrence& recurrence = candidate.recurrence;
            // Nothing is tried that settles on an orbit which is already known: capture will tell, for less.
            const bool is_worth_it =
                recurrence.distance <= closer_again * track.tried && is_news(known_, recurrence, track.history.back());
            if (!is_worth_it) { continue; }
            if (!learn_from(track.history.back(), recurrence.period)) {
                track.tried = recurrence.distance;
                ++failures;
            }
        }
    }

    bool learn_from(const flow::State& z, int period) {
        const auto orbit = stable_orbit(counted_.exact, z, period);
        if (!orbit) { return false; }
        auto learnt = make_known(counted_.systems, *orbit, scale_);
        // Counted as a failure: the motion is on its way to a known orbit, and Newton's method jumped ahead.
        if (find_known(known_, *learnt)) { return false; }
        known_.push_back(std::move(learnt));
        traps_.push_back(&known_.back()->trap);
        return true;
    }

    /// The budget is over for starts that do not creep towards a known orbit.
    void retire() {
        std::size_t kept = 0;
        for (std::size_t slot = 0; slot < live_.size(); ++slot) {
            const std::size_t i = live_[slot];
            if (!is_creeping(known_, recent(i), counted_.scout.states(), scale_)) {
                leave_unsettled(i);
                continue;
            }
            live_[kept] = i;
            states_[kept] = states_[slot];
            ++kept;
        }
        live_.resize(kept);
        states_.resize(kept);
    }

    [[nodiscard]] std::span<const flow::State> recent(std::size_t i) const {
        const auto& history = tracks_[i].history;
        return std::span(history).last(std::min(history.size(), index(options_.memory)));
    }

    void leave_unsettled(std::size_t i) {
        const auto history = recent(i);
        result_.followers[i].fate = Fate::unsettled;
        result_.followers[i].history.assign(history.begin(), history.end());
    }

    BlockResult finish() {
        for (const std::size_t i : live_) { leave_unsettled(i); }
        result_.found.assign(known_.begin() + static_cast<std::ptrdiff_t>(known_before_), known_.end());
        result_.cycles = counted_.cost.periods();
        result_.steps = counted_.cost.steps;
        return std::move(result_);
    }

    CountedSystems counted_;
    const FollowOptions& options_;
    flow::State scale_;
    std::size_t known_before_;
    KnownOrbits known_;  ///< before, then found
    std::vector<const Trap*> traps_;
    BlockResult result_;
    std::vector<Track> tracks_;        ///< of every start
    std::vector<std::size_t> live_;    ///< starts still followed,
    std::vector<flow::State> states_;  ///< and where they are
    std::vector<flow::EnsembleMember> members_;
};

}  // namespace

BlockResult follow_block(const Systems& systems, const Box& box, std::span<const flow::State> starts,
                         const KnownOrbits& known, const FollowOptions& options) {
    return BlockFollower(systems, box, starts, known, options).follow();
}

}  // namespace percuss::attractor
