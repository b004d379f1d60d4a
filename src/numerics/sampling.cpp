#include "numerics/sampling.hpp"

#include "numerics/hash.hpp"

#include <boost/random/sobol.hpp>

#include <algorithm>
#include <array>
#include <bit>
#include <limits>
#include <stdexcept>
#include <string>
#include <utility>

namespace percuss::numerics {
namespace {

constexpr int digits = std::numeric_limits<double>::digits;  // 53 binary digits of a coordinate are kept
constexpr std::uint64_t endless = std::uint64_t{1} << digits;
constexpr std::uint64_t most_strata = std::uint64_t{1} << 31;

void check_range(const char* name, std::uint64_t value, std::uint64_t lowest, std::uint64_t largest) {
    if (value >= lowest && value <= largest) { return; }
    throw std::invalid_argument(std::string(name) + " = " + std::to_string(value) + ", must be " +
                                std::to_string(lowest) + ".." + std::to_string(largest));
}

void check_dimensions(int dimensions, int largest) {
    if (dimensions >= 1 && dimensions <= largest) { return; }
    throw std::invalid_argument("dimensions = " + std::to_string(dimensions) + ", must be 1.." +
                                std::to_string(largest));
}

void check_rows(const PointSet& points, std::uint64_t first, Eigen::Index count) {
    const std::uint64_t size = points.size();
    if (count >= 0 && first <= size && static_cast<std::uint64_t>(count) <= size - first) { return; }
    throw std::invalid_argument("rows " + std::to_string(first) + " and " + std::to_string(count) +
                                " from there, there are " + std::to_string(size));
}

double as_fraction(std::uint64_t bits) { return static_cast<double>(bits) / static_cast<double>(endless); }

// ---- Sobol ----------------------------------------------------------------------------------------------------------

class SobolPoints : public PointSet {
public:
    explicit SobolPoints(int dimensions)
        : dimensions_(checked(dimensions)),
          engine_(static_cast<std::size_t>(dimensions)) {}

    [[nodiscard]] int dimensions() const override { return dimensions_; }
    [[nodiscard]] std::uint64_t size() const override { return endless; }

    [[nodiscard]] Matrix rows(std::uint64_t first, Eigen::Index count) const override {
        check_rows(*this, first, count);
        Matrix points(count, dimensions_);
        boost::random::sobol engine = engine_;
        // Boost's engine leaves out the origin: its point k is point k + 1 of the sequence.
        if (first > 0) { engine.seed(first - 1); }
        for (Eigen::Index i = 0; i < count; ++i) {
            const bool is_origin = first + static_cast<std::uint64_t>(i) == 0;
            for (int j = 0; j < dimensions_; ++j) {
                points(i, j) = as_fraction(digit_bits(is_origin ? 0 : engine() >> (64 - digits), j));
            }
        }
        return points;
    }

protected:
    /// The 53 digits of coordinate j to use in place of these, the first one highest.
    [[nodiscard]] virtual std::uint64_t digit_bits(std::uint64_t bits, int /*j*/) const { return bits; }

private:
    static int checked(int dimensions) {
        check_dimensions(dimensions, boost::random::default_sobol_table::max_dimension);
        return dimensions;
    }

    int dimensions_;
    boost::random::sobol engine_;
};

class ScrambledSobolPoints : public SobolPoints {
public:
    ScrambledSobolPoints(int dimensions, std::uint64_t seed) : SobolPoints(dimensions) {
        for (int j = 0; j < dimensions; ++j) { keys_.push_back(stream_key(seed, static_cast<std::uint64_t>(j))); }
    }

protected:
    [[nodiscard]] std::uint64_t digit_bits(std::uint64_t bits, int j) const override {
        const std::uint64_t key = keys_[static_cast<std::size_t>(j)];
        std::uint64_t flips = 0;
        for (int b = 0; b < digits; ++b) {
            // The b digits before this one with a 1 in front: a name for the node of the tree of digits.
            const std::uint64_t node = (std::uint64_t{1} << b) | (bits >> (digits - b));
            flips = (flips << 1) | (hashed(key, node) >> 63);
        }
        return bits ^ flips;
    }

private:
    std::vector<std::uint64_t> keys_;
};

// ---- Latin hypercube ------------------------------------------------------------------------------------------------

/// A permutation of 0..size-1 chosen by a key.
class Permutation {
public:
    Permutation(std::uint64_t size, std::uint64_t key)
        : size_(size),
          key_(key),
          half_bits_(std::max(1, (static_cast<int>(std::bit_width(size - 1)) + 1) / 2)) {}

    [[nodiscard]] std::uint64_t operator()(std::uint64_t x) const {
        // The cipher permutes a range at most four times as large; walking its cycle comes back into ours.
        do { x = enciphered(x); } while (x >= size_);
        return x;
    }

private:
    /// A balanced Feistel network: a bijection of 2 half_bits bits whatever the round function. Four rounds suffice for
    /// a good one (Luby and Rackoff 1988); six leave some room for tables of a few rows, where the halves have a bit or
    /// two.
    [[nodiscard]] std::uint64_t enciphered(std::uint64_t x) const {
        constexpr std::uint64_t rounds = 6;
        const std::uint64_t mask = (std::uint64_t{1} << half_bits_) - 1;
        std::uint64_t left = x >> half_bits_;
        std::uint64_t right = x & mask;
        for (std::uint64_t round = 0; round < rounds; ++round) {
            const std::uint64_t mixed = left ^ (hashed(key_ + round, right) & mask);
            left = right;
            right = mixed;
        }
        return (left << half_bits_) | right;
    }

    std::uint64_t size_;
    std::uint64_t key_;
    int half_bits_;
};

class LatinHypercube : public PointSet {
public:
    LatinHypercube(int dimensions, std::uint64_t samples, std::uint64_t seed) : samples_(samples) {
        check_dimensions(dimensions, std::numeric_limits<int>::max());
        check_range("samples", samples, 1, most_strata);
        for (int j = 0; j < dimensions; ++j) {
            const auto stream = static_cast<std::uint64_t>(j);
            strata_.emplace_back(samples, stream_key(seed, 2 * stream));
            places_.push_back(stream_key(seed, 2 * stream + 1));
        }
    }

    [[nodiscard]] int dimensions() const override { return static_cast<int>(strata_.size()); }
    [[nodiscard]] std::uint64_t size() const override { return samples_; }

    [[nodiscard]] Matrix rows(std::uint64_t first, Eigen::Index count) const override {
        check_rows(*this, first, count);
        Matrix points(count, dimensions());
        for (Eigen::Index i = 0; i < count; ++i) {
            for (Eigen::Index j = 0; j < points.cols(); ++j) {
                points(i, j) = coordinate(first + static_cast<std::uint64_t>(i), static_cast<std::size_t>(j));
            }
        }
        return points;
    }

private:
    /// In the middle of one of 2^20 cells of the stratum, so that with up to 2^31 strata rounding cannot carry the
    /// point into the next one.
    [[nodiscard]] double coordinate(std::uint64_t row, std::size_t j) const {
        constexpr double cells = 1 << 20;
        const double stratum = static_cast<double>(strata_[j](row));
        const double cell = static_cast<double>(hashed(places_[j], row) >> 44);
        return (stratum + (cell + 0.5) / cells) / static_cast<double>(samples_);
    }

    std::uint64_t samples_;
    std::vector<Permutation> strata_;  ///< by coordinate
    std::vector<std::uint64_t> places_;
};

// ---- grid -----------------------------------------------------------------------------------------------------------

class Grid : public PointSet {
public:
    explicit Grid(std::vector<int> levels) : levels_(std::move(levels)) {
        check_range("number of coordinates", levels_.size(), 1, std::numeric_limits<int>::max());
        for (const int count : levels_) {
            if (count < 1) {
                throw std::invalid_argument("levels = " + std::to_string(count) + ", must be at least 1");
            }
            if (size_ > endless / static_cast<std::uint64_t>(count)) {
                throw std::invalid_argument("a grid of more than 2^53 points");
            }
            size_ *= static_cast<std::uint64_t>(count);
        }
    }

    [[nodiscard]] int dimensions() const override { return static_cast<int>(levels_.size()); }
    [[nodiscard]] std::uint64_t size() const override { return size_; }

    [[nodiscard]] Matrix rows(std::uint64_t first, Eigen::Index count) const override {
        check_rows(*this, first, count);
        Matrix points(count, dimensions());
        for (Eigen::Index i = 0; i < count; ++i) {
            std::uint64_t rest = first + static_cast<std::uint64_t>(i);
            for (Eigen::Index j = points.cols(); j-- > 0;) {
                const auto count_here = static_cast<std::uint64_t>(levels_[static_cast<std::size_t>(j)]);
                const auto level = static_cast<double>(rest % count_here);
                points(i, j) = count_here == 1 ? 0.5 : level / static_cast<double>(count_here - 1);
                rest /= count_here;
            }
        }
        return points;
    }

private:
    std::vector<int> levels_;
    std::uint64_t size_ = 1;
};

}  // namespace

std::unique_ptr<PointSet> plain_sobol(int dimensions) { return std::make_unique<SobolPoints>(dimensions); }

std::unique_ptr<PointSet> scrambled_sobol(int dimensions, std::uint64_t seed) {
    return std::make_unique<ScrambledSobolPoints>(dimensions, seed);
}

std::unique_ptr<PointSet> latin_hypercube(int dimensions, std::uint64_t samples, std::uint64_t seed) {
    return std::make_unique<LatinHypercube>(dimensions, samples, seed);
}

std::unique_ptr<PointSet> grid(std::vector<int> levels) { return std::make_unique<Grid>(std::move(levels)); }

std::vector<int> grid_levels(std::span<const int> fixed, std::uint64_t samples) {
    const auto fits = [&](std::uint64_t free_levels) {
        std::uint64_t points = 1;
        for (const int count : fixed) {
            if (count < 0) { throw std::invalid_argument("levels = " + std::to_string(count) + ", must be 0 or more"); }
            const std::uint64_t here = count == 0 ? free_levels : static_cast<std::uint64_t>(count);
            if (here > samples / points) { return false; }
            points *= here;
        }
        return points <= samples;
    };

    const bool any_free = std::find(fixed.begin(), fixed.end(), 0) != fixed.end();
    std::uint64_t free_levels = any_free ? 2 : 1;
    if (!fits(free_levels)) {
        throw std::invalid_argument("samples = " + std::to_string(samples) +
                                    ", too few for a grid with two levels of each real variable and every value of the "
                                    "integer ones");
    }
    while (any_free && free_levels < most_strata - 1 && fits(free_levels + 1)) { ++free_levels; }

    std::vector<int> levels(fixed.begin(), fixed.end());
    std::replace(levels.begin(), levels.end(), 0, static_cast<int>(free_levels));
    return levels;
}

std::span<const Sampling> samplings() {
    static constexpr auto dimensions = [](const SamplingRequest& r) { return static_cast<int>(r.levels.size()); };
    static constexpr std::array table = {
        Sampling{"sobol", "Sobol's sequence, Owen-scrambled by the seed; can be extended", true, false,
                 [](const SamplingRequest& r) { return scrambled_sobol(dimensions(r), r.seed); }},
        Sampling{"lhs", "Latin hypercube: each variable cut in as many strata as samples, one sample in each", false,
                 false, [](const SamplingRequest& r) { return latin_hypercube(dimensions(r), r.samples, r.seed); }},
        Sampling{"grid", "all combinations: every value of integer variables, equally many of the others", false, true,
                 [](const SamplingRequest& r) { return grid(grid_levels(r.levels, r.samples)); }},
    };
    return table;
}

}  // namespace percuss::numerics
