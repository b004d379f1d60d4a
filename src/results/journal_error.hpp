#pragma once
/// \file
/// What can be wrong with a journal.

#include <algorithm>
#include <cstdint>
#include <filesystem>
#include <stdexcept>
#include <string>

namespace percuss::results {

/// Why a journal cannot be used.
enum class JournalFault : std::uint8_t {
    foreign,     ///< the file is something else
    corrupted,   ///< it was a journal; parts are unreadable or do not match their digests
    version,     ///< written by a version of percuss with another layout
    in_use,      ///< another process has it open for writing
    other_work,  ///< it belongs to another problem, verb, set of columns or shard
    conflict,    ///< two journals to be merged disagree about a block
    no_access,   ///< it cannot be read or written: permissions, full disk, missing folder
};

/// The message names the file, what is wrong and what to do about it, in one line; for other_work the two texts that
/// differ follow on lines of their own. The file is left as it was.
class JournalError : public std::runtime_error {
public:
    JournalError(JournalFault fault, const std::string& message) : std::runtime_error(message), fault_(fault) {}
    [[nodiscard]] JournalFault fault() const { return fault_; }

private:
    JournalFault fault_;
};

/// Throws a JournalError whose message is the file's name and `rest`.
[[noreturn]] inline void refuse(JournalFault fault, const std::filesystem::path& file, const std::string& rest) {
    throw JournalError(fault, file.string() + " " + rest);
}

[[noreturn]] inline void refuse_corrupted(const std::filesystem::path& file, std::string what) {
    std::replace(what.begin(), what.end(), '\n', ' ');  // SQLite's account may take several lines
    refuse(JournalFault::corrupted, file,
           "is damaged (" + what + "); nothing was changed: put back a copy, or move it away to start afresh");
}

}  // namespace percuss::results
