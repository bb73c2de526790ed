#include "base/readable_file.hpp"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cctype>
#include <cerrno>
#include <system_error>

namespace credence {

Descriptor::~Descriptor() {
    if (descriptor_ >= 0) ::close(descriptor_);
}

std::string words_for(int error) {
    std::string words = std::generic_category().message(error);
    if (!words.empty()) words.front() = static_cast<char>(std::tolower(static_cast<unsigned char>(words.front())));
    return words;
}

Unreadable::Unreadable(int error)
    : std::runtime_error(error == 0 ? "not a regular file" : words_for(error)), error_(error) {}

bool Unreadable::is_missing() const { return error_ == ENOENT || error_ == ENOTDIR; }

std::string remedy_for_reading(int error) {
    switch (error) {
        case EMFILE: return "Raise the number of files that may be open (ulimit -n)";
        case ENFILE: return "Close some files: the system has no room for more";
        case EACCES:
        case EPERM: return "Check its permissions";
        case EIO: return "Check the disk";
        case ENOMEM: return "Free some memory; where there is enough, the file is damaged";
        default: return "Check the path";
    }
}

std::string start_of_file(const std::string& path, std::size_t most) {
    struct stat status {};
    if (stat(path.c_str(), &status) != 0) throw Unreadable(errno);
    if (!S_ISREG(status.st_mode)) throw Unreadable(0);
    const Descriptor file(open(path.c_str(), O_RDONLY | O_CLOEXEC | O_NONBLOCK | O_NOCTTY));
    if (file.get() < 0) throw Unreadable(errno);
    if (fstat(file.get(), &status) != 0) throw Unreadable(errno);
    if (!S_ISREG(status.st_mode)) throw Unreadable(0);  // the name leads to another file by now
    std::string bytes(most, '\0');
    std::size_t size = 0;
    while (size < most) {
        const ssize_t got = read(file.get(), bytes.data() + size, most - size);
        if (got < 0 && errno == EINTR) continue;
        if (got < 0) throw Unreadable(errno);
        if (got == 0) break;
        size += static_cast<std::size_t>(got);
    }
    bytes.resize(size);
    return bytes;
}

}  // namespace credence
