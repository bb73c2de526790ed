#include "journal_file.hpp"

#include <credence/error.hpp>

#include "byte_file.hpp"

#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>

namespace credence {

JournalFile::JournalFile(const std::string& path) : path_(path), file_(open_locked(path, path)) {
    struct stat status {};
    if (fstat(file_.get(), &status) != 0) fail_to_write(path_, errno);
    if (!S_ISREG(status.st_mode)) throw InputError(path_ + ": is not a regular file. Remove it, or give another name.");
    size_ = status.st_size;
}

void JournalFile::read(std::int64_t position, void* bytes, std::size_t size) const {
    auto to = static_cast<char*>(bytes);
    while (size > 0) {
        const ssize_t got = pread(file_.get(), to, size, static_cast<off_t>(position));
        if (got < 0 && errno == EINTR) continue;
        if (got <= 0)
            throw InputError(path_ + ": cannot be read (" + (got < 0 ? words_for(errno) : "it ends too early") +
                             "). Check the disk.");
        to += got;
        position += got;
        size -= static_cast<std::size_t>(got);
    }
}

void JournalFile::append(const std::string& bytes) {
    const FileSizeSignalIgnored ignored;
    ByteFile file(file_.get());
    file.write(static_cast<std::uint64_t>(size_), bytes.data(), bytes.size());
    int error = file.error();
    if (error == 0 && fdatasync(file_.get()) != 0) error = errno;
    if (error == 0) {
        size_ += static_cast<std::int64_t>(bytes.size());
        return;
    }
    // Where even this fails the tail is torn, and cut when the journal is opened again.
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
    if (unlink(path_.c_str()) != 0 && errno != ENOENT)
        throw Failure("cannot remove " + path_ + " (" + words_for(errno) + "). The results are written; remove it.");
    sync_folder(folder_of(path_), path_);
}

}  // namespace credence
