#pragma once
// The system's file operations, and messages for its errors.

#include "base/readable_file.hpp"
#include "base/signal_handler.hpp"

#include <sys/stat.h>
#include <sys/types.h>

#include <filesystem>
#include <optional>
#include <string>

namespace credence {

/// `cannot write PATH (WHY). REMEDY.`, with the remedy for that error of the system.
[[noreturn]] void fail_to_write(const std::string& path, const std::string& why, int error);
[[noreturn]] void fail_to_write(const std::string& path, int error);

/// Ignores SIGXFSZ: beyond a limit on file sizes the system would kill the process, but now write() fails with EFBIG.
class FileSizeSignalIgnored : SignalHandler {
public:
    FileSizeSignalIgnored() : SignalHandler(SIGXFSZ, SIG_IGN) {}
};

enum class Links { followed, themselves };

/// What the system says of the file that a name leads to; nothing where it leads to none that this user can reach.
/// Throws Failure about `target` where the system cannot say.
std::optional<struct stat> status_of(const std::string& path, const std::string& target, Links links = Links::followed);

/// Whether the name still leads to the file that was opened. Throws likewise.
bool same_file(const Descriptor& opened, const std::string& path, const std::string& target);

/// Whether two names lead to one file, by whatever links. Throws likewise.
bool same_file(const std::string& one, const std::string& other);

/// Opens or creates a regular file for reading and writing, `mode` being its permissions if it is created, locked
/// against a second writer, which may have renamed or removed it between our opening and locking. Throws Failure about
/// `target` where the system refuses, InputError where another program holds the lock.
Descriptor open_locked(const std::string& path, const std::string& target, mode_t mode = 0666);

/// The same for a new file: one that a crash left, and that is not locked, is removed.
Descriptor open_new_locked(const std::string& path, const std::string& target);

/// The permissions of the existing file, or those of a new file where there is none.
mode_t permissions_of(const std::string& path);

/// Gives a file the owner and the permissions of another one, as far as the system allows it; where there is no other,
/// nothing changes. Throws Failure where the file would stay readable or writable for more users than the other one.
void take_owner_and_permissions(const Descriptor& file, const std::string& other);

/// Renames `from` unless `to` exists: then nothing happens. Returns 0 or an error of the system, EEXIST for that.
int rename_to_free_name(const std::string& from, const std::string& to);

/// The path after following the symbolic links at its end, whether or not a file exists there.
std::filesystem::path followed(std::filesystem::path path);

/// Syncs a folder, so that renaming and removing in it are durable. A folder that this user may not read, or whose file
/// system does not support this, is skipped. Throws Failure about `path`.
void sync_folder(const std::filesystem::path& folder, const std::string& path);

/// The folder of a path; `.` for a name without one.
std::filesystem::path folder_of(const std::filesystem::path& path);

}  // namespace credence
