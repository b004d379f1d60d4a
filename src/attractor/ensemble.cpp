#include "attractor/ensemble.hpp"

#include "attractor/counted_systems.hpp"

#include <algorithm>
#include <atomic>
#include <exception>
#include <mutex>
#include <numeric>
#include <stdexcept>
#include <string>
#include <thread>

namespace percuss::attractor {
namespace {

using Starts = std::vector<flow::State>;

std::size_t index(long i) { return static_cast<std::size_t>(i); }

void check(const Systems& systems, const Box& box, const EnsembleOptions& options,
           std::span<const orbit::Orbit> given) {
    validate(box, systems.exact.states());
    const auto require = [](bool good, const char* name, long value, const char* allowed) {
        if (!good) {
            throw std::invalid_argument(std::string("ensemble: ") + name + " = " + std::to_string(value) +
                                        ": allowed is " + allowed);
        }
    };
    require(options.starts >= 1, "starts", options.starts, "at least 1");
    require(options.jobs >= 1, "jobs", options.jobs, "at least 1");
    require(options.max_cycles >= 1, "max_cycles", options.max_cycles, "at least 1");
    require(options.longest_period >= 1, "longest_period", options.longest_period, "at least 1");
    for (const orbit::Orbit& orbit : given) {
        if (!orbit.ok() || !(orbit::max_multiplier(orbit) < 1.0)) {
            throw std::invalid_argument("ensemble: an orbit given as known must be converged and stable");
        }
    }
}

/// Runs work(0), ..., work(count - 1) on some threads, each number once; rethrows the first exception.
template <class Work>
void in_parallel(long count, int jobs, const Work& work) {
    std::atomic<long> next{0};
    std::exception_ptr failure;
    std::mutex guard;
    const auto worker = [&] {
        try {
            for (long i = next++; i < count; i = next++) { work(i); }
        } catch (...) {
            const std::lock_guard lock(guard);
            if (!failure) { failure = std::current_exception(); }
            // No work is begun behind a failure.
            next = count;
        }
    };
    std::vector<std::thread> threads;
    for (long t = 1; t < std::min<long>(jobs, count); ++t) { threads.emplace_back(worker); }
    worker();
    for (std::thread& thread : threads) { thread.join(); }
    if (failure) { std::rethrow_exception(failure); }
}

long step_budget_of(const Systems& systems) {
    return systems.exact.cost != nullptr ? systems.exact.cost->step_budget : flow::Cost{}.step_budget;
}

/// The blocks of an ensemble.
class Blocks {
public:
    Blocks(const Systems& systems, const Box& box, const EnsembleOptions& options, bool end_at_new)
        : systems_(systems),
          box_(box),
          options_(options) {
        follow_.max_cycles = options.max_cycles;
        follow_.longest_period = options.longest_period;
        follow_.end_at_new = end_at_new;
    }

    [[nodiscard]] long count() const { return (options_.starts + block_size - 1) / block_size; }
    [[nodiscard]] long size(long block) const { return std::min<long>(block_size, options_.starts - first(block)); }
    [[nodiscard]] static long first(long block) { return block * block_size; }

    /// Blocks are begun in their order: when those that have ended have spent the budget, so have those before this
    /// one.
    /// Once a limit is met the blocks that are left are not even set up: of ten million starts there are 156,250, and
    /// setting them up took 6 s after the time was over.
    BlockResult follow(long block, const KnownOrbits& known) {
        const bool cancelled = is_cancelled();
        if (cancelled || steps_ > budget()) {
            BlockResult none;
            none.limit = cancelled ? flow::Status::cancelled : flow::Status::budget_spent;
            return none;
        }
        Starts starts;
        for (long i = first(block); i < first(block) + size(block); ++i) {
            starts.push_back(start_state(box_, systems_.exact.states(), options_.seed, i));
        }
        BlockResult result = follow_block(systems_, box_, starts, known, follow_);
        steps_ += result.steps;
        if (options_.on_progress) {
            const std::lock_guard lock(guard_);
            options_.on_progress(static_cast<double>(++done_) / static_cast<double>(count()));
        }
        return result;
    }

private:
    [[nodiscard]] long budget() const { return step_budget_of(systems_); }
    [[nodiscard]] bool is_cancelled() const {
        const flow::Cost* cost = systems_.exact.cost;
        return cost != nullptr && cost->cancelled && cost->cancelled();
    }

    const Systems& systems_;
    const Box& box_;
    const EnsembleOptions& options_;
    FollowOptions follow_;
    std::atomic<long> steps_ = 0;
    std::mutex guard_;
    long done_ = 0;
};

/// What ends an ensemble before its last block, with any number of threads after the same one: a limit that cut a block
/// short, or the budget spent by the blocks up to one.
class Limits {
public:
    explicit Limits(const Systems& systems) : budget_(step_budget_of(systems)) {}

    /// The next block in order; true once a limit is met.
    bool met_by(const BlockResult& block) { return met_by(block.limit, block.steps); }
    bool met_by(flow::Status limit, long steps) {
        steps_ += steps;
        if (status_ == flow::Status::ok) { status_ = limit; }
        if (status_ == flow::Status::ok && steps_ > budget_) { status_ = flow::Status::budget_spent; }
        return status_ != flow::Status::ok;
    }
    template <class Outcome>
    [[nodiscard]] Outcome status() const {
        return status_ == flow::Status::cancelled ? Outcome::cancelled : Outcome::budget_spent;
    }

private:
    long budget_;
    long steps_ = 0;
    flow::Status status_ = flow::Status::ok;
};

/// Numbers of a block's orbits (those known before it, then those found) in the list of all.
std::vector<int> put_together(const BlockResult& block, std::size_t known_before, KnownOrbits& all) {
    std::vector<int> numbers(known_before);
    std::iota(numbers.begin(), numbers.end(), 0);
    const std::vector<int> found = merge_into(all, block.found);
    numbers.insert(numbers.end(), found.begin(), found.end());
    return numbers;
}

void count_shares(Ensemble& ensemble) {
    for (const int motion : ensemble.led_to) {
        if (motion >= 0) { ++ensemble.attractors[index(motion)].starts; }
    }
    if (ensemble.starts == 0) { return; }
    for (Attractor& motion : ensemble.attractors) { motion.share = share_of(motion.starts, ensemble.starts); }
    ensemble.missed_share_bound = share_bound(ensemble.unclassified, ensemble.starts);
}

}  // namespace

Ensemble find_attractors(const Systems& systems, const Box& box, const EnsembleOptions& options,
                         std::span<const orbit::Orbit> given) {
    check(systems, box, options, given);
    CountedSystems counted(systems);
    const flow::State scale = distance_scale(systems.exact, box);
    Ensemble ensemble;
    ensemble.box = box;

    KnownOrbits known;
    for (const orbit::Orbit& orbit : given) { merge_into(known, {make_known(counted.systems, orbit, scale)}); }
    const std::size_t given_count = known.size();
    Blocks blocks(systems, box, options, false);
    std::vector<BlockResult> results(index(blocks.count()));
    // The first block alone: what it finds has not to be found again in every other, and is the same for any number of
    // threads.
    results[0] = blocks.follow(0, known);
    known.insert(known.end(), results[0].found.begin(), results[0].found.end());
    const std::size_t common = known.size();
    in_parallel(blocks.count() - 1, options.jobs, [&](long i) { results[index(i + 1)] = blocks.follow(i + 1, known); });

    KnownOrbits all = known;
    Limits limits(systems);
    struct Leftover {
        std::size_t start;
        const std::vector<flow::State>* history;
    };
    std::vector<Leftover> leftovers;
    for (std::size_t b = 0; b < results.size(); ++b) {
        const BlockResult& block = results[b];
        ensemble.cycles += block.cycles;
        // Blocks behind the one that met a limit do not count, even if a thread has finished them: with one thread they
        // would not have been begun.
        if (limits.met_by(block)) {
            ensemble.status = limits.status<Ensemble::Status>();
            continue;
        }
        const auto numbers = put_together(block, b == 0 ? given_count : common, all);
        for (const Follower& follower : block.followers) {
            if (follower.fate == Fate::unsettled) { leftovers.push_back({ensemble.led_to.size(), &follower.history}); }
            if (follower.fate == Fate::failed) { ++ensemble.failed; }
            ensemble.led_to.push_back(follower.fate == Fate::captured ? numbers[index(follower.orbit)] : -1);
        }
    }
    ensemble.starts = static_cast<long>(ensemble.led_to.size());

    LeftoverJudge judge(counted.systems, box, all, options.leftovers);
    // Aperiodic motions are numbered behind the periodic ones, of which judging may still add some.
    std::vector<std::pair<std::size_t, int>> aperiodic;
    for (const Leftover& leftover : leftovers) {
        const LeftoverJudge::Verdict verdict = judge.judge(*leftover.history);
        if (const flow::Status limit = counted.cost.allowance(); limit != flow::Status::ok) {
            (void)limits.met_by(limit, 0);
            ensemble.status = limits.status<Ensemble::Status>();
            break;
        }
        ensemble.led_to[leftover.start] = verdict.orbit;
        if (verdict.aperiodic >= 0) { aperiodic.emplace_back(leftover.start, verdict.aperiodic); }
    }
    counted.lift_limits();
    for (const auto& orbit : all) { ensemble.attractors.push_back(measure(counted.exact, orbit->orbit)); }
    for (const auto& [start, motion] : aperiodic) { ensemble.led_to[start] = static_cast<int>(all.size()) + motion; }
    ensemble.attractors.insert(ensemble.attractors.end(), judge.aperiodic().begin(), judge.aperiodic().end());

    ensemble.unclassified = std::count(ensemble.led_to.begin(), ensemble.led_to.end(), -1);
    ensemble.cycles += counted.cost.periods();
    count_shares(ensemble);
    if (ensemble.status == Ensemble::Status::not_run) { ensemble.status = Ensemble::Status::done; }
    return ensemble;
}

namespace {

/// What one block has to say against the given orbit, which is number 0 of what is known.
struct Objection {
    std::optional<Attractor> other;
    long unclassified = 0;
    double cycles = 0.0;
    long steps = 0;
    flow::Status limit = flow::Status::ok;
};

Objection object(const Systems& systems, const Box& box, BlockResult block, const KnownOrbits& known,
                 const EnsembleOptions& options) {
    CountedSystems counted(systems);
    Objection objection;
    KnownOrbits all = known;
    all.insert(all.end(), block.found.begin(), block.found.end());
    LeftoverJudge judge(counted.systems, box, all, options.leftovers);
    for (const Follower& follower : block.followers) {
        // One counterexample is enough: the rest is not judged.
        if (block.limit != flow::Status::ok || all.size() > known.size() || !judge.aperiodic().empty()) { break; }
        if (follower.fate == Fate::failed) { ++objection.unclassified; }
        if (follower.fate != Fate::unsettled) { continue; }
        const auto verdict = judge.judge(follower.history);
        if (verdict.orbit < 0 && verdict.aperiodic < 0) { ++objection.unclassified; }
    }
    objection.limit = block.limit == flow::Status::ok ? counted.cost.allowance() : block.limit;
    counted.lift_limits();
    if (all.size() > known.size()) {
        objection.other = measure(counted.exact, all[known.size()]->orbit);
    } else if (!judge.aperiodic().empty()) {
        objection.other = judge.aperiodic().front();
    }
    objection.cycles = block.cycles + counted.cost.periods();
    objection.steps = block.steps + counted.cost.steps;
    return objection;
}

}  // namespace

Refutation refute(const Systems& systems, const orbit::Orbit& given, const Box& box, const EnsembleOptions& options) {
    check(systems, box, options, {&given, 1});
    CountedSystems counted(systems);
    Refutation refutation;
    refutation.box = box;
    const KnownOrbits known = {make_known(counted.systems, given, distance_scale(systems.exact, box))};
    refutation.cycles = counted.cost.periods();
    Blocks blocks(systems, box, options, true);
    Limits limits(systems);
    // As many blocks at a time as there are threads: at most jobs - 1 of them are in vain when the first refutes.
    for (long begun = 0; begun < blocks.count(); begun += options.jobs) {
        const long together = std::min<long>(options.jobs, blocks.count() - begun);
        std::vector<Objection> objections(index(together));
        in_parallel(together, options.jobs, [&](long i) {
            objections[index(i)] = object(systems, box, blocks.follow(begun + i, known), known, options);
        });
        for (long i = 0; i < together; ++i) {
            Objection& objection = objections[index(i)];
            refutation.cycles += objection.cycles;
            if (limits.met_by(objection.limit, objection.steps)) {
                refutation.status = limits.status<Refutation::Status>();
                return refutation;
            }
            refutation.starts += blocks.size(begun + i);
            refutation.unclassified += objection.unclassified;
            if (objection.other) {
                refutation.status = Refutation::Status::refuted;
                refutation.other = std::move(objection.other);
                return refutation;
            }
        }
    }
    refutation.missed_share_bound = share_bound(refutation.unclassified, refutation.starts);
    refutation.status = refutation.unclassified == 0 ? Refutation::Status::not_refuted : Refutation::Status::undecided;
    return refutation;
}

}  // namespace percuss::attractor
