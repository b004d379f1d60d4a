#include "optimise/halton.hpp"

#include <array>
#include <cmath>
#include <limits>
#include <numeric>
#include <random>
#include <stdexcept>
#include <string>

namespace percuss::optimise {
namespace {

constexpr std::array<int, 16> primes = {2, 3, 5, 7, 11, 13, 17, 19, 23, 29, 31, 37, 41, 43, 47, 53};

/// Fisher and Yates with the bare generator: standard distributions differ between libraries.
std::vector<int> random_permutation(int size, std::mt19937_64& random) {
    std::vector<int> permutation(static_cast<std::size_t>(size));
    std::iota(permutation.begin(), permutation.end(), 0);
    for (std::size_t i = permutation.size(); i > 1; --i) std::swap(permutation[i - 1], permutation[random() % i]);
    return permutation;
}

}  // namespace

Halton::Halton(int dimensions, std::uint64_t seed) {
    if (dimensions < 1 || dimensions > static_cast<int>(primes.size())) {
        throw std::invalid_argument("dimensions = " + std::to_string(dimensions) + ", must be 1.." +
                                    std::to_string(primes.size()));
    }
    std::mt19937_64 random(seed);
    for (int j = 0; j < dimensions; ++j) {
        const int base = primes[static_cast<std::size_t>(j)];
        // As many digits as fill the 53 bits of a double. All of them are drawn and permuted, the leading zeros of k
        // too: they make the points random beyond the digits that k has.
        const int digits = static_cast<int>(std::numeric_limits<double>::digits / std::log2(base));
        auto& coordinate = permutations_.emplace_back();
        for (int i = 0; i < digits; ++i) coordinate.push_back(random_permutation(base, random));
    }
}

numerics::Vector Halton::point(std::uint64_t k) const {
    numerics::Vector x(static_cast<Eigen::Index>(permutations_.size()));
    for (Eigen::Index j = 0; j < x.size(); ++j) {
        const auto base = static_cast<std::uint64_t>(primes[static_cast<std::size_t>(j)]);
        double weight = 1.0;
        double value = 0.0;
        std::uint64_t rest = k;
        for (const Permutation& permutation : permutations_[static_cast<std::size_t>(j)]) {
            weight /= static_cast<double>(base);
            value += weight * permutation[rest % base];
            rest /= base;
        }
        // Rounding can make the sum 1.
        x[j] = std::min(value, 1.0 - std::numeric_limits<double>::epsilon() / 2);
    }
    return x;
}

}  // namespace percuss::optimise
