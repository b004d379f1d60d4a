#pragma once
/// \file
/// The shards of one table joined into the journal that one process would have written.

#include "results/journal.hpp"

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

namespace percuss::results {

/// Blocks first, first + 1, ..., last.
struct BlockRange {
    std::int64_t first = 0;
    std::int64_t last = 0;
    friend bool operator==(const BlockRange&, const BlockRange&) = default;
};

struct MergeReport {
    std::int64_t rows_wanted = 0;      ///< the largest that a shard says
    std::int64_t rows = 0;             ///< rows now in the target
    std::int64_t overlaps = 0;         ///< times a block came again, with the same rows
    std::vector<BlockRange> missing;   ///< absent or too short for rows_wanted, ascending
    std::vector<std::string> lacking;  ///< for each source that lacks blocks of its shard: its name, shard and how many

    [[nodiscard]] bool is_complete() const { return rows_wanted > 0 && missing.empty(); }
};

/// Adds the blocks of all sources to the journal `target`, which is begun where it does not exist and holds the whole
/// table. Sources are only read. The order of sources does not matter to what the target holds.
///
/// Throws std::invalid_argument without sources or when the target is one of them; JournalError for each fault of a
/// journal, other_work when sources or target differ in what they belong to (with both texts), conflict when the same
/// row differs between two (the target then keeps the blocks that came first).
MergeReport merge_journals(const std::vector<std::filesystem::path>& sources, const std::filesystem::path& target);

}  // namespace percuss::results
