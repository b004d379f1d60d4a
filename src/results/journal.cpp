#include "results/journal.hpp"

#include "numerics/hash.hpp"
#include "results/sqlite_file.hpp"

#include <array>
#include <bit>
#include <cmath>
#include <cstddef>
#include <fstream>
#include <limits>
#include <system_error>
#include <utility>

namespace percuss::results {
namespace {

constexpr int application_id = 0x70657263;  // "perc", at byte 68 of the file
constexpr int schema_version = 1;

[[noreturn]] void refuse_foreign(const std::filesystem::path& file, const std::string& what) {
    refuse(JournalFault::foreign, file,
           "is no journal of percuss (" + what + "); nothing was changed: move it away or choose another folder");
}

[[noreturn]] void refuse_other(const std::filesystem::path& file, const std::string& what, const std::string& stored,
                               const std::string& asked) {
    refuse(JournalFault::other_work, file,
           "belongs to another " + what +
               "; nothing was changed: choose another folder, or ask for the same again\n--- in the journal\n" +
               stored + "\n--- asked for\n" + asked);
}

// ---- what is in the file --------------------------------------------------------------------------------------------

std::string quoted(const std::string& name) {
    std::string text = "\"";
    for (const char c : name) { text += c == '"' ? "\"\"" : std::string(1, c); }
    return text + "\"";
}

std::string text_of(const std::vector<JournalColumn>& columns) {
    std::string text;
    for (const JournalColumn& column : columns) {
        text += (text.empty() ? "" : ", ") + column.name + (column.unit.empty() ? "" : " [" + column.unit + "]") +
                (column.is_text ? " (text)" : "");
    }
    return text;
}

/// Tells a bit that has changed since the block was written. Depends on the bits of the numbers and the order of all.
std::int64_t digest_of(const std::vector<Row>& rows) {
    std::uint64_t digest = rows.size();
    const auto add = [&](std::uint64_t value) { digest = numerics::hashed(digest, value); };
    for (const Row& row : rows) {
        for (const Cell& cell : row) {
            if (const auto* number = std::get_if<double>(&cell)) {
                add(std::isnan(*number) ? 1 : 2);
                add(std::isnan(*number) ? 0 : std::bit_cast<std::uint64_t>(*number));
            } else {
                const std::string& text = std::get<std::string>(cell);
                add(text.size() + 3);
                for (const char c : text) { add(static_cast<unsigned char>(c)); }
            }
        }
    }
    return std::bit_cast<std::int64_t>(digest);
}

enum class Found : std::uint8_t { nothing, journal };

/// Looks at the first bytes, so that SQLite never touches a file that is not ours.
Found look_at(const std::filesystem::path& file) {
    std::error_code error;
    const auto status = std::filesystem::status(file, error);
    if (!std::filesystem::exists(status)) { return Found::nothing; }
    if (!std::filesystem::is_regular_file(status)) { refuse_foreign(file, "not a file"); }
    const auto size = std::filesystem::file_size(file, error);
    if (error) { refuse(JournalFault::no_access, file, "cannot be read (" + error.message() + ")"); }
    if (size == 0) { return Found::nothing; }  // killed while it was being begun

    std::array<char, 100> header{};
    std::ifstream stream(file, std::ios::binary);
    stream.read(header.data(), header.size());
    if (!stream && stream.gcount() == 0) { refuse(JournalFault::no_access, file, "cannot be read"); }
    // Sixteen bytes with the closing zero (SQLite's file format, section 1.3.1); a foreign file need not hold a zero.
    constexpr std::string_view magic("SQLite format 3\0", 16);
    if (std::string_view(header.data(), magic.size()) != magic) { refuse_foreign(file, "not a SQLite database"); }
    // With a rollback journal beside it the file is not in its final state: let SQLite set it right first.
    if (std::filesystem::exists(file.string() + "-journal", error)) { return Found::journal; }
    int id = 0;
    for (std::size_t i = 68; i < 72; ++i) { id = (id << 8) | static_cast<unsigned char>(header[i]); }
    if (id != application_id) { refuse_foreign(file, "a SQLite database of another program"); }
    return Found::journal;
}

/// SQLite makes NULL of a NaN by itself.
void bind(Statement& statement, int place, const Cell& cell) {
    std::visit([&](const auto& value) { statement.bind(place, value); }, cell);
}

Cell cell_at(const Statement& statement, int column, bool is_text) {
    if (is_text) { return statement.text(column); }
    return statement.is_null(column) ? std::numeric_limits<double>::quiet_NaN() : statement.number(column);
}

std::int64_t pragma(const Database& database, const std::string& name) {
    Statement statement(database, "PRAGMA " + name);
    return statement.step() ? statement.integer(0) : 0;
}

/// New, or killed while it was begun and set back by SQLite.
bool is_blank(const Database& database) {
    Statement tables(database, "SELECT count(*) FROM sqlite_master");
    return tables.step() && tables.integer(0) == 0 && pragma(database, "application_id") == 0;
}

std::string stored_fact(const Database& database, const std::string& key) {
    Statement statement(database, "SELECT value FROM facts WHERE key = ?");
    statement.bind(1, key);
    if (!statement.step()) { refuse_corrupted(database.file(), "its entry \"" + key + "\" is missing"); }
    return statement.text(0);
}

void store_fact(const Database& database, const std::string& key, const std::string& value) {
    Statement statement(database, "INSERT OR REPLACE INTO facts (key, value) VALUES (?, ?)");
    statement.bind(1, key);
    statement.bind(2, value);
    statement.execute();
}

void begin_journal(const Database& database, const JournalWork& work, const Shard& shard) {
    // Columns of rows have no type: a typed one would turn -0.0 into 0.
    std::string columns = "row INTEGER PRIMARY KEY";
    for (const JournalColumn& column : work.columns) { columns += ", " + quoted(column.name); }
    database.run("PRAGMA application_id = " + std::to_string(application_id));
    database.run("PRAGMA user_version = " + std::to_string(schema_version));
    database.run("CREATE TABLE facts (key TEXT PRIMARY KEY, value TEXT)");
    database.run("CREATE TABLE columns (place INTEGER PRIMARY KEY, name TEXT, unit TEXT, is_text INTEGER)");
    database.run("CREATE TABLE blocks (block INTEGER PRIMARY KEY, rows INTEGER, digest INTEGER)");
    database.run("CREATE TABLE rows (" + columns + ")");
    store_fact(database, "kind", work.kind);
    store_fact(database, "problem", work.problem);
    store_fact(database, "shard", text_of(shard));
    store_fact(database, "rows wanted", "0");
    Statement statement(database, "INSERT INTO columns VALUES (?, ?, ?, ?)");
    for (std::size_t i = 0; i < work.columns.size(); ++i) {
        statement.bind(1, static_cast<std::int64_t>(i));
        statement.bind(2, work.columns[i].name);
        statement.bind(3, work.columns[i].unit);
        statement.bind(4, std::int64_t{work.columns[i].is_text});
        statement.execute();
    }
}

void check_version_and_structure(const Database& database) {
    const std::int64_t id = pragma(database, "application_id");
    if (id != application_id) { refuse_foreign(database.file(), "a SQLite database of another program"); }
    const std::int64_t version = pragma(database, "user_version");
    if (version != schema_version) {
        refuse(JournalFault::version, database.file(),
               "has layout " + std::to_string(version) + ", this version of percuss reads " +
                   std::to_string(schema_version) + "; use the version that wrote it, or another folder");
    }
    Statement check(database, "PRAGMA quick_check(1)");
    const std::string answer = check.step() ? check.text(0) : "no answer";
    if (answer != "ok") { refuse_corrupted(database.file(), answer); }
}

JournalWork stored_work(const Database& database) {
    JournalWork work{stored_fact(database, "kind"), stored_fact(database, "problem"), {}};
    Statement statement(database, "SELECT name, unit, is_text FROM columns ORDER BY place");
    while (statement.step()) {
        work.columns.push_back({statement.text(0), statement.text(1), statement.integer(2) != 0});
    }
    return work;
}

void check_same(const std::filesystem::path& file, const JournalWork& stored, const JournalWork& asked) {
    if (stored.kind != asked.kind) { refuse_other(file, "verb", stored.kind, asked.kind); }
    if (stored.problem != asked.problem) { refuse_other(file, "problem", stored.problem, asked.problem); }
    if (stored.columns != asked.columns) {
        refuse_other(file, "choice of columns", text_of(stored.columns), text_of(asked.columns));
    }
}

}  // namespace

// ---- Journal --------------------------------------------------------------------------------------------------------

struct Journal::State {
    State(const std::filesystem::path& file, bool may_create) : database(file, may_create) {
        // Held until the end, against other processes; it also spares the log its shared memory, which network file
        // systems lack.
        database.run("PRAGMA locking_mode = EXCLUSIVE");
    }

    Database database;
    JournalWork work;
    Shard shard;
    std::int64_t rows_wanted = 0;
    std::map<std::int64_t, std::int64_t> blocks;
    bool can_write = false;
    bool is_sound = false;

    void load(const Journal& journal) {
        work = stored_work(database);
        try {
            shard = parse_shard(stored_fact(database, "shard"), [](const char*) { return std::nullopt; });
            rows_wanted = std::stoll(stored_fact(database, "rows wanted"));
        } catch (const std::logic_error&) { refuse_corrupted(database.file(), "its entries cannot be read"); }
        Statement statement(database, "SELECT block, rows FROM blocks ORDER BY block");
        while (statement.step()) { blocks[statement.integer(0)] = statement.integer(1); }
        journal.for_each_block([](const RowBlock&) {});
        Statement count(database, "SELECT count(*) FROM rows");
        std::int64_t rows = 0;
        for (const auto& [block, rows_here] : blocks) { rows += rows_here; }
        if (count.step() && count.integer(0) != rows) { refuse_corrupted(database.file(), "rows without a block"); }
        is_sound = true;
    }
};

Journal::Journal(const std::filesystem::path& file, const JournalWork& work, const Shard& shard) {
    look_at(file);
    state_ = std::make_unique<State>(file, true);
    const Database& database = state_->database;
    {
        Transaction transaction(database);
        if (is_blank(database)) { begin_journal(database, work, shard); }
        transaction.commit();
    }
    check_version_and_structure(database);
    state_->load(*this);
    check_same(file, state_->work, work);
    if (state_->shard != shard) { refuse_other(file, "shard", text_of(state_->shard), text_of(shard)); }
    database.run("PRAGMA journal_mode = WAL");
    // With a log, this loses nothing to a kill and spares a wait for the disk at each block.
    database.run("PRAGMA synchronous = NORMAL");
    state_->can_write = true;
}

Journal::Journal(const std::filesystem::path& file) {
    if (look_at(file) == Found::nothing) {
        refuse(JournalFault::no_access, file, "does not exist or is empty; check the name of the folder");
    }
    state_ = std::make_unique<State>(file, false);
    check_version_and_structure(state_->database);
    state_->load(*this);
}

Journal::~Journal() {
    if (state_ == nullptr || !state_->is_sound || !state_->can_write) { return; }
    // Moves the log into the file and removes it: the file can then be copied, and read where nothing can be written.
    state_->database.try_to_run("PRAGMA journal_mode = DELETE");
}

Journal::Journal(Journal&&) noexcept = default;

const std::filesystem::path& Journal::file() const { return state_->database.file(); }
const JournalWork& Journal::work() const { return state_->work; }
const Shard& Journal::shard() const { return state_->shard; }
std::int64_t Journal::rows_wanted() const { return state_->rows_wanted; }
const std::map<std::int64_t, std::int64_t>& Journal::blocks() const { return state_->blocks; }

void Journal::set_rows_wanted(std::int64_t rows) {
    if (rows < 0) { throw std::invalid_argument("rows = " + std::to_string(rows) + ", must be 0 or more"); }
    if (!state_->can_write) { throw std::logic_error("journal: opened to read"); }
    store_fact(state_->database, "rows wanted", std::to_string(rows));
    state_->rows_wanted = rows;
}

std::vector<std::int64_t> Journal::missing_blocks(std::int64_t rows) const {
    std::vector<std::int64_t> missing;
    for (const std::int64_t block : blocks_of(state_->shard, rows)) {
        const auto stored = state_->blocks.find(block);
        const std::int64_t rows_here = stored == state_->blocks.end() ? 0 : stored->second;
        if (rows_here < rows_in_block(block, rows)) { missing.push_back(block); }
    }
    return missing;
}

void Journal::write(const RowBlock& block) {
    if (!state_->can_write) { throw std::logic_error("journal: opened to read"); }
    const std::string name = "block " + std::to_string(block.number);
    const auto count = static_cast<std::int64_t>(block.rows.size());
    if (block.number < 0 || !state_->shard.takes(block.number)) {
        throw std::invalid_argument(name + " is none of shard " + text_of(state_->shard));
    }
    if (count < 1 || count > rows_per_block) {
        throw std::invalid_argument(name + " has " + std::to_string(count) + " rows, must be 1.." +
                                    std::to_string(rows_per_block));
    }
    for (const Row& row : block.rows) {
        bool fits = row.size() == work().columns.size();
        for (std::size_t i = 0; fits && i < row.size(); ++i) {
            fits = std::holds_alternative<std::string>(row[i]) == work().columns[i].is_text;
        }
        if (!fits) { throw std::invalid_argument(name + " has a row that does not fit the columns"); }
    }
    const auto stored = state_->blocks.find(block.number);
    if (stored != state_->blocks.end() && stored->second >= count) {
        throw std::invalid_argument(name + " is already there with " + std::to_string(stored->second) + " rows");
    }

    const Database& database = state_->database;
    Transaction transaction(database);
    std::string places = "?";
    for (std::size_t i = 0; i < work().columns.size(); ++i) { places += ", ?"; }
    Statement add_row(database, "INSERT OR REPLACE INTO rows VALUES (" + places + ")");
    for (std::size_t i = 0; i < block.rows.size(); ++i) {
        add_row.bind(1, block.number * rows_per_block + static_cast<std::int64_t>(i));
        for (std::size_t j = 0; j < block.rows[i].size(); ++j) {
            bind(add_row, static_cast<int>(j) + 2, block.rows[i][j]);
        }
        add_row.execute();
    }
    Statement add_block(database, "INSERT OR REPLACE INTO blocks VALUES (?, ?, ?)");
    add_block.bind(1, block.number);
    add_block.bind(2, count);
    add_block.bind(3, digest_of(block.rows));
    add_block.execute();
    transaction.commit();
    state_->blocks[block.number] = count;
}

RowBlock Journal::read(std::int64_t number) const {
    const std::int64_t rows = state_->blocks.at(number);
    const Database& database = state_->database;
    RowBlock block{number, {}};
    Statement statement(database, "SELECT * FROM rows WHERE row BETWEEN ? AND ? ORDER BY row");
    statement.bind(1, number * rows_per_block);
    statement.bind(2, (number + 1) * rows_per_block - 1);
    while (statement.step()) {
        Row row;
        for (std::size_t j = 0; j < work().columns.size(); ++j) {
            row.push_back(cell_at(statement, static_cast<int>(j) + 1, work().columns[j].is_text));
        }
        block.rows.push_back(std::move(row));
    }
    Statement digest(database, "SELECT digest FROM blocks WHERE block = ?");
    digest.bind(1, number);
    const bool is_same = static_cast<std::int64_t>(block.rows.size()) == rows && digest.step() &&
                         digest.integer(0) == digest_of(block.rows);
    if (!is_same) { refuse_corrupted(file(), "block " + std::to_string(number) + " does not match its digest"); }
    return block;
}

void Journal::for_each_block(const std::function<void(const RowBlock&)>& visit) const {
    for (const auto& [number, rows] : state_->blocks) { visit(read(number)); }
}

void check_same_work(const Journal& journal, const Journal& other) {
    check_same(other.file(), other.work(), journal.work());
}

}  // namespace percuss::results
