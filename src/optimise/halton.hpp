#pragma once
/// \file
/// Points that fill a cube evenly.

#include "numerics/linear.hpp"

#include <cstdint>
#include <vector>

namespace percuss::optimise {

/// Halton's sequence in [0, 1)^n (Numerische Mathematik 2, 1960): coordinate j of point k is the radical inverse
///
///     sum_i pi_{j,i}(d_i) b^-(i+1),   k = sum_i d_i b^i,   b the j-th prime,
///
/// with each digit permuted at random, independently for each coordinate and digit position (Owen 2017,
/// arXiv:1706.02808), which breaks the stripes of plain Halton points in the larger bases. The same seed gives the
/// same points on every machine.
class Halton {
public:
    /// Throws std::invalid_argument for dimensions outside 1..16.
    Halton(int dimensions, std::uint64_t seed);

    /// Point k = 0, 1, ...; n entries.
    [[nodiscard]] numerics::Vector point(std::uint64_t k) const;

private:
    using Permutation = std::vector<int>;
    std::vector<std::vector<Permutation>> permutations_;  ///< by coordinate, then digit position
};

}  // namespace percuss::optimise
