#pragma once
/// \file
/// Which part of a table this process computes, when several processes or machines share the work.

#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace percuss::results {

/// Work is cut into blocks of this many consecutive rows; a block is the unit of journals, resuming and sharding.
inline constexpr std::int64_t rows_per_block = 64;

/// Blocks that `rows` rows fill; the last one may be short. 0 for rows <= 0.
constexpr std::int64_t blocks_of(std::int64_t rows) { return rows <= 0 ? 0 : (rows - 1) / rows_per_block + 1; }
/// Rows of block k when there are `rows` in all: 64, fewer in the last block, 0 beyond it.
constexpr std::int64_t rows_in_block(std::int64_t block, std::int64_t rows) {
    const std::int64_t left = rows - block * rows_per_block;
    return left < 0 ? 0 : left < rows_per_block ? left : rows_per_block;
}

/// Shard i of N takes the blocks k with k = i mod N. The default is the whole table.
struct Shard {
    std::int64_t index = 0;  ///< 0 .. count - 1
    std::int64_t count = 1;

    [[nodiscard]] constexpr bool takes(std::int64_t block) const { return block % count == index; }
    [[nodiscard]] constexpr bool is_whole() const { return count == 1; }
    friend bool operator==(const Shard&, const Shard&) = default;
};

/// Block numbers of this shard, ascending, when the whole table has so many rows.
std::vector<std::int64_t> blocks_of(const Shard& shard, std::int64_t rows);

/// "i/N".
std::string text_of(const Shard& shard);

/// Value of an environment variable; nothing when it is not set.
using Environment = std::function<std::optional<std::string>(const char* name)>;

/// Reads "i/N" (i from 0 to N - 1) or "auto". The latter asks the environment, in this order:
///
/// - a Slurm job array: SLURM_ARRAY_TASK_ID, _COUNT, and _MIN, _MAX where set; the ids must be consecutive or evenly
///   spaced from the smallest on, and the smallest counts as shard 0. A task run again by itself (`--array=3`) is an
///   array of one that no longer says of how many: refused, give its "i/N" then.
/// - Open MPI: OMPI_COMM_WORLD_RANK, OMPI_COMM_WORLD_SIZE
/// - PMI (MPICH, srun): PMI_RANK, PMI_SIZE
///
/// Throws std::invalid_argument with one sentence that says what is allowed: other texts, i outside 0..N-1, "auto" with
/// none of these set, one that is incomplete or no number, a Slurm array of one
/// task other than 0, or two of them that both number several processes.
Shard parse_shard(std::string_view text, const Environment& environment);

}  // namespace percuss::results
