#include "files/system/byte_file.hpp"

#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstring>

namespace credence {

void ByteFile::write(std::uint64_t offset, const void* bytes, std::size_t size) {
    constexpr std::size_t at_once = std::size_t{1} << 30;
    size_ = std::max(size_, offset + size);
    auto from = static_cast<const char*>(bytes);
    while (size > 0 && error_ == 0) {
        const ssize_t written = pwrite(descriptor_, from, std::min(size, at_once), static_cast<off_t>(offset));
        if (written < 0 && errno == EINTR) continue;
        if (written < 0) error_ = errno;
        if (written == 0) error_ = EIO;
        if (written <= 0) return;
        from += written;
        offset += static_cast<std::uint64_t>(written);
        size -= static_cast<std::size_t>(written);
    }
}

void ByteFile::read(std::uint64_t offset, void* bytes, std::size_t size) {
    auto to = static_cast<char*>(bytes);
    while (size > 0) {
        const ssize_t got = pread(descriptor_, to, size, static_cast<off_t>(offset));
        if (got < 0 && errno == EINTR) continue;
        if (got < 0 && error_ == 0) error_ = errno;
        if (got <= 0) break;
        to += got;
        offset += static_cast<std::uint64_t>(got);
        size -= static_cast<std::size_t>(got);
    }
    std::memset(to, 0, size);
}

void ByteFile::resize(std::uint64_t size) {
    size_ = size;
    if (error_ == 0 && ftruncate(descriptor_, static_cast<off_t>(size)) != 0) error_ = errno;
}

}  // namespace credence
