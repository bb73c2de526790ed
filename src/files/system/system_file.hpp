#pragma once
// What the system does with files, and what it says where it refuses.

#include "base/descriptor.hpp"

#include <sys/types.h>

#include <csignal>
#include <filesystem>
#include <string>

namespace credence {

/// `cannot write PATH (WHY). REMEDY.`, the remedy for that error of the system.
[[noreturn]] void fail_to_write(const std::string& path, const std::string& why, int error);
[[noreturn]] void fail_to_write(const std::string& path, int error);

/// Beyond a limit on file sizes the system kills the process, unless it looks away; then write() says EFBIG.
class FileSizeSignalIgnored {
public:
    FileSizeSignalIgnored() {
        struct sigaction ignore {};
        ignore.sa_handler = SIG_IGN;
        sigaction(SIGXFSZ, &ignore, &before_);
    }
    ~FileSizeSignalIgnored() { sigaction(SIGXFSZ, &before_, nullptr); }

private:
    struct sigaction before_ {};
};

/// Whether the name still stands for the file that was opened.
bool same_file(const Descriptor& opened, const std::string& path);

/// Opens or makes a regular file for reading and writing, `mode` being its permissions where it is made, locked against a
/// second writer, who may have renamed or removed it between our opening and locking. Throws Failure about `target` where the system refuses, InputError where another
/// program holds the lock.
Descriptor open_locked(const std::string& path, const std::string& target, mode_t mode = 0666);

/// The same of a file that is made anew: one that a crash left, and that is not locked, is removed.
Descriptor open_new_locked(const std::string& path, const std::string& target);

/// The permissions of the file that is there; those of any new file where there is none.
mode_t permissions_of(const std::string& path);

/// Gives a file the owner and the permissions of another one, as far as the system allows it; where there is no other,
/// nothing changes.
void take_owner_and_permissions(const Descriptor& file, const std::string& other);

/// Renames `from` unless `to` is there: then nothing happens. Returns 0 or an error of the system, EEXIST for that.
int rename_to_free_name(const std::string& from, const std::string& to);

/// The path that is left when symbolic links at its end are followed, whether there is a file or not.
std::filesystem::path followed(std::filesystem::path path);

/// Makes renaming and removing in a folder last. One that cannot be opened for reading, or a file system that syncs none,
/// is left alone. Throws Failure about `path`.
void sync_folder(const std::filesystem::path& folder, const std::string& path);

/// `.` for a name alone.
std::filesystem::path folder_of(const std::filesystem::path& path);

}  // namespace credence
