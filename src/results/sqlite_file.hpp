#pragma once
/// \file
/// SQLite for the journal: a connection, a statement, a transaction. Every failure is a JournalError.

#include <cstdint>
#include <filesystem>
#include <string>

struct sqlite3;
struct sqlite3_stmt;

namespace percuss::results {

class Database {
public:
    /// Opens for reading and writing, or only for reading where the file cannot be written.
    Database(std::filesystem::path file, bool may_create);
    ~Database();
    Database(const Database&) = delete;
    Database& operator=(const Database&) = delete;

    void run(const std::string& sql) const;
    /// The same where failure has no consequence.
    void try_to_run(const std::string& sql) const;
    /// Throws unless `code` is one of SQLite's codes of success.
    void check(int code) const;

    [[nodiscard]] sqlite3* handle() const { return handle_; }
    [[nodiscard]] const std::filesystem::path& file() const { return file_; }

private:
    std::filesystem::path file_;
    sqlite3* handle_ = nullptr;
};

class Statement {
public:
    Statement(const Database& database, const std::string& sql);
    ~Statement();
    Statement(const Statement&) = delete;
    Statement& operator=(const Statement&) = delete;

    /// Values for the places "?" of the statement, counted from 1. A NaN becomes NULL.
    void bind(int place, std::int64_t value);
    void bind(int place, double value);
    void bind(int place, const std::string& text);

    /// True while there is a row.
    bool step();
    /// For statements that return nothing; ready for the next values afterwards.
    void execute();

    /// Columns of the row, counted from 0.
    [[nodiscard]] bool is_null(int column) const;
    [[nodiscard]] std::int64_t integer(int column) const;
    [[nodiscard]] double number(int column) const;
    [[nodiscard]] std::string text(int column) const;

private:
    const Database& database_;
    sqlite3_stmt* handle_ = nullptr;
};

/// Stores all of its scope at commit() or, when an exception passes, nothing of it.
class Transaction {
public:
    explicit Transaction(const Database& database);
    ~Transaction();
    Transaction(const Transaction&) = delete;
    Transaction& operator=(const Transaction&) = delete;
    void commit();

private:
    const Database& database_;
    bool is_open_ = true;
};

}  // namespace percuss::results
