#pragma once
/// \file
/// The record of a long run: a file that whole blocks of rows are added to, that survives a kill at any moment.

#include "results/journal_error.hpp"
#include "results/shard.hpp"

#include <cstdint>
#include <filesystem>
#include <functional>
#include <map>
#include <memory>
#include <string>
#include <variant>
#include <vector>

namespace percuss::results {

struct JournalColumn {
    std::string name;  ///< unique, also when upper and lower case are taken as equal
    std::string unit;  ///< "" or "1": a pure number or a text
    bool is_text = false;

    friend bool operator==(const JournalColumn&, const JournalColumn&) = default;
};

/// What the rows are. All shards of a table have the same.
struct JournalWork {
    std::string kind;     ///< which verb: "explore", ...
    std::string problem;  ///< the problem as resolved, without what may change on resuming (number of samples, jobs)
    std::vector<JournalColumn> columns;
};

/// A number (NaN: there is none) or, in a text column, a text. Numbers come back with the same bits, -0 and infinities
/// included; every NaN comes back as the default one.
using Cell = std::variant<double, std::string>;
using Row = std::vector<Cell>;

/// Rows 64 number, 64 number + 1, ... of a table: 64 of them, fewer only in its last block.
struct RowBlock {
    std::int64_t number = 0;
    std::vector<Row> rows;
};

/// One SQLite file (write-ahead logging), for one process and one thread at a time: the file stays locked while the
/// object lives. A block is in it wholly or not at all. When the object is destroyed the file stands alone; after a
/// kill the next one to open it finds every block whose write() had returned.
class Journal {
public:
    /// Opens for writing: begins a journal where there is none, else resumes. Every stored block is read and checked.
    /// Throws JournalError with any fault but conflict.
    Journal(const std::filesystem::path& file, const JournalWork& work, const Shard& shard = {});
    /// Opens an existing journal, whatever its work, to read it. Throws JournalError likewise.
    explicit Journal(const std::filesystem::path& file);

    ~Journal();
    Journal(Journal&&) noexcept;
    Journal& operator=(Journal&&) = delete;

    [[nodiscard]] const std::filesystem::path& file() const;
    [[nodiscard]] const JournalWork& work() const;
    [[nodiscard]] const Shard& shard() const;

    /// Rows that the whole table (all shards) is meant to have; 0 until set. May be changed: a table can be extended.
    [[nodiscard]] std::int64_t rows_wanted() const;
    /// Throws std::invalid_argument when negative, JournalError when it cannot be written.
    void set_rows_wanted(std::int64_t rows);

    /// Number of rows stored, by block number.
    [[nodiscard]] const std::map<std::int64_t, std::int64_t>& blocks() const;
    /// Blocks of this journal's shard that are absent or shorter than a table of `rows` rows needs them, ascending.
    [[nodiscard]] std::vector<std::int64_t> missing_blocks(std::int64_t rows) const;

    /// Adds a block, or replaces a shorter one of the same number. When this returns a kill cannot undo it (a power cut
    /// may). Throws std::invalid_argument for a block of another shard, with no rows or more than 64, with rows that do
    /// not fit the columns, or no longer than the one stored; std::logic_error for a journal opened to read;
    /// JournalError when it cannot be written.
    void write(const RowBlock& block);

    /// A stored block. Throws std::out_of_range where there is none, JournalError (corrupted).
    [[nodiscard]] RowBlock read(std::int64_t number) const;
    /// Calls visit for each block by ascending number, one in memory at a time.
    void for_each_block(const std::function<void(const RowBlock&)>& visit) const;

private:
    struct State;
    std::unique_ptr<State> state_;
};

/// Throws JournalError (other_work, with both texts) unless `other` holds rows of the same work as `journal`.
void check_same_work(const Journal& journal, const Journal& other);

}  // namespace percuss::results
