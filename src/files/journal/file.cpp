#include "files/journal/file.hpp"

#include <credence/error.hpp>

#include "files/system/byte_file.hpp"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <ctime>

namespace credence {

namespace {

struct stat status_of(const Descriptor& file, const std::string& path) {
    struct stat status {};
    if (fstat(file.get(), &status) != 0)
        throw InputError("cannot be read", words_for(errno), "Check the disk").at(path);
    return status;
}

}  // namespace

JournalBytes::JournalBytes(std::string path, Descriptor file) : path_(std::move(path)), file_(std::move(file)) {
    const struct stat status = status_of(file_, path_);
    if (!S_ISREG(status.st_mode))
        throw InputError("is not a regular file", {}, "Remove it, or give another name").at(path_);
    size_ = status.st_size;
}

std::optional<JournalBytes> JournalBytes::open(const std::string& path) {
    // Without O_NONBLOCK, opening a pipe would wait for its other end.
    Descriptor file(::open(path.c_str(), O_RDONLY | O_CLOEXEC | O_NOFOLLOW | O_NONBLOCK));
    if (file.get() < 0 && errno == ENOENT) return std::nullopt;
    if (file.get() < 0) throw InputError("cannot be read", words_for(errno), "Check its permissions").at(path);
    return JournalBytes(path, std::move(file));
}

double JournalBytes::seconds_since_change() const {
    timespec now{};
    clock_gettime(CLOCK_REALTIME, &now);
    const timespec changed = status_of(file_, path_).st_mtim;
    const double seconds = static_cast<double>(now.tv_sec - changed.tv_sec) +
                           1e-9 * static_cast<double>(now.tv_nsec - changed.tv_nsec);
    return std::max(0.0, seconds);  // another machine's clock may be ahead
}

bool JournalBytes::is_cut() const { return status_of(file_, path_).st_size < size_; }

std::string JournalBytes::read(std::int64_t position, std::int64_t size) const {
    std::string bytes(static_cast<std::size_t>(size), '\0');
    read(position, bytes.data(), bytes.size());
    return bytes;
}

JournalFile::JournalFile(const std::string& path, mode_t mode) : JournalBytes(path, open_locked(path, path, mode)) {}

void JournalBytes::read(std::int64_t position, void* bytes, std::size_t size) const {
    auto to = static_cast<char*>(bytes);
    while (size > 0) {
        const ssize_t got = pread(file_.get(), to, size, static_cast<off_t>(position));
        if (got < 0 && errno == EINTR) continue;
        if (got <= 0)
            throw InputError("cannot be read", got < 0 ? words_for(errno) : "it ends too early", "Check the disk")
                .at(path_);
        to += got;
        position += got;
        size -= static_cast<std::size_t>(got);
    }
}

void JournalFile::append(const std::vector<std::string>& pieces) {
    if (const std::int64_t there = status_of(file_, path_).st_size; there != size_)
        throw Failure("cannot write " + path_,
                      "another program changed it: it has " + std::to_string(there) + " bytes, " +
                          std::to_string(size_) + " were written",
                      "Keep other programs from it");
    const FileSizeSignalIgnored ignored;
    ByteFile file(file_.get());
    std::int64_t end = size_;
    for (const std::string& piece : pieces) {
        file.write(static_cast<std::uint64_t>(end), piece.data(), piece.size());
        end += static_cast<std::int64_t>(piece.size());
    }
    int error = file.error();
    if (error == 0 && fdatasync(file_.get()) != 0) error = errno;
    if (error == 0) {
        size_ = end;
        return;
    }
    // If even this fails the tail is torn, and will be cut when the journal is opened again.
    [[maybe_unused]] const int cut = ftruncate(file_.get(), static_cast<off_t>(size_));
    fail_to_write(path_, error);
}

void JournalFile::cut(std::int64_t size) {
    if (size == size_) return;
    if (ftruncate(file_.get(), static_cast<off_t>(size)) != 0 || fdatasync(file_.get()) != 0)
        fail_to_write(path_, errno);
    size_ = size;
}

void JournalFile::remove() {
    if (!same_file(file_, path_, path_)) return;
    if (unlink(path_.c_str()) != 0 && errno != ENOENT)
        throw Failure("cannot remove " + path_, words_for(errno), "The results are written; remove it");
    sync_folder(folder_of(path_), path_);
}

}  // namespace credence
