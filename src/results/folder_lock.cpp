#include "results/folder_lock.hpp"

#include <cerrno>
#include <cstring>
#include <stdexcept>
#include <string>

#include <fcntl.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

namespace percuss::results {

namespace {

/// Whether a descriptor still is the file of this name: another run may have removed it between open and flock.
bool is_still(int descriptor, const std::filesystem::path& file) {
    struct stat opened {};
    struct stat named {};
    return fstat(descriptor, &opened) == 0 && stat(file.c_str(), &named) == 0 && opened.st_ino == named.st_ino &&
           opened.st_dev == named.st_dev;
}

}  // namespace

FolderLock::~FolderLock() { release(); }

bool FolderLock::take(const std::filesystem::path& folder) {
    file_ = folder / file_name;
    // Again where the lock was got on a file that another run had removed meanwhile: nobody else would see that lock.
    while (true) {
        descriptor_ = open(file_.c_str(), O_RDWR | O_CREAT | O_CLOEXEC, 0666);
        if (descriptor_ < 0) {
            throw std::runtime_error(file_.string() + " cannot be created: " + std::strerror(errno));
        }
        // The kernel lets go of it when the process ends in whatever way, so no lock is left behind by a crash.
        const bool locked = flock(descriptor_, LOCK_EX | LOCK_NB) == 0;
        if (locked && is_still(descriptor_, file_)) { return true; }
        close(descriptor_);
        descriptor_ = -1;
        if (!locked) { return false; }
    }
}

void FolderLock::release() {
    if (descriptor_ < 0) { return; }
    // While it is still held: removed after closing, it could be the lock of the next run by then.
    unlink(file_.c_str());
    close(descriptor_);
    descriptor_ = -1;
}

bool FolderLock::is_taken(const std::filesystem::path& folder) {
    const std::filesystem::path file = folder / file_name;
    // Not created: looking leaves nothing behind.
    const int descriptor = open(file.c_str(), O_RDWR | O_CLOEXEC);
    if (descriptor < 0) { return false; }
    const bool taken = flock(descriptor, LOCK_EX | LOCK_NB) != 0;
    close(descriptor);
    return taken;
}

}  // namespace percuss::results
