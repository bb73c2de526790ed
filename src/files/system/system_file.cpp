#include "files/system/system_file.hpp"

#include <credence/error.hpp>

#include <fcntl.h>
#include <sys/file.h>
#include <unistd.h>

#include <cerrno>
#include <cstdio>
#include <system_error>

namespace credence {

namespace {

std::string remedy_for(int error) {
    switch (error) {
        case ENOSPC:
        case EDQUOT: return "Free some space, or write to another place";
        case EFBIG: return "Raise the limit on the size of files (ulimit -f), or write to another place";
        case EACCES:
        case EPERM:
        case EROFS: return "Write to a folder that you may write to";
        case ENOENT: return "Make its folder first";
        case ENAMETOOLONG: return "Give a shorter name";
        case EEXIST: return "Move that away, or write to another place";
        case EWOULDBLOCK: return "Let it end, or write to another place";
        default: return "Write to another place";
    }
}

bool leads_nowhere(int error) {
    return error == ENOENT || error == ENOTDIR || error == ELOOP || error == EACCES || error == ENAMETOOLONG;
}

/// The file may be one to read or one to write.
[[noreturn]] void fail_to_access(const std::string& path, int error) {
    throw Failure("cannot access " + path, words_for(error), remedy_for_reading(error));
}

struct stat status_of(const Descriptor& file, const std::string& target) {
    struct stat status {};
    if (fstat(file.get(), &status) != 0) fail_to_access(target, errno);
    return status;
}

void lock_for_writing(const Descriptor& file, const std::string& target) {
    // On file systems without locks the file is written unlocked.
    if (flock(file.get(), LOCK_EX | LOCK_NB) != 0 && errno == EWOULDBLOCK)
        throw InputError("cannot write " + target, "another program is writing it", remedy_for(EWOULDBLOCK));
}

bool same_file(const std::optional<struct stat>& one, const std::optional<struct stat>& other) {
    return one && other && one->st_ino == other->st_ino && one->st_dev == other->st_dev;
}

}  // namespace

void fail_to_write(const std::string& path, const std::string& why, int error) {
    throw Failure("cannot write " + path, why, remedy_for(error));
}

void fail_to_write(const std::string& path, int error) { fail_to_write(path, words_for(error), error); }

std::optional<struct stat> status_of(const std::string& path, const std::string& target, Links links) {
    struct stat status {};
    const int follow = links == Links::followed ? 0 : AT_SYMLINK_NOFOLLOW;
    if (fstatat(AT_FDCWD, path.c_str(), &status, follow) == 0) return status;
    if (!leads_nowhere(errno)) fail_to_access(target, errno);
    return std::nullopt;
}

bool same_file(const Descriptor& opened, const std::string& path, const std::string& target) {
    return same_file(status_of(opened, target), status_of(path, target));
}

bool same_file(const std::string& one, const std::string& other) {
    return same_file(status_of(one, one), status_of(other, other));
}

Descriptor open_locked(const std::string& path, const std::string& target, mode_t mode) {
    for (;;) {
        Descriptor file(open(path.c_str(), O_RDWR | O_CREAT | O_CLOEXEC | O_NOFOLLOW, mode));
        if (file.get() < 0) fail_to_write(target, errno);
        lock_for_writing(file, target);
        if (same_file(file, path, target)) return file;
    }
}

Descriptor open_new_locked(const std::string& path, const std::string& target) {
    for (;;) {
        Descriptor file(open(path.c_str(), O_RDWR | O_CREAT | O_EXCL | O_CLOEXEC, 0666));
        if (file.get() >= 0) {
            lock_for_writing(file, target);
            if (same_file(file, path, target)) return file;
        } else if (errno == EEXIST) {
            const Descriptor left = open_locked(path, target);
            if (unlink(path.c_str()) != 0 && errno != ENOENT) fail_to_write(target, errno);
        } else {
            fail_to_write(target, errno);
        }
    }
}

mode_t permissions_of(const std::string& path) {
    const std::optional<struct stat> status = status_of(path, path);
    return status ? status->st_mode & 0777 : 0666;
}

void take_owner_and_permissions(const Descriptor& file, const std::string& other) {
    const std::optional<struct stat> theirs = status_of(other, other);
    if (!theirs) return;
    const struct stat own = status_of(file, other);
    // Only root may change a file's owner.
    if (own.st_uid != theirs->st_uid || own.st_gid != theirs->st_gid)
        [[maybe_unused]] const int refused = fchown(file.get(), theirs->st_uid, theirs->st_gid);
    if (fchmod(file.get(), theirs->st_mode & 07777) == 0) return;
    // A file system without permissions refuses this; but nobody may read the new file who may not read the other.
    if ((own.st_mode & ~theirs->st_mode & 0777) != 0) fail_to_write(other, errno);
}

int rename_to_free_name(const std::string& from, const std::string& to) {
    if (renameat2(AT_FDCWD, from.c_str(), AT_FDCWD, to.c_str(), RENAME_NOREPLACE) == 0) return 0;
    if (errno != EINVAL && errno != ENOSYS) return errno;
    // The file system cannot do both in one step.
    if (status_of(to, to, Links::themselves)) return EEXIST;
    return rename(from.c_str(), to.c_str()) == 0 ? 0 : errno;
}

std::filesystem::path followed(std::filesystem::path path) {
    constexpr int most = 40;  // number of links that the system follows
    const std::string given = path.string();
    for (int links = 0; links < most; ++links) {
        const std::optional<struct stat> status = status_of(path.string(), given, Links::themselves);
        if (!status || !S_ISLNK(status->st_mode)) break;
        std::error_code trouble;
        path = path.parent_path() / std::filesystem::read_symlink(path, trouble);
        if (trouble) fail_to_write(given, trouble.value());
    }
    return path;
}

void sync_folder(const std::filesystem::path& folder, const std::string& path) {
    const Descriptor opened(open(folder.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC));
    if (opened.get() < 0 && errno == EACCES) return;
    if (opened.get() >= 0 && (fsync(opened.get()) == 0 || errno == EINVAL || errno == ENOTSUP)) return;
    fail_to_write(path, errno);
}

std::filesystem::path folder_of(const std::filesystem::path& path) {
    return path.has_parent_path() ? path.parent_path() : std::filesystem::path(".");
}

}  // namespace credence
