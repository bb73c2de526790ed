#pragma once
// File descriptors, the system's messages for its errors, and reading files: only regular ones are opened.

#include <stdexcept>
#include <string>
#include <utility>

namespace credence {

/// A file descriptor that closes itself.
class Descriptor {
public:
    explicit Descriptor(int descriptor) : descriptor_(descriptor) {}
    Descriptor(Descriptor&& other) noexcept : descriptor_(std::exchange(other.descriptor_, -1)) {}
    Descriptor& operator=(Descriptor&&) = delete;
    ~Descriptor();
    int get() const { return descriptor_; }

private:
    int descriptor_;
};

/// The system's own message, such as `no space left on device`.
std::string words_for(int error);

/// Why a file cannot be read. The message is the system's own, such as `input/output error`.
class Unreadable : public std::runtime_error {
public:
    /// `error` is the system's error number; 0 if the file is not a regular one.
    explicit Unreadable(int error);
    int error() const { return error_; }
    bool is_missing() const;
    bool is_irregular() const { return error_ == 0; }

private:
    int error_;
};

/// The remedy for an error of the system that kept a file from being read.
std::string remedy_for_reading(int error);

/// The first `most` bytes of a regular file, fewer where it is shorter. It neither waits for the other end of a pipe
/// nor opens a device. Throws Unreadable.
std::string start_of_file(const std::string& path, std::size_t most);

}  // namespace credence
