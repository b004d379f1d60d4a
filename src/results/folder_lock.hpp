#pragma once
/// \file
/// One run at a time in a results folder.

#include <filesystem>
#include <string_view>

namespace percuss::results {

/// The lock is a file in the folder that this process holds with flock(2): the system releases it when the process
/// ends, however it does.
class FolderLock {
public:
    static constexpr std::string_view file_name = ".percuss-lock";

    FolderLock() = default;
    ~FolderLock();
    FolderLock(const FolderLock&) = delete;
    FolderLock& operator=(const FolderLock&) = delete;

    /// False when another process holds it. Throws std::runtime_error when the file cannot be created.
    [[nodiscard]] bool take(const std::filesystem::path& folder);
    /// Removes the file and lets go.
    void release();

    /// Whether some process holds the lock of a folder.
    static bool is_taken(const std::filesystem::path& folder);

private:
    std::filesystem::path file_;
    int descriptor_ = -1;
};

}  // namespace percuss::results
