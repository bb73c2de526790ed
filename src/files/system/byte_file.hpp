#pragma once
// Access to the bytes of an open file.

#include <cstddef>
#include <cstdint>

namespace credence {

/// An open file that remembers its first error. It writes with pwrite only.
class ByteFile {
public:
    /// `descriptor` is open for reading and writing, and remains owned by the caller.
    explicit ByteFile(int descriptor) : descriptor_(descriptor) {}

    void write(std::uint64_t offset, const void* bytes, std::size_t size);
    /// Reads bytes; those beyond the end are 0.
    void read(std::uint64_t offset, void* bytes, std::size_t size);
    /// Truncates or extends the file.
    void resize(std::uint64_t size);
    std::uint64_t size() const { return size_; }
    /// 0, or the first error.
    int error() const { return error_; }

private:
    int descriptor_;
    std::uint64_t size_ = 0;
    int error_ = 0;
};

}  // namespace credence
