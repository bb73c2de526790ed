#pragma once
// Room 12: the bytes of a journal on the disk: appended, synced, cut where they are torn.

#include "system_file.hpp"

#include <cstdint>
#include <string>

namespace credence {

/// A file that is only ever appended to, locked against a second writer while it is open.
class JournalFile {
public:
    /// Opens it, or makes it. Throws InputError where another program holds it, Failure where the system refuses.
    explicit JournalFile(const std::string& path);

    const std::string& path() const { return path_; }
    std::int64_t size() const { return size_; }
    /// Exactly `size` bytes from `position` on. Throws InputError where they are not there or cannot be read.
    void read(std::int64_t position, void* bytes, std::size_t size) const;
    /// Appends and syncs: when it returns the bytes are on the disk. Throws Failure where the system refuses; then what
    /// had been there before is there still, and nothing else.
    void append(const std::string& bytes);
    /// Leaves the first `size` bytes.
    void cut(std::int64_t size);
    /// Removes it. Throws Failure.
    void remove();

private:
    std::string path_;
    Descriptor file_;
    std::int64_t size_ = 0;
};

}  // namespace credence
