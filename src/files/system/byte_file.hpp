#pragma once
// Bytes of an open file.

#include <cstddef>
#include <cstdint>

namespace credence {

/// An open file that remembers its first error. Only pwrite is used.
class ByteFile {
public:
    /// `descriptor` is open for reading and writing, and stays its owner's.
    explicit ByteFile(int descriptor) : descriptor_(descriptor) {}

    void write(std::uint64_t offset, const void* bytes, std::size_t size);
    /// Bytes that are not there read as 0.
    void read(std::uint64_t offset, void* bytes, std::size_t size);
    /// Cuts or lengthens the file.
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
