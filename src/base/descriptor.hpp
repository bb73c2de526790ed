#pragma once
// File descriptors, and the system's messages for its errors.

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

}  // namespace credence
