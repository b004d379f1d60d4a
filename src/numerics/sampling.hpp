#pragma once
/// \file
/// Points in the unit cube for tables over a design space: Sobol's sequence, a Latin hypercube, a full grid.

#include "numerics/linear.hpp"

#include <cstdint>
#include <memory>
#include <span>
#include <string_view>
#include <vector>

namespace percuss::numerics {

/// A fixed list of points of [0, 1]^n. Any block of rows can be had without those before it, with the same bits on
/// every machine, in any order and from several threads at once.
class PointSet {
public:
    virtual ~PointSet() = default;
    PointSet() = default;
    PointSet(const PointSet&) = delete;
    PointSet& operator=(const PointSet&) = delete;

    [[nodiscard]] virtual int dimensions() const = 0;
    /// How many rows there are; a sequence that can go on for ever says 2^53.
    [[nodiscard]] virtual std::uint64_t size() const = 0;
    /// Rows first, first + 1, ..., first + count - 1 as a count x n matrix. Throws std::invalid_argument where they
    /// reach beyond size().
    [[nodiscard]] virtual Matrix rows(std::uint64_t first, Eigen::Index count) const = 0;
};

/// Sobol's sequence (USSR Comput. Math. Math. Phys. 7, 1967) with the direction numbers of Joe and Kuo (SIAM J. Sci.
/// Comput. 30, 2008), in Gray code order from the origin on, unscrambled. Row i does not depend on the number of rows.
/// Throws std::invalid_argument for dimensions outside 1..3667.
std::unique_ptr<PointSet> plain_sobol(int dimensions);

/// The same scrambled as Owen does (Monte Carlo and Quasi-Monte Carlo Methods in Scientific Computing, 1995): digit b
/// of a coordinate is flipped or not by a random bit that belongs to the b digits before it,
///
///     y_b = x_b xor h(seed, coordinate, x_0 ... x_{b-1}),   b = 0 ... 52,
///
/// with h one bit of a hash, so the random bits are never stored and each row stands alone. Every point is uniform in
/// [0, 1)^n, every aligned run of 2^m rows keeps the stratification of the plain sequence, and means of smooth
/// functions converge like N^-3/2.
std::unique_ptr<PointSet> scrambled_sobol(int dimensions, std::uint64_t seed);

/// A Latin hypercube (McKay, Beckman and Conover, Technometrics 21, 1979): cut in `samples` equal strata, each
/// coordinate has one point in each, somewhere inside. The permutations are ciphers on 0..samples-1 (Feistel networks
/// with cycle walking; Black and Rogaway, CT-RSA 2002), so row i is had without the rest; but it depends on `samples`:
/// a longer table shares no rows with a shorter one. Throws std::invalid_argument for dimensions below 1 or samples
/// outside 1..2^31.
std::unique_ptr<PointSet> latin_hypercube(int dimensions, std::uint64_t samples, std::uint64_t seed);

/// All combinations of levels, the last coordinate varying fastest; level j of L lies at j/(L - 1), a single one at
/// 1/2. Throws std::invalid_argument when a coordinate has fewer than one level or there are more than 2^53
/// combinations.
std::unique_ptr<PointSet> grid(std::vector<int> levels);

/// Levels for a grid of at most `samples` points. `fixed` has one entry a coordinate: the number of levels it must have
/// (an integer variable takes each of its values) or 0; all coordinates with 0 get the same number, as many as fit.
/// Throws std::invalid_argument when `fixed` holds a negative entry or not even 2 levels fit for those with 0 (1 where
/// none has).
std::vector<int> grid_levels(std::span<const int> fixed, std::uint64_t samples);

/// What a sampling needs to know; each uses what it needs.
struct SamplingRequest {
    std::vector<int> levels;    ///< one entry a coordinate: number of values of an integer variable, 0 for a real one
    std::uint64_t samples = 0;  ///< rows wanted (a grid may have fewer)
    std::uint64_t seed = 1;
};

/// One row of the table of samplings that a user may choose by name.
struct Sampling {
    std::string_view name;
    std::string_view meaning;
    bool extendable = false;    ///< the first N rows of a longer table are those of the shorter one
    bool takes_levels = false;  ///< each value of an integer variable is met equally often
    std::unique_ptr<PointSet> (*make)(const SamplingRequest& request) = nullptr;
};

/// sobol, lhs and grid.
std::span<const Sampling> samplings();

}  // namespace percuss::numerics
