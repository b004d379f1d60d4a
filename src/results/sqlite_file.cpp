#include "results/sqlite_file.hpp"

#include "results/journal_error.hpp"

#include <sqlite3.h>

#include <cstddef>
#include <utility>

namespace percuss::results {
namespace {

// A task that is run again may meet the last moments of its predecessor.
constexpr int lock_patience_ms = 1000;

/// Turns what SQLite says into the fault it means to us.
[[noreturn]] void refuse_for(const std::filesystem::path& file, int code, const std::string& text) {
    switch (code & 0xff) {
        case SQLITE_BUSY:
        case SQLITE_LOCKED:
            refuse(JournalFault::in_use, file,
                   "is in use by another process; wait until that has ended, or give each process a folder of its own");
        case SQLITE_CORRUPT:
        case SQLITE_NOTADB: refuse_corrupted(file, text);
        default:
            refuse(JournalFault::no_access, file,
                   "cannot be used (" + text +
                       "); check the disk's free space and the rights on the file and its folder");
    }
}

}  // namespace

Database::Database(std::filesystem::path file, bool may_create) : file_(std::move(file)) {
    const int flags = SQLITE_OPEN_READWRITE | (may_create ? SQLITE_OPEN_CREATE : 0);
    const int code = sqlite3_open_v2(file_.c_str(), &handle_, flags, nullptr);
    if (code != SQLITE_OK) {
        const std::string text = handle_ == nullptr ? "out of memory" : sqlite3_errmsg(handle_);
        sqlite3_close(handle_);
        refuse_for(file_, code, text);
    }
    sqlite3_busy_timeout(handle_, lock_patience_ms);
    // Nothing is moved from the log into a file that turns out to be damaged.
    sqlite3_db_config(handle_, SQLITE_DBCONFIG_NO_CKPT_ON_CLOSE, 1, nullptr);
}

Database::~Database() { sqlite3_close(handle_); }

void Database::run(const std::string& sql) const {
    check(sqlite3_exec(handle_, sql.c_str(), nullptr, nullptr, nullptr));
}

void Database::try_to_run(const std::string& sql) const {
    sqlite3_exec(handle_, sql.c_str(), nullptr, nullptr, nullptr);
}

void Database::check(int code) const {
    if (code != SQLITE_OK && code != SQLITE_ROW && code != SQLITE_DONE) {
        refuse_for(file_, code, sqlite3_errmsg(handle_));
    }
}

Statement::Statement(const Database& database, const std::string& sql) : database_(database) {
    database.check(sqlite3_prepare_v2(database.handle(), sql.c_str(), -1, &handle_, nullptr));
}

Statement::~Statement() { sqlite3_finalize(handle_); }

void Statement::bind(int place, std::int64_t value) { database_.check(sqlite3_bind_int64(handle_, place, value)); }

void Statement::bind(int place, double value) { database_.check(sqlite3_bind_double(handle_, place, value)); }

void Statement::bind(int place, const std::string& text) {
    database_.check(sqlite3_bind_text64(handle_, place, text.data(), text.size(), SQLITE_TRANSIENT, SQLITE_UTF8));
}

bool Statement::step() {
    const int code = sqlite3_step(handle_);
    database_.check(code);
    return code == SQLITE_ROW;
}

void Statement::execute() {
    while (step()) {}
    database_.check(sqlite3_reset(handle_));
}

bool Statement::is_null(int column) const { return sqlite3_column_type(handle_, column) == SQLITE_NULL; }

std::int64_t Statement::integer(int column) const { return sqlite3_column_int64(handle_, column); }

double Statement::number(int column) const { return sqlite3_column_double(handle_, column); }

std::string Statement::text(int column) const {
    const auto* bytes = static_cast<const char*>(sqlite3_column_blob(handle_, column));
    const int size = sqlite3_column_bytes(handle_, column);
    return bytes == nullptr ? std::string() : std::string(bytes, static_cast<std::size_t>(size));
}

Transaction::Transaction(const Database& database) : database_(database) { database_.run("BEGIN EXCLUSIVE"); }

Transaction::~Transaction() {
    if (is_open_) { database_.try_to_run("ROLLBACK"); }
}

void Transaction::commit() {
    database_.run("COMMIT");
    is_open_ = false;
}

}  // namespace percuss::results
