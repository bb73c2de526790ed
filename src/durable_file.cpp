#include "durable_file.hpp"

#include <credence/error.hpp>
#include <credence/store.hpp>

#include <fcntl.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cctype>
#include <cerrno>
#include <climits>
#include <csignal>
#include <filesystem>
#include <system_error>
#include <utility>

namespace credence {

namespace {

const std::string suffix = ".partial";

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
        case EWOULDBLOCK: return "Let it end, or write to another place";
        default: return "Write to another place";
    }
}

[[noreturn]] void fail(const std::string& path, const std::string& why, int error) {
    throw Failure("cannot write " + path + " (" + why + "). " + remedy_for(error) + ".");
}

/// The system's own words, such as `no space left on device`.
std::string words_for(int error) {
    std::string words = std::generic_category().message(error);
    if (!words.empty()) words.front() = static_cast<char>(std::tolower(static_cast<unsigned char>(words.front())));
    return words;
}

[[noreturn]] void fail(const std::string& path, int error) { fail(path, words_for(error), error); }

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

/// A file descriptor that closes itself.
class Descriptor {
public:
    explicit Descriptor(int descriptor) : descriptor_(descriptor) {}
    Descriptor(Descriptor&& other) noexcept : descriptor_(std::exchange(other.descriptor_, -1)) {}
    Descriptor& operator=(Descriptor&&) = delete;
    ~Descriptor() {
        if (descriptor_ >= 0) ::close(descriptor_);
    }
    int get() const { return descriptor_; }

private:
    int descriptor_;
};

bool same_file(const Descriptor& opened, const std::string& path) {
    struct stat own {}, named {};
    return fstat(opened.get(), &own) == 0 && stat(path.c_str(), &named) == 0 && own.st_ino == named.st_ino &&
           own.st_dev == named.st_dev;
}

/// Opens the file aside, locked against a second writer, who may have renamed it between our opening and locking.
Descriptor open_aside(const std::string& target) {
    const std::string path = target + suffix;
    for (;;) {
        Descriptor file(open(path.c_str(), O_WRONLY | O_CREAT | O_CLOEXEC | O_NOFOLLOW, 0666));
        if (file.get() < 0) fail(target, errno);
        // File systems without locks are no reason not to write.
        if (flock(file.get(), LOCK_EX | LOCK_NB) != 0 && errno == EWOULDBLOCK)
            fail(target, "another program is writing it", EWOULDBLOCK);
        if (same_file(file, path)) return file;
    }
}

/// 0, or the error.
int write_all(const Descriptor& file, const unsigned char* bytes, std::size_t size) {
    constexpr std::size_t at_once = std::size_t{1} << 30;
    if (ftruncate(file.get(), 0) != 0) return errno;
    while (size > 0) {
        const ssize_t written = write(file.get(), bytes, std::min(size, at_once));
        if (written < 0 && errno == EINTR) continue;
        if (written < 0) return errno;
        bytes += written;
        size -= static_cast<std::size_t>(written);
    }
    return fsync(file.get()) == 0 ? 0 : errno;
}

/// Writes aside and renames. The lock is held beyond the renaming, so that nobody writes into the finished file.
void write_and_rename(const std::string& target, const unsigned char* bytes, std::size_t size) {
    const std::string path = target + suffix;
    const Descriptor file = open_aside(target);
    int error = write_all(file, bytes, size);
    if (error == 0 && rename(path.c_str(), target.c_str()) != 0) error = errno;
    if (error == 0) return;
    unlink(path.c_str());
    fail(target, error);
}

/// Makes a renaming last. A folder that cannot be opened for reading, or a file system that syncs none, is left alone.
void sync_folder(const std::filesystem::path& folder, const std::string& path) {
    const Descriptor opened(open(folder.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC));
    if (opened.get() < 0 || fsync(opened.get()) == 0) return;
    if (errno != EINVAL && errno != ENOTSUP) fail(path, errno);
}

std::filesystem::path folder_of(const std::filesystem::path& path) {
    return path.has_parent_path() ? path.parent_path() : std::filesystem::path(".");
}

[[noreturn]] void refuse(const std::string& path, const std::string& why, const std::string& remedy) {
    throw InputError("cannot write " + path + " (" + why + "). " + remedy + ".");
}

}  // namespace

void write_durably(const std::string& path, const void* bytes, std::size_t size) {
    namespace fs = std::filesystem;
    std::error_code trouble;
    // Renaming onto a link would replace the link; onto a device, the device.
    const fs::path target = fs::is_symlink(path, trouble) ? fs::weakly_canonical(path, trouble) : fs::path(path);
    const fs::file_status status = fs::status(target, trouble);
    if (fs::exists(status) && !fs::is_regular_file(status)) fail(path, "there is something that is not a file", EEXIST);
    const FileSizeSignalIgnored ignored;
    write_and_rename(target.string(), static_cast<const unsigned char*>(bytes), size);
    sync_folder(folder_of(target), path);
}

void write_text_file(const std::string& path, const std::string& text) {
    write_durably(path, text.data(), text.size());
}

void check_output(const std::string& path, bool overwrite, const std::string& way_out) {
    namespace fs = std::filesystem;
    const fs::path target(path), folder = folder_of(target);
    std::error_code trouble;
    if (target.filename().empty()) refuse(path, "it names no file", "Give the name of a file");
    if (target.filename().string().size() + suffix.size() > NAME_MAX)
        refuse(path, "the name is too long", "Give a shorter one");
    if (!fs::exists(folder, trouble)) refuse(path, "there is no folder " + folder.string(), "Make it first");
    if (!fs::is_directory(folder, trouble)) refuse(path, folder.string() + " is not a folder", "Give another place");
    if (access(folder.c_str(), W_OK | X_OK) != 0)
        refuse(path, "its folder: " + words_for(errno), "Give a folder that you may write to");
    const fs::path aside = target.string() + suffix;
    if (const fs::file_status own = fs::symlink_status(aside, trouble); fs::exists(own) && !fs::is_regular_file(own))
        refuse(path, aside.filename().string() + " is in the way of writing it", "Remove that, or give another name");
    const fs::file_status status = fs::status(target, trouble);
    if (fs::is_symlink(target, trouble) && !fs::exists(status) && fs::weakly_canonical(target, trouble).empty())
        refuse(path, "it is a link that leads nowhere", "Give another name");
    if (!fs::exists(status)) return;
    if (!fs::is_regular_file(status)) refuse(path, "there is something that is not a file", "Give another name");
    if (!overwrite) refuse(path, "it is there already", way_out);
}

}  // namespace credence
