#pragma once
/// \file
/// How the benchmarks measure: contestants take turns, round by round, in one process, and are compared by ratios.
/// What is measured is the processor time of the calling thread, so waiting for a core that others use does not count.
/// What is left is one-sided noise (shared caches, the clock of the processor), which the minimum over many rounds
/// sheds: the ratio of minima is the robust figure, the ratios of single rounds show how much to trust it.

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <ctime>
#include <functional>
#include <limits>
#include <span>
#include <string>
#include <vector>

namespace percuss::bench {

/// Processor time of the calling thread [s].
inline double thread_seconds() {
    timespec now{};
    clock_gettime(CLOCK_THREAD_CPUTIME_ID, &now);
    return static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec);
}

struct Contestant {
    std::string name;
    std::function<void()> work;
};

struct RoundOptions {
    int rounds = 40;
    double sample_seconds = 5e-4;  ///< a sample repeats the work until it lasts about this long
};

/// Seconds per call of each contestant in each round.
class Times {
public:
    explicit Times(std::size_t contestants) : samples_(contestants) {}

    void add(std::size_t contestant, double seconds) { samples_[contestant].push_back(seconds); }
    [[nodiscard]] double lowest(std::size_t contestant) const {
        const std::vector<double>& s = samples_[contestant];
        return s.empty() ? std::numeric_limits<double>::quiet_NaN() : *std::min_element(s.begin(), s.end());
    }
    [[nodiscard]] double microseconds(std::size_t contestant) const { return 1e6 * lowest(contestant); }

    /// Time of one contestant in units of another's.
    [[nodiscard]] double ratio_of_minima(std::size_t contestant, std::size_t unit) const {
        return lowest(contestant) / lowest(unit);
    }
    [[nodiscard]] double median_ratio(std::size_t contestant, std::size_t unit) const {
        std::vector<double> r = ratios(contestant, unit);
        const auto middle = r.begin() + static_cast<std::ptrdiff_t>(r.size() / 2);
        std::nth_element(r.begin(), middle, r.end());
        return *middle;
    }
    [[nodiscard]] double lowest_ratio(std::size_t contestant, std::size_t unit) const {
        const std::vector<double> r = ratios(contestant, unit);
        return *std::min_element(r.begin(), r.end());
    }

private:
    [[nodiscard]] std::vector<double> ratios(std::size_t contestant, std::size_t unit) const {
        std::vector<double> r;
        for (std::size_t i = 0; i < samples_[contestant].size(); ++i) {
            r.push_back(samples_[contestant][i] / samples_[unit][i]);
        }
        return r;
    }

    std::vector<std::vector<double>> samples_;
};

/// Lets the contestants take turns; each round begins with the next one, so that none always runs in the wake of the
/// same other.
inline Times interleave(std::span<const Contestant> contestants, const RoundOptions& options = {}) {
    const std::size_t n = contestants.size();
    std::vector<int> repeats;
    for (const Contestant& contestant : contestants) {
        contestant.work();  // warm
        const double start = thread_seconds();
        contestant.work();
        const double once = std::max(thread_seconds() - start, 1e-8);
        repeats.push_back(std::max(1, static_cast<int>(std::ceil(options.sample_seconds / once))));
    }
    Times times(n);
    for (int round = 0; round < options.rounds; ++round) {
        for (std::size_t turn = 0; turn < n; ++turn) {
            const std::size_t i = (turn + static_cast<std::size_t>(round)) % n;
            const double start = thread_seconds();
            for (int r = 0; r < repeats[i]; ++r) { contestants[i].work(); }
            times.add(i, (thread_seconds() - start) / repeats[i]);
        }
    }
    return times;
}

}  // namespace percuss::bench
