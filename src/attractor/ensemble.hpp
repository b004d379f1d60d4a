#pragma once
/// \file
/// Where the motions of a system lead: an ensemble of independent uniform starts, followed and classified.
///
/// Starts are followed in blocks of 64. The first block begins with the orbits that are given, the others with what the
/// first has found as well; what a block finds besides is its own until all are put together in order. So the result is
/// a function of box, seed and number of starts alone, however many threads work on it.

#include "attractor/attractor.hpp"
#include "attractor/block.hpp"
#include "attractor/leftovers.hpp"
#include "numerics/cancel.hpp"

#include <functional>
#include <span>
#include <vector>

namespace percuss::attractor {

struct EnsembleOptions {
    long starts = 512;
    std::uint64_t seed = 1;
    int jobs = 1;           ///< threads
    int max_cycles = 1000;  ///< budget of each start, four times this for one that creeps towards a known orbit
    int longest_period = 12;
    LeftoverOptions leftovers{};
    numerics::CancelRequest cancelled{};        ///< may be asked from any thread
    std::function<void(double)> on_progress{};  ///< share done; may be called from any thread, one at a time
};

struct Ensemble {
    enum class Status : std::uint8_t {
        not_run,
        done,
        cancelled
    };  ///< cancelled: results of the blocks that were finished
    Status status = Status::not_run;
    Box box;
    std::vector<Attractor> attractors;  ///< periodic ones in the order of discovery, then aperiodic ones
    std::vector<int> led_to;            ///< number of the motion of each start that was looked at, -1 unclassified
    long starts = 0;                    ///< looked at
    long unclassified = 0;              ///< of these: neither captured nor recognised as aperiodic within the budget,
    long failed = 0;                    ///< of these: the flow failed (chatter, divergence)
    double missed_share_bound = 1.0;    ///< 95 %: share of the box that may lead elsewhere, given the unclassified ones
    double cycles = 0.0;                ///< drive cycles integrated
};

/// Every motion that the starts lead to. `given` are orbits known beforehand (stable, converged; others throw
/// std::invalid_argument). Throws std::invalid_argument for a bad box or options out of range.
Ensemble find_attractors(const Systems& systems, const Box& box, const EnsembleOptions& options,
                         std::span<const orbit::Orbit> given = {});

struct Refutation {
    enum class Status : std::uint8_t {
        not_run,
        not_refuted,  ///< every start led to the given orbit
        refuted,      ///< `other` is the counterexample
        undecided,    ///< no counterexample, but some starts are unclassified
        cancelled,
    };
    Status status = Status::not_run;
    Box box;
    std::optional<Attractor> other;
    long starts = 0;  ///< looked at: whole blocks, up to that of the first counterexample
    long unclassified = 0;
    double missed_share_bound = 1.0;  ///< as above; of use when not refuted
    double cycles = 0.0;
};

/// Does any start lead to another motion than the given stable orbit? Ends with the first block, in order, that holds a
/// counterexample.
Refutation refute(const Systems& systems, const orbit::Orbit& given, const Box& box, const EnsembleOptions& options);

}  // namespace percuss::attractor
